//! Expressions in pipeline files and in `@if(…)` of kernels: sizes, counts, conditions, named values.
//!
//! One small language of numbers, vectors, flags and texts, without side effects and without loops, so that every
//! expression ends. Names are looked up in a [`Names`]; a name whose value is not known yet (a scene number when there
//! is no scene) is [`Value::Unknown`], and what depends on it is unknown too, unless the rest decides it
//! (`false && unknown` is false).

/// What an expression evaluates to. Vectors have 2 to 4 components.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Number(f64),
    Vector(Vec<f64>),
    Flag(bool),
    Text(String),
    /// Depends on something that is not known yet.
    Unknown,
}

/// Where an expression finds the values of its names.
pub trait Names {
    /// The value of a (possibly dotted) name; `None` if there is no such name.
    fn get(&self, name: &str) -> Option<Value>;
    /// All names there are, for suggestions.
    fn known(&self) -> Vec<String>;
}
