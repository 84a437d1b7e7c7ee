//! Knobs: their defaults, what the user sets, and what is allowed.

use super::world::World;
use super::{Named, Plan, PlannedKnob, ScopeId};
use crate::document::{Allowed, Entries, Knob, Literal};
use crate::expr::Value;
use crate::problem::{Place, Problem, Source};

impl From<&Literal> for Value {
    fn from(literal: &Literal) -> Self {
        match literal {
            Literal::Whole(number) => Value::Number(*number as f64),
            Literal::Real(number) => Value::Number(*number),
            Literal::Flag(flag) => Value::Flag(*flag),
            Literal::Text(text) => Value::Text(text.clone()),
        }
    }
}

fn type_name(literal: &Literal) -> &'static str {
    match literal {
        Literal::Whole(_) => "a whole number",
        Literal::Real(_) => "a number",
        Literal::Flag(_) => "`true` or `false`",
        Literal::Text(_) => "a text",
    }
}

/// Whether a knob whose default is `default` can have the value `other`.
fn fits(default: &Literal, other: &Literal) -> bool {
    use Literal::{Flag, Real, Text, Whole};
    matches!(
        (default, other),
        (Whole(_), Whole(_)) | (Real(_), Whole(_) | Real(_)) | (Flag(_), Flag(_)) | (Text(_), Text(_))
    )
}

impl World<'_> {
    /// Adds the knobs of a file with their defaults, under paths that begin with `prefix`.
    pub fn add_knobs(&mut self, knobs: &Entries<Knob>, prefix: &str, scope: ScopeId) {
        for (name, knob) in knobs {
            if let Some(problem) = ill_formed(&knob.value, &name.value) {
                self.report(problem);
            } else if let Some(problem) =
                forbidden(&knob.value, &knob.value.default.value, &knob.value.default.place)
            {
                self.report(problem);
            }
            let index = self.knobs.len();
            self.knobs.push(PlannedKnob {
                path: format!("{prefix}{}", name.value),
                value: Value::from(&knob.value.default.value),
                set: false,
                knob: knob.value.clone(),
                place: name.place.clone(),
            });
            self.declare(scope, &name.value, Named::Knob(index), &name.place);
        }
    }

    /// Sets the knobs that the user sets.
    pub fn set_knobs(&mut self) {
        for (name, text) in &self.setup.sets {
            let source = Source::new("--set", format!("{name}={text}"));
            let name_place = source.at(0..name.len());
            let value_place = source.at(name.len() + 1..source.text().len());
            let index = match named(&self.knobs, name) {
                Ok(index) => index,
                Err(problem) => {
                    self.report(problem.at(&name_place, "set here"));
                    continue;
                }
            };
            let knob = &self.knobs[index].knob;
            match read(knob, name, text, &value_place) {
                Ok(value) => {
                    self.knobs[index].value = value;
                    self.knobs[index].set = true;
                }
                Err(problem) => {
                    let problem = problem.at(&self.knobs[index].place, "declared here");
                    self.report(problem);
                }
            }
        }
    }
}

/// The index of the knob with this path, or the only one whose path ends with this name.
fn named(knobs: &[PlannedKnob], name: &str) -> Result<usize, Problem> {
    if let Some(index) = knobs.iter().position(|knob| knob.path == name) {
        return Ok(index);
    }
    let last = |path: &str| path.rsplit('.').next() == Some(name);
    let found: Vec<usize> = (0..knobs.len()).filter(|&i| last(&knobs[i].path)).collect();
    match found.as_slice() {
        [index] => Ok(*index),
        [] => {
            let last = |path| str::rsplit(path, '.').next().unwrap_or_default();
            let of_all = |path| if name.contains('.') { path } else { last(path) };
            Err(Problem::input("unknown-knob", format!("there is no knob `{name}`"))
                .suggest(name, knobs.iter().map(|knob| of_all(&knob.path))))
        }
        several => {
            let paths: Vec<&str> = several.iter().map(|&i| knobs[i].path.as_str()).collect();
            Err(Problem::input("ambiguous-knob", format!("{} knobs are called `{name}`", paths.len()))
                .help(format!("say which: {}", paths.join(", "))))
        }
    }
}

