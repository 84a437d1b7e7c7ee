//! What voxgi says when something is wrong: one type for every message, from parser to driver.
//!
//! A [`Problem`] names the cause in one sentence, points at the places in the user's own files, and says a
//! way out. Functions that check input collect all the problems they find ([`Problems`]) instead of stopping at
//! the first. Whether a problem is the user's input or a failure of the run decides the exit code
//! ([`Kind::exit_code`]).

mod render;
pub mod ron;
#[cfg(test)]
mod tests;

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// A text that messages can point into: its name as the user knows it, and its content. Cheap to clone.
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Source(Arc<(String, String)>);

impl Source {
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self(Arc::new((name.into(), text.into())))
    }

    pub fn name(&self) -> &str {
        &self.0.0
    }

    pub fn text(&self) -> &str {
        &self.0.1
    }

    /// The place of the bytes `span`, cut to the text and to character boundaries.
    pub fn at(&self, span: Range<usize>) -> Place {
        let floor = |mut i: usize| {
            i = i.min(self.text().len());
            while !self.text().is_char_boundary(i) {
                i -= 1;
            }
            i
        };
        let start = floor(span.start);
        Place { source: self.clone(), span: start..floor(span.end).max(start) }
    }
}

impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Source({})", self.name())
    }
}

/// Bytes of a [`Source`].
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Place {
    pub source: Source,
    pub span: Range<usize>,
}

impl Place {
    pub fn text(&self) -> &str {
        &self.source.text()[self.span.clone()]
    }

    /// Line and column, both from 1, columns in characters.
    pub fn line_column(&self) -> (usize, usize) {
        let before = &self.source.text()[..self.span.start];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }
}

impl fmt::Debug for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, column) = self.line_column();
        write!(f, "{}:{line}:{column}", self.source.name())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Suspicious, but the run goes on.
    Warning,
    /// The user's input is wrong.
    Input,
    /// The input may be right, but the run failed: the device, the driver, the disk.
    Failure,
}

impl Kind {
    /// The documented exit code of the process.
    pub fn exit_code(self) -> u8 {
        match self {
            Kind::Warning => 0,
            Kind::Failure => 1,
            Kind::Input => 2,
        }
    }
}

/// One message, made by [`Problem::input`], [`Problem::failure`] or [`Problem::warning`] and filled in by the
/// other methods.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    pub kind: Kind,
    /// Stable name of this sort of problem, such as `unknown-knob`.
    pub code: &'static str,
    pub message: String,
    /// Places and what to say at each; the first is where the user should look.
    pub labels: Vec<(Place, String)>,
    pub help: Option<String>,
}

/// Messages quote what the user wrote, however long that is: of more than this many bytes the middle is left out.
const MOST_WORDS: usize = 4000;

fn readable(text: String) -> String {
    if text.len() <= MOST_WORDS {
        return text;
    }
    let (start, end) =
        (text.floor_char_boundary(MOST_WORDS / 2), text.ceil_char_boundary(text.len() - MOST_WORDS / 4));
    format!("{} … {}", &text[..start], &text[end..])
}

impl Problem {
    fn new(kind: Kind, code: &'static str, message: impl Into<String>) -> Self {
        Self { kind, code, message: readable(message.into()), labels: Vec::new(), help: None }
    }

    pub fn input(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Kind::Input, code, message)
    }

    pub fn failure(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Kind::Failure, code, message)
    }

    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Kind::Warning, code, message)
    }

    #[must_use]
    pub fn at(mut self, place: &Place, label: impl Into<String>) -> Self {
        self.labels.push((place.clone(), readable(label.into())));
        self
    }

    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(readable(help.into()));
        self
    }

    /// Says which of `known` was surely meant by `given`, or else lists what there is.
    #[must_use]
    pub fn suggest<'a>(self, given: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        let mut known: Vec<&str> = known.into_iter().collect();
        known.sort_unstable();
        known.dedup();
        let help = match closest(given, &known) {
            Some(name) => format!("did you mean `{name}`?"),
            None if known.is_empty() => return self,
            None if known.len() <= 24 => format!("there are: {}", known.join(", ")),
            None => format!("there are {} others, the first: {}", known.len(), known[..24].join(", ")),
        };
        self.help(help)
    }
}

/// The only near name: within a third of its length by edits with transpositions, and no second one as near.
fn closest<'a>(given: &str, known: &[&'a str]) -> Option<&'a str> {
    let mut near: Vec<(usize, &str)> =
        known.iter().map(|name| (strsim::damerau_levenshtein(given, name), *name)).collect();
    near.sort_unstable();
    let (distance, name) = *near.first()?;
    let alone = near.get(1).is_none_or(|second| second.0 > distance);
    (distance <= given.chars().count().max(3) / 3 && alone).then_some(name)
}

impl From<Problem> for Problems {
    fn from(problem: Problem) -> Self {
        Self(vec![problem])
    }
}

/// At least one problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problems(Vec<Problem>);

impl Problems {
    /// `Err` if any of `found` is more than a warning.
    pub fn check(found: Vec<Problem>) -> Result<Vec<Problem>, Problems> {
        if found.iter().any(|p| p.kind != Kind::Warning) { Err(Self(found)) } else { Ok(found) }
    }

    pub fn iter(&self) -> impl Iterator<Item = &Problem> {
        self.0.iter()
    }

    pub fn exit_code(&self) -> u8 {
        self.0.iter().map(|p| p.kind).max().map_or(1, Kind::exit_code)
    }
}

pub type Result<T, E = Problems> = std::result::Result<T, E>;
