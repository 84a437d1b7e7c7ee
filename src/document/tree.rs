//! RON text as a tree in which everything knows where it stands.
//!
//! The `ron` crate reads the text. It gives no positions for values, but borrowed pieces of the text, whose addresses
//! are positions: a value is read one level deep, its pieces are borrowed, and each is read in turn.

use crate::problem::{Problem, Source};
use ron::error::{Position, SpannedError};
use ron::value::RawValue;
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;

/// How deep values can stand inside each other.
const MAX_DEPTH: usize = 32;

pub(super) struct Tree {
    pub span: Range<usize>,
    pub node: Node,
}

/// A piece of text and its bytes in the source.
pub(super) struct Word {
    pub text: String,
    pub span: Range<usize>,
}

pub(super) enum Node {
    /// `Name(a: …, b: …)`, or without the name.
    Named(Option<Word>, Vec<(Word, Tree)>),
    /// `Name(…, …)`, or without the name.
    Tuple(Option<Word>, Vec<Tree>),
    /// `[…]`
    List(Vec<Tree>),
    /// `{…: …}`
    Map(Vec<(Tree, Tree)>),
    /// A text, with the bytes between its quotes.
    Text(Word),
    /// A name alone, such as `Covered` or `true`.
    Name,
    /// Numbers, and what no file here needs: characters, bytes, ranges.
    Other,
}

/// The whole of `source`.
pub(super) fn read(source: &Source) -> Result<Tree, Problem> {
    let raw = RawValue::from_ron(source.text()).map_err(|error| syntax(source, 0, &error))?;
    Builder { source }.tree(raw, 0)
}

/// An error of the `ron` crate in the text that begins at byte `start` of `source`.
fn syntax(source: &Source, start: usize, error: &SpannedError) -> Problem {
    let text = &source.text()[start..];
    let offset = |position: Position| {
        let mut lines = text.split_inclusive('\n');
        let before: usize = lines.by_ref().take(position.line.saturating_sub(1)).map(str::len).sum();
        let column = position.col.saturating_sub(1);
        start + before + lines.next().unwrap_or("").chars().take(column).map(char::len_utf8).sum::<usize>()
    };
    let span = offset(error.span.start)..offset(error.span.end);
    match error.code {
        ron::Error::ExceededRecursionLimit => too_deep(source, span),
        ref code => Problem::input("syntax", format!("this is not RON: {code}")).at(&source.at(span), "here"),
    }
}

fn too_deep(source: &Source, span: Range<usize>) -> Problem {
    Problem::input("nested-too-deeply", format!("values stand more than {MAX_DEPTH} deep inside each other"))
        .at(&source.at(span), "here")
}

struct Builder<'a> {
    source: &'a Source,
}

impl<'a> Builder<'a> {
    fn span(&self, piece: &str) -> Range<usize> {
        let start = piece.as_ptr().addr() - self.source.text().as_ptr().addr();
        start..start + piece.len()
    }

    fn word(&self, piece: &str) -> Word {
        Word { text: piece.to_owned(), span: self.span(piece) }
    }

    fn parse<T: Deserialize<'a>>(&self, piece: &'a RawValue) -> Result<T, Problem> {
        piece.into_rust().map_err(|error| syntax(self.source, self.span(piece.get_ron()).start, &error))
    }

    fn tree(&self, raw: &'a RawValue, depth: usize) -> Result<Tree, Problem> {
        let raw = raw.trim();
        let text = raw.get_ron();
        let span = self.span(text);
        if depth >= MAX_DEPTH {
            return Err(too_deep(self.source, span));
        }
        let name = name(text);
        let node = if text.starts_with('"')
            || text.starts_with("r\"")
            || text.starts_with("r#") && text.ends_with(['"', '#'])
        {
            self.text(raw)?
        } else if text.starts_with('{') {
            match self.parse::<Pieces<'a, &'a RawValue>>(raw)? {
                Pieces::Entries(entries) => Node::Map(
                    entries
                        .into_iter()
                        .map(|(key, value)| Ok((self.tree(key, depth + 1)?, self.tree(value, depth + 1)?)))
                        .collect::<Result<_, Problem>>()?,
                ),
                Pieces::Items(_) | Pieces::Some(_) => Node::Other,
            }
        } else if !name.is_empty() && name.len() == text.len() {
            Node::Name
        } else if text.ends_with([')', ']']) {
            let name = (!name.is_empty()).then(|| self.word(name));
            match self.parse::<Pieces<'a, &'a str>>(raw)? {
                Pieces::Entries(fields) => Node::Named(
                    name,
                    fields
                        .into_iter()
                        .map(|(key, value)| Ok((self.word(key), self.tree(value, depth + 1)?)))
                        .collect::<Result<_, Problem>>()?,
                ),
                Pieces::Items(items) if text.starts_with('[') => Node::List(self.items(items, depth)?),
                Pieces::Items(items) => Node::Tuple(name, self.items(items, depth)?),
                Pieces::Some(inner) => return self.tree(inner, depth + 1),
            }
        } else {
            Node::Other
        };
        Ok(Tree { span, node })
    }

    fn items(&self, items: Vec<&'a RawValue>, depth: usize) -> Result<Vec<Tree>, Problem> {
        items.into_iter().map(|item| self.tree(item, depth + 1)).collect()
    }

    fn text(&self, raw: &'a RawValue) -> Result<Node, Problem> {
        let text = raw.get_ron();
        let open = text.find('"').map_or(0, |quote| quote + 1);
        let close = text.rfind('"').unwrap_or(0).max(open);
        Ok(Node::Text(Word { text: self.parse(raw)?, span: self.span(&text[open..close]) }))
    }
}

/// The name that `text` begins with.
fn name(text: &str) -> &str {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    if text.starts_with(|c: char| c.is_alphabetic() || c == '_') { &text[..end] } else { "" }
}

/// What a value is made of, one level deep.
enum Pieces<'de, K> {
    Entries(Vec<(K, &'de RawValue)>),
    Items(Vec<&'de RawValue>),
    /// `Some(…)` means what is in it.
    Some(&'de RawValue),
}

impl<'de, K: Deserialize<'de>> Deserialize<'de> for Pieces<'de, K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PiecesVisitor(PhantomData))
    }
}

struct PiecesVisitor<K>(PhantomData<K>);

impl<'de, K: Deserialize<'de>> Visitor<'de> for PiecesVisitor<K> {
    type Value = Pieces<'de, K>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("fields, a list or a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        Ok(Pieces::Entries(entries))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = seq.next_element()? {
            items.push(item);
        }
        Ok(Pieces::Items(items))
    }

    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(Pieces::Items(Vec::new()))
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        Deserialize::deserialize(deserializer).map(Pieces::Some)
    }
}
