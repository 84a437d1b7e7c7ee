//! One file of WGSL: what it imports and declares, and which bytes of it go away.
//!
//! A file is walked as nested lists: module-scope items, struct members, parameters, statements, clauses of a
//! `switch`. A condition stands before an element of such a list and decides about just that element. Dropped elements
//! are walked as well, so that a mistake in a condition shows whatever the other conditions say.

use super::condition::{Chain, Condition, Verdict};
use super::token::{Kind, Tokens};
use crate::expr::Names;
use crate::problem::{Place, Problem, Source};
use std::collections::BTreeSet;
use std::ops::Range;

/// A module-scope declaration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Declaration {
    pub name: String,
    /// Of the name.
    pub place: Place,
    /// The `//` comment on the lines above it.
    pub about: String,
}

/// What there is to know about a file before others are put beside it.
#[derive(Default)]
pub struct Scan {
    /// Bytes to blank: imports, conditions, what they drop, directives.
    pub blank: Vec<Range<usize>>,
    /// What is imported, with the place that says so.
    pub imports: Vec<(String, Place)>,
    /// `enable …;` and the like, which must stand before everything else of a module.
    pub directives: Vec<Range<usize>>,
    pub declarations: Vec<Declaration>,
    /// Conditions that can't be decided yet, and that something kept depends on.
    pub undecided: Vec<Place>,
    pub problems: Vec<Problem>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum List {
    Module,
    /// Struct members or parameters, which commas part.
    Members,
    Statements,
    Clauses,
}

/// Scans `source`, deciding its conditions by `names`.
pub fn scan(source: &Source, names: &dyn Names) -> Scan {
    let tokens = match Tokens::read(source) {
        Ok(tokens) => tokens,
        Err(problem) => return Scan { problems: vec![problem], ..Scan::default() },
    };
    let mut walk = Walk { tokens: &tokens, names, scan: Scan::default(), used: BTreeSet::new() };
    walk.list(List::Module, 0..tokens.len(), true);
    walk.misplaced();
    walk.scan
}

struct Walk<'a> {
    tokens: &'a Tokens,
    names: &'a dyn Names,
    scan: Scan,
    /// Tokens `@` of the conditions that stood where one may stand.
    used: BTreeSet<usize>,
}

