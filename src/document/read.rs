//! What the fields of a file are made of: names, texts, expressions, numbers, maps; all problems are collected.

use super::tree::{Node, Tree, Word};
use super::{Entries, ExprText, Literal, Spanned};
use crate::problem::{Place, Problem, Source};
use std::collections::BTreeMap;
use std::ops::Range;

/// Reads trees of one source. A method that returns `None` has left a problem in `problems`.
pub(super) struct Reader<'a> {
    pub source: &'a Source,
    pub problems: Vec<Problem>,
}

/// The fields between the parentheses of something.
pub(super) struct Fields<'t> {
    /// What it is: "a knob".
    what: &'static str,
    /// Its name, or all of it where it has none.
    span: Range<usize>,
    found: BTreeMap<&'t str, &'t Tree>,
}

impl<'t> Fields<'t> {
    pub fn get(&self, name: &str) -> Option<&'t Tree> {
        self.found.get(name).copied()
    }
}

impl Reader<'_> {
    pub fn place(&self, span: &Range<usize>) -> Place {
        self.source.at(span.clone())
    }

    pub fn spanned<T>(&self, value: T, tree: &Tree) -> Spanned<T> {
        Spanned { value, place: self.place(&tree.span) }
    }

    fn word(&self, word: &Word) -> Spanned<String> {
        Spanned { value: word.text.clone(), place: self.place(&word.span) }
    }

    pub fn wrong<T>(&mut self, tree: &Tree, wanted: &str) -> Option<T> {
        let found = match &tree.node {
            Node::Named(Some(name), _) | Node::Tuple(Some(name), _) => format!("`{}(…)`", name.text),
            Node::Named(None, _) => "named fields".to_owned(),
            Node::Tuple(None, _) => "values in parentheses".to_owned(),
            Node::List(_) => "a list".to_owned(),
            Node::Map(_) => "a map".to_owned(),
            Node::Text(_) => "a text".to_owned(),
            Node::Name | Node::Other => format!("`{}`", &self.source.text()[tree.span.clone()]),
        };
        let problem = Problem::input("wrong-type", format!("here should be {wanted}, not {found}"));
        self.problems.push(problem.at(&self.place(&tree.span), format!("not {wanted}")));
        None
    }

    /// The fields of `tree`, of which all must be in `known` and none twice.
    pub fn fields<'t>(&mut self, tree: &'t Tree, what: &'static str, known: &[&str]) -> Option<Fields<'t>> {
        let (name, entries): (_, &[(Word, Tree)]) = match &tree.node {
            Node::Named(name, entries) => (name.as_ref(), entries),
            Node::Tuple(name, items) if items.is_empty() => (name.as_ref(), &[]),
            _ => return self.wrong(tree, &format!("{what} with named fields, `({}: …)`", known[0])),
        };
        let mut found = BTreeMap::new();
        let mut first_spans: BTreeMap<&str, &Range<usize>> = BTreeMap::new();
        for (key, value) in entries {
            let place = self.place(&key.span);
            if !known.contains(&key.text.as_str()) {
                let message = format!("{what} has no field `{}`", key.text);
                let problem = Problem::input("unknown-field", message).at(&place, "unknown");
                self.problems.push(problem.suggest(&key.text, known.iter().copied()));
            } else if let Some(first) = first_spans.insert(&key.text, &key.span) {
                self.twice(&key.text, &key.span, first);
            } else {
                found.insert(key.text.as_str(), value);
            }
        }
        Some(Fields { what, span: name.map_or(&tree.span, |name| &name.span).clone(), found })
    }

    fn twice(&mut self, key: &str, second: &Range<usize>, first: &Range<usize>) {
        let problem = Problem::input("duplicate-key", format!("`{key}` stands here twice"))
            .at(&self.place(second), "again")
            .at(&self.place(first), "first here");
        self.problems.push(problem.help("remove or rename one of the two"));
    }

    pub fn required<'t>(&mut self, fields: &Fields<'t>, name: &str) -> Option<&'t Tree> {
        let found = fields.get(name);
        if found.is_none() {
            let problem = Problem::input("missing-field", format!("{} needs a field `{name}`", fields.what));
            self.problems.push(problem.at(&self.place(&fields.span), format!("has no `{name}`")));
        }
        found
    }

    pub fn unknown_variant<T>(
        &mut self,
        given: &str,
        span: &Range<usize>,
        what: &str,
        known: &[&str],
    ) -> Option<T> {
        let problem = Problem::input("unknown-variant", format!("`{given}` is not {what}"));
        self.problems.push(problem.at(&self.place(span), "unknown").suggest(given, known.iter().copied()));
        None
    }

    /// One of several names without fields.
    pub fn choice<T: Copy>(&mut self, tree: &Tree, what: &str, choices: &[(&str, T)]) -> Option<T> {
        let text = &self.source.text()[tree.span.clone()];
        if !matches!(tree.node, Node::Name) {
            return self.wrong(tree, what);
        }
        if let Some((_, choice)) = choices.iter().find(|(name, _)| *name == text) {
            return Some(*choice);
        }
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        self.unknown_variant(text, &tree.span, what, &names)
    }

    pub fn text(&mut self, tree: &Tree) -> Option<Spanned<String>> {
        match &tree.node {
            Node::Text(word) => Some(self.word(word)),
            _ => self.wrong(tree, "a text in quotes"),
        }
    }

    /// What expressions and WGSL can name: letters, digits, `_`.
    pub fn name(&mut self, tree: &Tree) -> Option<Spanned<String>> {
        let name = self.text(tree)?;
        let first_fits = name.value.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        if first_fits && name.value.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_') {
            return Some(name);
        }
        let problem = Problem::input("bad-name", format!("`{}` can't be a name here", name.value))
            .at(&name.place, "not a name")
            .help("names are made of letters, digits and `_`, and begin with a letter or `_`");
        self.problems.push(problem);
        None
    }

    pub fn expression(&mut self, tree: &Tree) -> Option<ExprText> {
        let text = &self.source.text()[tree.span.clone()];
        match &tree.node {
            Node::Text(word) if word.text == self.source.text()[word.span.clone()] => Some(self.word(word)),
            Node::Text(word) => {
                let problem =
                    Problem::input("escape-in-expression", "an expression is written without escapes")
                        .at(&self.place(&word.span), "has an escape")
                        .help("texts inside of expressions can be written 'so'");
                self.problems.push(problem);
                None
            }
            Node::Name if matches!(text, "true" | "false") => Some(self.spanned(text.to_owned(), tree)),
            Node::Other if text.starts_with(|c: char| c.is_ascii_digit() || c == '-') => {
                Some(self.spanned(text.to_owned(), tree))
            }
            _ => self.wrong(tree, "an expression: a text in quotes, a number or a flag"),
        }
    }

    pub fn flag(&mut self, tree: &Tree) -> Option<bool> {
        self.choice(tree, "a flag", &[("false", false), ("true", true)])
    }

    pub fn number(&mut self, tree: &Tree) -> Option<f64> {
        match self.literal(tree)? {
            Literal::Whole(number) => Some(number as f64),
            Literal::Real(number) => Some(number),
            Literal::Flag(_) | Literal::Text(_) => self.wrong(tree, "a number"),
        }
    }

    pub fn literal(&mut self, tree: &Tree) -> Option<Literal> {
        let text = &self.source.text()[tree.span.clone()];
        match &tree.node {
            Node::Text(word) => return Some(Literal::Text(word.text.clone())),
            Node::Name if matches!(text, "true" | "false") => return Some(Literal::Flag(text == "true")),
            Node::Other if text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '+' | '.')) => {
                if let Ok(number) = ron::from_str::<i64>(text) {
                    return Some(Literal::Whole(number));
                }
                if let Some(number) = ron::from_str::<f64>(text).ok().filter(|number| number.is_finite()) {
                    return Some(Literal::Real(number));
                }
            }
            _ => {}
        }
        self.wrong(tree, "a finite number, a flag or a text")
    }

    pub fn list<T>(
        &mut self,
        tree: &Tree,
        mut item: impl FnMut(&mut Self, &Tree) -> Option<T>,
    ) -> Option<Vec<T>> {
        let Node::List(items) = &tree.node else { return self.wrong(tree, "a list, `[…]`") };
        let found: Vec<Option<T>> = items.iter().map(|tree| item(self, tree)).collect();
        found.into_iter().collect()
    }

    /// A map from names, each once.
    pub fn entries<T>(
        &mut self,
        tree: Option<&Tree>,
        mut value: impl FnMut(&mut Self, &Tree) -> Option<Spanned<T>>,
    ) -> Option<Entries<T>> {
        let Some(tree) = tree else { return Some(Vec::new()) };
        let Node::Map(pairs) = &tree.node else { return self.wrong(tree, "a map, `{\"name\": …}`") };
        let mut entries = Vec::new();
        let mut firsts: BTreeMap<String, Range<usize>> = BTreeMap::new();
        for (key, tree) in pairs {
            let Some(key) = self.name(key) else { continue };
            match firsts.get(&key.value).cloned() {
                Some(first) => self.twice(&key.value, &key.place.span, &first),
                None => {
                    firsts.insert(key.value.clone(), key.place.span.clone());
                }
            }
            if let Some(value) = value(self, tree) {
                entries.push((key, value));
            }
        }
        (entries.len() == pairs.len()).then_some(entries)
    }

    /// An optional field: `Some(None)` where it is absent, `None` where it is wrong.
    pub fn optional<T>(
        &mut self,
        tree: Option<&Tree>,
        mut read: impl FnMut(&mut Self, &Tree) -> Option<T>,
    ) -> Option<Option<T>> {
        match tree {
            Some(tree) => read(self, tree).map(Some),
            None => Some(None),
        }
    }
}
