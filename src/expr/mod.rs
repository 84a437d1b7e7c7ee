//! Expressions in pipeline files and in `@if(…)` of kernels: sizes, counts, conditions, named values.
//!
//! One small language of numbers, vectors, flags and texts, without side effects and without loops, so that every
//! expression ends. Names are looked up in a [`Names`]; a name whose value is not known yet (a scene number when there
//! is no scene) is [`Value::Unknown`], and what depends on it is unknown too, unless the rest decides it
//! (`false && unknown` is false).
//!
//! ```text
//! 0.5  1e-3  0x40  true  false  "text"  'text'         literals
//! scene.emissive  radiance.width  position.x           dotted names; `.x .y .z .w` at the end is a component
//! !  -   * / %   + -   < <= > >=   == !=   &&   ||     from tight to loose; `%` has the sign of its left side
//! if(condition, then, else)                            only the branch that is chosen is computed
//! min max clamp abs floor ceil round sqrt log2 exp2 pow   component by component
//! sin_degrees cos_degrees                              the same; exact where the angle is a multiple of 90
//! vec2 vec3 vec4   dot length max_of min_of            vectors from numbers and vectors; numbers from vectors
//! ```
//!
//! A number beside a vector stands for all its components. A result that is not finite is an error, where it arises.

mod eval;
mod parse;
#[cfg(test)]
mod tests;
mod token;

use crate::problem::{Place, Problem};
use parse::{Node, Tree};
use std::fmt;

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

impl Value {
    /// The sort of value, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Value::Number(_) => "a number",
            Value::Vector(_) => "a vector",
            Value::Flag(_) => "a flag",
            Value::Text(_) => "a text",
            Value::Unknown => "not known yet",
        }
    }
}

/// As an expression would write it.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Number(number) => write!(f, "{number}"),
            Value::Vector(components) => {
                write!(f, "vec{}(", components.len())?;
                for (i, component) in components.iter().enumerate() {
                    write!(f, "{}{component}", if i == 0 { "" } else { ", " })?;
                }
                f.write_str(")")
            }
            Value::Flag(flag) => write!(f, "{flag}"),
            Value::Text(text) => write!(f, "'{text}'"),
            Value::Unknown => f.write_str("unknown"),
        }
    }
}

/// Where an expression finds the values of its names.
pub trait Names {
    /// The value of a (possibly dotted) name; `None` if there is no such name.
    fn get(&self, name: &str) -> Option<Value>;
    /// All names there are, for suggestions.
    fn known(&self) -> Vec<String>;
    /// Whether there is such a name. Asked for all names of an expression, also those in branches not taken.
    fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }
}

/// An expression that has been read, but not computed.
#[derive(Clone, Debug)]
pub struct Expr {
    place: Place,
    tree: Tree,
}

impl Expr {
    /// Reads the text of `place`. A problem points at the piece of it that is wrong.
    pub fn parse(place: &Place) -> Result<Self, Problem> {
        Ok(Self { place: place.clone(), tree: parse::parse(place)? })
    }

    /// Where the whole expression stands.
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// Computes the expression. All its names must exist, also in branches that are not taken.
    pub fn eval(&self, names: &dyn Names) -> Result<Value, Problem> {
        for (name, place) in self.names() {
            if !names.has(name) {
                let known = names.known();
                return Err(Problem::input("unknown-name", format!("there is no `{name}` here"))
                    .at(&place, "used here")
                    .suggest(name, known.iter().map(String::as_str)));
            }
        }
        eval::Eval { source: &self.place.source, names }.value(&self.tree)
    }

    /// The names it mentions, in the order of the text, without components: `position.x` mentions `position`.
    pub fn names(&self) -> impl Iterator<Item = (&str, Place)> {
        let mut found = Vec::new();
        let mut open = vec![&self.tree];
        while let Some(tree) = open.pop() {
            match &tree.node {
                Node::Name(name) => found.push((name.as_str(), self.place.source.at(tree.span.clone()))),
                node => open.extend(node.children().iter().rev()),
            }
        }
        found.into_iter()
    }
}