impl Walk<'_> {
    /// Walks the elements in a range of tokens; `live` is false inside of what is dropped already.
    fn list(&mut self, list: List, range: Range<usize>, live: bool) {
        let mut chain = Chain::None;
        let mut at = range.start;
        while at < range.end {
            let (condition, start) = self.condition(at, range.end);
            let place = self.tokens.place(at..start);
            let (verdict, problem) = chain.decide(condition.as_ref(), &place, self.names);
            self.scan.problems.extend(problem);
            if live && verdict == Verdict::Undecided {
                self.scan.undecided.push(place.clone());
            }
            let end = self.element_end(list, start, range.end);
            if condition.is_some() && start == range.end {
                self.scan.problems.push(
                    Problem::input("lone-condition", "a condition with nothing after it")
                        .at(&place, "this decides about nothing"),
                );
            }
            let keep = verdict != Verdict::Drop;
            if live && condition.is_some() {
                self.scan.blank.push(self.tokens.bytes(at..if keep { start } else { end }));
            }
            self.inside(list, start..end, live && keep, at);
            at = end.max(at + 1);
        }
    }

    /// The condition at `at`, and the token after it.
    fn condition(&mut self, at: usize, end: usize) -> (Option<Condition>, usize) {
        let word = self.tokens.word(at + 1);
        if !self.tokens.is_sign(at, '@') || !matches!(word, "if" | "elif" | "else") {
            return (None, at);
        }
        self.used.insert(at);
        if word == "else" {
            return (Some(Condition::Else), (at + 2).min(end));
        }
        let after = self.tokens.after(at + 2);
        let open = self.tokens.get(at + 2).filter(|token| token.kind == Kind::Sign('('));
        let inner = match open.and_then(|open| Some((open, self.tokens.get(open.partner)?))) {
            Some((open, close)) => self.tokens.source.at(open.end..close.start),
            None => {
                let place = self.tokens.place(at..at + 2);
                self.scan.problems.push(
                    Problem::input("bad-condition", format!("`@{word}` without a condition"))
                        .at(&place, "a condition in parentheses must follow")
                        .help(format!("write `@{word}(lights.total > 0)`")),
                );
                return (None, (at + 2).min(end));
            }
        };
        let condition = if word == "if" { Condition::If(inner) } else { Condition::Elif(inner) };
        (Some(condition), after.min(end))
    }

    /// The token after the element that begins at `start`.
    fn element_end(&mut self, list: List, start: usize, end: usize) -> usize {
        let tokens = self.tokens;
        let first = self.after_attributes(start, end);
        let to_block = |from: usize| tokens.find(from..end, '{').map_or(end, |open| tokens.after(open));
        let to_semicolon = || tokens.find(first..end, ';').map(|i| i + 1);
        match (list, tokens.word(first)) {
            (List::Members, _) => self.member_end(first, end),
            (List::Clauses, _) => to_block(first),
            (List::Module, "fn" | "struct") => {
                let after = to_block(first);
                if tokens.is_sign(after, ';') { after + 1 } else { after }
            }
            (List::Module, _) => to_semicolon().unwrap_or_else(|| {
                if start < end {
                    let place = tokens.place(start..end);
                    let head = place.source.at(place.span.start..tokens.bytes(start..start + 1).end);
                    self.scan.problems.push(
                        Problem::input("open-declaration", "a declaration does not end before the file does")
                            .at(&head, "it begins here")
                            .help("does a `;` lack at its end?"),
                    );
                }
                end
            }),
            (List::Statements, "if") => {
                let mut after = to_block(first);
                while after < end && tokens.word(after) == "else" {
                    after = to_block(after);
                }
                after
            }
            (List::Statements, "for" | "while" | "loop" | "switch" | "continuing") => to_block(first),
            (List::Statements, _) if tokens.is_sign(first, '{') => tokens.after(first),
            (List::Statements, _) => to_semicolon().unwrap_or(end),
        }
    }

    /// The token after the comma that ends a member. Outside of parentheses only types stand there, so that `<` and
    /// `>` are brackets, but for `<<`.
    fn member_end(&self, first: usize, end: usize) -> usize {
        let (mut i, mut depth) = (first, 0_i32);
        while i < end {
            if self.tokens.is_sign(i, '<') {
                let shift = self.tokens.is_sign(i + 1, '<')
                    && self.tokens.get(i).map(|t| t.end) == self.tokens.get(i + 1).map(|t| t.start);
                if shift {
                    i += 2;
                    continue;
                }
                depth += 1;
            } else if self.tokens.is_sign(i, '>') {
                depth -= 1;
            } else if self.tokens.is_sign(i, ',') && depth <= 0 {
                return i + 1;
            }
            i = self.tokens.after(i);
        }
        end
    }

    fn after_attributes(&self, start: usize, end: usize) -> usize {
        let mut at = start;
        while at < end && self.tokens.is_sign(at, '@') {
            at += 2;
            if self.tokens.is_sign(at, '(') {
                at = self.tokens.after(at);
            }
        }
        at.min(end)
    }

    /// Walks the lists within an element. `whole` is where it begins with its condition.
    fn inside(&mut self, list: List, element: Range<usize>, live: bool, whole: usize) {
        match list {
            List::Module => self.item(element, live, whole),
            List::Members => {}
            List::Statements | List::Clauses => {
                let first = self.after_attributes(element.start, element.end);
                let of = match (list, self.tokens.word(first)) {
                    (List::Statements, "switch") => List::Clauses,
                    _ => List::Statements,
                };
                let mut at = first;
                while let Some(open) = self.tokens.find(at..element.end, '{') {
                    at = self.tokens.after(open);
                    self.list(of, open + 1..at - 1, live);
                }
            }
        }
    }

    fn item(&mut self, item: Range<usize>, live: bool, whole: usize) {
        let first = self.after_attributes(item.start, item.end);
        self.refuse_numbers(item.start..first);
        let word = self.tokens.word(first).to_owned();
        let mut name = first + 1;
        match word.as_str() {
            "import" => {
                let bytes = self.tokens.bytes(first..item.end);
                if live {
                    self.scan.blank.push(bytes.clone());
                    let after = self.tokens.bytes(first..first + 1).end;
                    let text = &self.tokens.source.text()[after..bytes.end];
                    let path = text.trim_end_matches(';').trim();
                    let start = after + (text.len() - text.trim_start().len());
                    let place = self.tokens.source.at(start..start + path.len());
                    self.scan.imports.push((path.to_owned(), place));
                }
                return;
            }
            "enable" | "requires" | "diagnostic" => {
                if live {
                    let bytes = self.tokens.bytes(first..item.end);
                    self.scan.blank.push(bytes.clone());
                    self.scan.directives.push(bytes);
                }
                return;
            }
            "fn" | "struct" => {
                let lists = if word == "fn" {
                    [('(', List::Members), ('{', List::Statements)]
                } else {
                    [('{', List::Members); 2]
                };
                let lists = &lists[usize::from(word == "struct")..];
                let mut at = first;
                for (sign, of) in lists {
                    if let Some(open) = self.tokens.find(at..item.end, *sign) {
                        at = self.tokens.after(open);
                        self.list(*of, open + 1..at - 1, live);
                    }
                }
            }
            "var" if self.tokens.is_sign(name, '<') => {
                while name < item.end && !self.tokens.is_sign(name, '>') {
                    name += 1;
                }
                name += 1;
            }
            "var" | "const" | "override" | "alias" => {}
            _ => return,
        }
        if live && name < item.end && !self.tokens.word(name).is_empty() {
            self.scan.declarations.push(Declaration {
                name: self.tokens.word(name).to_owned(),
                place: self.tokens.place(name..name + 1),
                about: comment_above(self.tokens.source.text(), self.tokens.bytes(whole..whole + 1).start),
            });
        }
    }

    fn refuse_numbers(&mut self, attributes: Range<usize>) {
        for at in attributes {
            if self.tokens.is_sign(at, '@') && matches!(self.tokens.word(at + 1), "group" | "binding") {
                let end = if self.tokens.is_sign(at + 2, '(') { self.tokens.after(at + 2) } else { at + 2 };
                self.scan.problems.push(
                    Problem::input("numbered-binding", "bindings of kernels carry no numbers")
                        .at(&self.tokens.place(at..end), "the engine numbers bindings itself")
                        .help(
                            "take `@group` and `@binding` away: a binding is tied to a resource by its name",
                        ),
                );
                return;
            }
        }
    }

    /// Conditions where none can stand.
    fn misplaced(&mut self) {
        for at in 0..self.tokens.len() {
            let condition =
                self.tokens.is_sign(at, '@') && matches!(self.tokens.word(at + 1), "if" | "elif" | "else");
            if condition && !self.used.contains(&at) {
                self.scan.problems.push(
                    Problem::input("misplaced-condition", "a condition can't stand here")
                        .at(&self.tokens.place(at..at + 2), "not before any of the things a condition can drop")
                        .help(
                            "a condition comes first (one, before other attributes) before a declaration, import, struct \
                             member, parameter, statement, block or clause of a `switch`",
                        ),
                );
            }
        }
    }
}

/// The `//` comment on the lines right above the byte `at`, if nothing else stands before it on its own line. Without
/// its slashes. The comment at the very top of a file is the file's own.
fn comment_above(text: &str, at: usize) -> String {
    let mut lines = Vec::new();
    let mut above = text[..at].trim_end_matches([' ', '\t']);
    while let Some(rest) = above.strip_suffix('\n') {
        let start = rest.rfind('\n').map_or(0, |i| i + 1);
        let Some(line) = comment_line(&rest[start..]) else { break };
        if start == 0 {
            return String::new();
        }
        lines.push(line);
        above = &rest[..start];
    }
    lines.reverse();
    lines.join("\n")
}

/// The comment at the top of a file, without its slashes.
pub fn header(text: &str) -> String {
    text.lines().map_while(comment_line).collect::<Vec<_>>().join("\n")
}

fn comment_line(line: &str) -> Option<&str> {
    let text = line.trim().strip_prefix("//")?;
    let text = text.trim_start_matches(['/', '!']);
    Some(text.strip_prefix(' ').unwrap_or(text).trim_end())
}
