//! RON files read with serde, whose mistakes are placed in the file.
//!
//! A part of the file that is to have its own place is taken as `&RawValue`, which is a piece of the file's own text, and
//! read on its own by [`RonFile::value`].

use super::{Place, Problem, Source};
use ron::Options;
use ron::error::{Error, Position, SpannedError};
use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::Deserialize;

pub struct RonFile {
    pub source: Source,
    /// Code of problems with the text.
    pub code: &'static str,
    /// What the file is: "the setting".
    pub what: &'static str,
}

impl RonFile {
    /// All of the file. Optional fields are written without `Some`.
    ///
    /// Errors: with the file's code, at the place that is wrong.
    pub fn parse<'a, T: Deserialize<'a>>(&'a self) -> Result<T, Problem> {
        self.piece(self.source.text(), 0)
    }

    /// A part of the file.
    pub fn value<T: for<'a> Deserialize<'a>>(&self, raw: &RawValue) -> Result<T, Problem> {
        let place = self.place(raw);
        self.piece(place.text(), place.span.start)
    }

    /// Where a part of the file stands.
    pub fn place(&self, raw: &RawValue) -> Place {
        let text = raw.trim().get_ron();
        let start = (text.as_ptr() as usize).saturating_sub(self.source.text().as_ptr() as usize);
        self.source.at(start..start + text.len())
    }

    /// The piece `text` of the source, which starts at byte `offset`.
    fn piece<'a, T: Deserialize<'a>>(&self, text: &'a str, offset: usize) -> Result<T, Problem> {
        let options = Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        options.from_str(text).map_err(|SpannedError { code, span }| {
            let range = offset + byte(text, span.start)..offset + byte(text, span.end);
            let problem = Problem::input(self.code, format!("{} can't be read: {code}", self.what));
            let problem = problem.at(&self.source.at(range), "here");
            match &code {
                Error::NoSuchStructField { expected, found, .. }
                | Error::NoSuchEnumVariant { expected, found, .. } => {
                    problem.suggest(found, expected.iter().copied())
                }
                _ => problem,
            }
        })
    }
}

/// Byte of a position, whose line and column (in characters) count from 1.
fn byte(text: &str, position: Position) -> usize {
    let line: usize = text.split_inclusive('\n').take(position.line.saturating_sub(1)).map(str::len).sum();
    let column = text[line..].chars().take(position.col.saturating_sub(1));
    line + column.map(char::len_utf8).sum::<usize>()
}