impl Plan {
    /// The knob with this path, or the only one whose path ends with this name.
    pub fn knob(&self, name: &str) -> Result<&PlannedKnob, Problem> {
        named(&self.knobs, name).map(|index| &self.knobs[index])
    }
}

impl PlannedKnob {
    /// The value that a text means, if the knob allows it.
    pub fn read(&self, text: &str) -> Result<Value, Problem> {
        let source = Source::new("value", text);
        read(&self.knob, &self.path, text, &source.at(0..text.len()))
    }
}

/// What is wrong with the declaration of a knob.
fn ill_formed(knob: &Knob, name: &str) -> Option<Problem> {
    let default = &knob.default.value;
    let message = match (&knob.allowed, default) {
        (Allowed::Any, Literal::Flag(_)) => return None,
        (Allowed::Any, Literal::Text(_)) => format!("the knob `{name}` is a text and needs a list of values"),
        (Allowed::Any, _) => format!("the knob `{name}` is a number and needs a range or a list of values"),
        (Allowed::Range(..), Literal::Flag(_) | Literal::Text(_)) => {
            format!("the knob `{name}` is {} and can't have a range", type_name(default))
        }
        (Allowed::Range(..), _) => return None,
        (Allowed::Values(values), _) => match values.iter().find(|value| !fits(default, value)) {
            Some(value) => {
                let (found, is) = (Value::from(value), type_name(default));
                format!("the knob `{name}` is {is}, but its values have {found} among them")
            }
            None => return None,
        },
    };
    let label = format!("the default is {}", type_name(default));
    Some(Problem::input("bad-knob", message).at(&knob.default.place, label))
}

/// The problem with a value that the knob doesn't allow.
fn forbidden(knob: &Knob, value: &Literal, place: &Place) -> Option<Problem> {
    let shown = Value::from(value);
    let says = match (&knob.allowed, &shown) {
        (Allowed::Range(least, most), Value::Number(number)) if number < least || number > most => {
            let unit = knob.unit.as_ref().map(|unit| format!(" {unit}")).unwrap_or_default();
            format!("from {least} to {most}{unit}")
        }
        (Allowed::Values(values), _) if !values.iter().any(|allowed| Value::from(allowed) == shown) => {
            let listed: Vec<String> = values.iter().map(|value| Value::from(value).to_string()).collect();
            format!("one of {}", listed.join(", "))
        }
        _ => return None,
    };
    let problem = Problem::input("knob-out-of-range", format!("{shown} is not allowed here"));
    Some(problem.at(place, "not allowed").help(format!("the knob can be {says}")))
}

/// The value that the user's text means.
fn read(knob: &Knob, name: &str, text: &str, place: &Place) -> Result<Value, Problem> {
    let trimmed = text.trim();
    let literal = match &knob.default.value {
        Literal::Whole(_) => trimmed.parse().ok().map(Literal::Whole),
        Literal::Real(_) => trimmed.parse().ok().filter(|number: &f64| number.is_finite()).map(Literal::Real),
        Literal::Flag(_) => trimmed.parse().ok().map(Literal::Flag),
        Literal::Text(_) => Some(Literal::Text(text.to_owned())),
    };
    let wanted = type_name(&knob.default.value);
    let literal = literal.ok_or_else(|| {
        Problem::input("knob-type", format!("the knob `{name}` is {wanted}"))
            .at(place, format!("not {wanted}"))
            .help(format!("its default is {}", Value::from(&knob.default.value)))
    })?;
    match forbidden(knob, &literal, place) {
        Some(problem) => Err(problem),
        None => Ok(Value::from(&literal)),
    }
}
