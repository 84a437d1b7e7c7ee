//! What is tried of a knob.

use super::range::Range;
use crate::document::{Allowed, Literal};
use crate::expr::Value;
use crate::plan::PlannedKnob;
use crate::problem::{Problem, Result};

#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// All of them, known by their index. Ordered are numbers, which then rise.
    List { values: Vec<Value>, ordered: bool },
    /// Some of them.
    Range(Range),
}

impl Values {
    /// All that the knob allows, between `within` if that is said. Errors are inputs `not-a-number` (`within` of a knob
    /// that is none), `knob-out-of-range` (it leaves what the knob allows) and `no-values` (nothing is between).
    pub fn new(knob: &PlannedKnob, within: Option<[f64; 2]>) -> Result<Self> {
        let about = |code, message: String| {
            Problem::input(code, message).at(&knob.place, "declared here").help(allowed(&knob.knob.allowed))
        };
        let whole = match &knob.knob.default.value {
            Literal::Whole(_) => Some(true),
            Literal::Real(_) => Some(false),
            Literal::Flag(_) | Literal::Text(_) => None,
        };
        if within.is_some() && whole.is_none() {
            let message = format!("the knob `{}` is no number: it has nothing between A and B", knob.path);
            return Err(about("not-a-number", message).into());
        }
        let empty = || match within {
            Some([a, b]) => {
                about("no-values", format!("the knob `{}` has no value from {a} to {b}", knob.path))
            }
            None => about("no-values", format!("the knob `{}` has no values", knob.path)),
        };
        match &knob.knob.allowed {
            Allowed::Any => Ok(Self::List { values: [false, true].map(Value::Flag).into(), ordered: false }),
            Allowed::Values(literals) => {
                let mut values: Vec<Value> = literals.iter().map(Value::from).collect();
                if let Some([a, b]) = within {
                    values.retain(|value| number(value).is_some_and(|number| a <= number && number <= b));
                }
                if whole.is_some() {
                    values
                        .sort_by(|a, b| f64::total_cmp(&number(a).unwrap_or(0.0), &number(b).unwrap_or(0.0)));
                }
                values.dedup();
                if values.is_empty() {
                    return Err(empty().into());
                }
                Ok(Self::List { values, ordered: whole.is_some() })
            }
            Allowed::Range(least, most) => {
                let [a, b] = within.unwrap_or([*least, *most]);
                if a < *least || b > *most {
                    let message = format!("the knob `{}` can't be all that is from {a} to {b}", knob.path);
                    return Err(about("knob-out-of-range", message).into());
                }
                Ok(Self::Range(Range::new(a..=b, whole == Some(true)).ok_or_else(empty)?))
            }
        }
    }

    /// The value at a position: the number itself in a range, an index in a list.
    pub fn at(&self, position: f64) -> Value {
        match self {
            Self::Range(_) => Value::Number(position),
            Self::List { values, .. } => values.get(position as usize).cloned().unwrap_or(Value::Unknown),
        }
    }
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Number(number) => Some(*number),
        _ => None,
    }
}

fn allowed(allowed: &Allowed) -> String {
    let listed = |values: &[Literal]| {
        values.iter().map(|value| Value::from(value).to_string()).collect::<Vec<_>>().join(", ")
    };
    match allowed {
        Allowed::Any => "it can be true or false".to_owned(),
        Allowed::Range(least, most) => format!("it can be from {least} to {most}"),
        Allowed::Values(values) => format!("it can be one of {}", listed(values)),
    }
}

/// A value as `--set` takes it.
pub fn text(value: &Value) -> String {
    match value {
        Value::Text(text) => text.clone(),
        other => other.to_string(),
    }
}
