//! `@if(…)`, `@elif(…)`, `@else`: which of the pieces of a kernel that stand one after another are kept.
//!
//! Conditions are three-valued. One that can't be decided yet keeps its piece, so that checking without a scene sees
//! the widest variant, and drops the `@elif` and `@else` after it.

use crate::expr::{Expr, Names, Value};
use crate::problem::{Place, Problem};

/// Names as a module of a role sees them: those of the role first (`ROLE.NAME`), then those everybody sees.
pub struct RoleNames<'a> {
    pub role: &'a str,
    pub names: &'a dyn Names,
}

impl Names for RoleNames<'_> {
    fn get(&self, name: &str) -> Option<Value> {
        self.names.get(&format!("{}.{name}", self.role)).or_else(|| self.names.get(name))
    }

    fn known(&self) -> Vec<String> {
        let mut known = self.names.known();
        let prefix = format!("{}.", self.role);
        let own: Vec<String> =
            known.iter().filter_map(|name| name.strip_prefix(&prefix)).map(str::to_owned).collect();
        known.extend(own);
        known
    }
}

/// The condition in front of a piece.
pub enum Condition {
    If(Place),
    Elif(Place),
    Else,
}

/// What became of the pieces before, in a run of `@if`, `@elif` and `@else`.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Chain {
    /// The piece before has no condition.
    None,
    /// No condition held so far.
    Open,
    /// One held, or may hold.
    Taken,
}

/// Whether a piece is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Keep,
    /// Kept because nobody can tell yet.
    Undecided,
    Drop,
}

impl Chain {
    /// Decides the piece that `condition` (written at `place`) stands before. A piece whose condition is wrong is
    /// kept, so that further problems in it are found as well.
    pub fn decide(
        &mut self,
        condition: Option<&Condition>,
        place: &Place,
        names: &dyn Names,
    ) -> (Verdict, Option<Problem>) {
        let before = *self;
        let expression = match condition {
            None => {
                *self = Chain::None;
                return (Verdict::Keep, None);
            }
            Some(Condition::If(expression)) => expression,
            Some(_) if before == Chain::None => {
                let problem =
                    Problem::input("lone-else", format!("`{}` without an `@if` before it", place.text()))
                        .at(place, "nothing comes before this to be the other case of")
                        .help("it must directly follow a piece with `@if` or `@elif` in the same list");
                return (Verdict::Keep, Some(problem));
            }
            Some(Condition::Elif(expression)) => expression,
            Some(Condition::Else) => {
                *self = Chain::None;
                return (if before == Chain::Taken { Verdict::Drop } else { Verdict::Keep }, None);
            }
        };
        let taken = matches!(condition, Some(Condition::Elif(_))) && before == Chain::Taken;
        let (verdict, problem) = match holds(expression, names) {
            Ok(Some(true)) => (Verdict::Keep, None),
            Ok(Some(false)) => (Verdict::Drop, None),
            Ok(None) => (Verdict::Undecided, None),
            Err(problem) => (Verdict::Keep, Some(problem)),
        };
        let verdict = if taken { Verdict::Drop } else { verdict };
        *self = if taken || verdict != Verdict::Drop { Chain::Taken } else { Chain::Open };
        (verdict, problem)
    }
}

/// The flag an expression gives; `None` if it is not known yet.
fn holds(expression: &Place, names: &dyn Names) -> Result<Option<bool>, Problem> {
    match Expr::parse(expression)?.eval(names)? {
        Value::Flag(flag) => Ok(Some(flag)),
        Value::Unknown => Ok(None),
        other => Err(Problem::input(
            "bad-condition",
            format!("a condition must be true or false, not {}", other.kind()),
        )
        .at(expression, format!("this is {other}"))
        .help("compare it with something: `x > 0`, `x == 6`")),
    }
}
