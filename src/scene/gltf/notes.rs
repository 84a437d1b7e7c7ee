//! What reading a glTF file finds on its way: faults, which are the file's, and lacks, which are ours.

use crate::problem::{Problem, Problems};
use crate::scene::Lack;
use std::borrow::Cow;
use std::fmt::Display;

/// More faults than this say nothing new.
const MOST_PROBLEMS: usize = 20;
/// More kinds of lacks than this nobody reads.
const MOST_LACKS: usize = 50;
/// Longest message that repeats what a file says, in characters.
const MOST_CHARACTERS: usize = 300;

/// The start of a long text.
pub fn brief(text: &str) -> Cow<'_, str> {
    match text.char_indices().nth(MOST_CHARACTERS) {
        Some((end, _)) => Cow::Owned(format!("{}…", &text[..end])),
        None => Cow::Borrowed(text),
    }
}

/// Something wrong with the file, not yet tied to the place where it was met.
#[derive(Debug)]
pub struct Fault {
    pub code: &'static str,
    pub message: String,
    pub help: Option<&'static str>,
}

impl Fault {
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), help: None }
    }

    pub fn help(mut self, help: &'static str) -> Self {
        self.help = Some(help);
        self
    }

    /// An index that names nothing.
    pub fn beyond(what: &str, index: usize, count: usize) -> Self {
        let message = format!("names {what} {index}, but there are only {count}, counted from 0");
        Self::new("gltf-reference", message)
    }

    /// As a problem of the file `name`, met at the JSON pointer `pointer`.
    pub fn at(self, name: &str, pointer: impl Display) -> Problem {
        let message = brief(&self.message);
        let problem = Problem::input(self.code, format!("`{name}` at {pointer}: {message}"));
        match self.help {
            Some(help) => problem.help(help),
            None => problem,
        }
    }
}

/// The faults and lacks of one file.
pub struct Notes {
    name: String,
    problems: Vec<Problem>,
    lacks: Vec<Lack>,
}

impl Notes {
    /// `name`: the file as messages name it.
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), problems: Vec::new(), lacks: Vec::new() }
    }

    pub fn fault(&mut self, pointer: impl Display, fault: Fault) {
        if self.problems.len() < MOST_PROBLEMS {
            self.problems.push(fault.at(&self.name, pointer));
        }
    }

    /// Whether there are so many faults that there is no use in looking for more.
    pub fn is_full(&self) -> bool {
        self.problems.len() >= MOST_PROBLEMS
    }

    /// The value, or else notes the fault.
    pub fn catch<T>(&mut self, pointer: impl Display, result: Result<T, Fault>) -> Option<T> {
        result.map_err(|fault| self.fault(pointer, fault)).ok()
    }

    /// Counts one more `what` (a singular noun) that is `instead`.
    pub fn lack(&mut self, what: &str, instead: &str) {
        let (what, instead) = match self.lacks.len() < MOST_LACKS {
            true => (&*brief(what), instead),
            false => ("thing of other kinds", "left out"),
        };
        match self.lacks.iter_mut().find(|lack| lack.what == what && lack.instead == instead) {
            Some(lack) => lack.count += 1,
            None => {
                self.lacks.push(Lack { what: what.to_owned(), count: 1, instead: instead.to_owned() });
            }
        }
    }

    /// The faults so far, if there are any.
    pub fn check(&self) -> Result<(), Problems> {
        Problems::check(self.problems.clone()).map(|_| ())
    }

    /// The lacks, if there was no fault.
    pub fn finish(self) -> Result<Vec<Lack>, Problems> {
        Problems::check(self.problems).map(|_| self.lacks)
    }
}
