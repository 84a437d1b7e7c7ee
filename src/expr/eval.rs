//! Computes the tree of an expression.

use super::parse::{Node, Tree};
use super::{Names, Value};
use crate::problem::{Problem, Source};

pub(super) struct Eval<'a> {
    pub source: &'a Source,
    pub names: &'a dyn Names,
}

impl Eval<'_> {
    pub fn value(&self, tree: &Tree) -> Result<Value, Problem> {
        match &tree.node {
            Node::Literal(value) => Ok(value.clone()),
            Node::Name(name) => self.name(name, tree),
            Node::Component(of, index) => match self.value(&of[0])? {
                Value::Vector(components) => {
                    components.get(*index).copied().map(Value::Number).ok_or_else(|| {
                        let found = format!("has {} components", components.len());
                        Problem::input("expression-type", "this vector has no such component")
                            .at(&self.place(&of[0]), found)
                    })
                }
                Value::Unknown => Ok(Value::Unknown),
                other => Err(self.wrong_type("a component is taken of", "a vector", &of[0], &other)),
            },
            Node::Prefix("!", of) => {
                Ok(self.flag("!", &of[0])?.map_or(Value::Unknown, |flag| Value::Flag(!flag)))
            }
            Node::Prefix(symbol, of) => self.componentwise(symbol, tree, of.as_slice(), |x| -x[0]),
            Node::Infix(symbol @ ("&&" | "||"), sides) => self.logic(symbol, sides),
            Node::Infix(symbol @ ("==" | "!="), sides) => self.equality(symbol, tree, sides),
            Node::Infix(symbol @ ("<" | "<=" | ">" | ">="), sides) => self.comparison(symbol, sides),
            Node::Infix(symbol, sides) => self.arithmetic(symbol, tree, sides),
            Node::If(pieces) => self.choice(pieces),
            Node::Call(function, arguments) => self.call(function.name, tree, arguments),
        }
    }

    fn place(&self, tree: &Tree) -> crate::problem::Place {
        self.source.at(tree.span.clone())
    }

    fn wrong_type(&self, what: &str, wanted: &str, tree: &Tree, found: &Value) -> Problem {
        Problem::input("expression-type", format!("{what} {wanted}, but this is {}", found.kind()))
            .at(&self.place(tree), format!("this is {found}"))
    }

    fn name(&self, name: &str, tree: &Tree) -> Result<Value, Problem> {
        self.names.get(name).ok_or_else(|| {
            Problem::input("unknown-name", format!("there is no `{name}` here"))
                .at(&self.place(tree), "used here")
        })
    }

    /// `None`: unknown.
    fn flag(&self, symbol: &str, tree: &Tree) -> Result<Option<bool>, Problem> {
        match self.value(tree)? {
            Value::Flag(flag) => Ok(Some(flag)),
            Value::Unknown => Ok(None),
            other => Err(self.wrong_type(&format!("`{symbol}` takes"), "a flag", tree, &other)),
        }
    }

    /// The right side is not computed where the left side decides.
    fn logic(&self, symbol: &str, sides: &[Tree; 2]) -> Result<Value, Problem> {
        let decides = Some(symbol == "||");
        let left = self.flag(symbol, &sides[0])?;
        let result = if left == decides {
            left
        } else {
            match self.flag(symbol, &sides[1])? {
                right if right == decides => right,
                right => left.and(right),
            }
        };
        Ok(result.map_or(Value::Unknown, Value::Flag))
    }

    fn equality(&self, symbol: &str, tree: &Tree, sides: &[Tree; 2]) -> Result<Value, Problem> {
        let (left, right) = (self.value(&sides[0])?, self.value(&sides[1])?);
        let equal = match (&left, &right) {
            (Value::Unknown, _) | (_, Value::Unknown) => return Ok(Value::Unknown),
            (Value::Vector(a), Value::Vector(b)) if a.len() != b.len() => {
                return Err(self.lengths(symbol, tree, a.len(), b.len()));
            }
            (a, b) if a.kind() == b.kind() => a == b,
            (a, b) => {
                let message = format!("`{symbol}` can't compare {} with {}", a.kind(), b.kind());
                return Err(Problem::input("expression-type", message)
                    .at(&self.place(&sides[0]), format!("this is {a}"))
                    .at(&self.place(&sides[1]), format!("this is {b}")));
            }
        };
        Ok(Value::Flag(equal == (symbol == "==")))
    }

    fn comparison(&self, symbol: &str, sides: &[Tree; 2]) -> Result<Value, Problem> {
        let mut numbers = [Some(0.0); 2];
        for (number, side) in numbers.iter_mut().zip(sides) {
            *number = match self.value(side)? {
                Value::Number(number) => Some(number),
                Value::Unknown => None,
                other => {
                    return Err(self.wrong_type(&format!("`{symbol}` compares"), "numbers", side, &other));
                }
            };
        }
        let [Some(left), Some(right)] = numbers else { return Ok(Value::Unknown) };
        Ok(Value::Flag(match symbol {
            "<" => left < right,
            "<=" => left <= right,
            ">" => left > right,
            _ => left >= right,
        }))
    }

    fn arithmetic(&self, symbol: &str, tree: &Tree, sides: &[Tree; 2]) -> Result<Value, Problem> {
        let operation: fn(&[f64]) -> f64 = match symbol {
            "+" => |x| x[0] + x[1],
            "-" => |x| x[0] - x[1],
            "*" => |x| x[0] * x[1],
            "/" => |x| x[0] / x[1],
            _ => |x| x[0] % x[1],
        };
        self.componentwise(symbol, tree, sides, operation)
    }

    /// Where the condition is unknown, the value is still known if both branches agree.
    fn choice(&self, pieces: &[Tree; 3]) -> Result<Value, Problem> {
        let [condition, yes, no] = pieces;
        match self.flag("if", condition)? {
            Some(true) => self.value(yes),
            Some(false) => self.value(no),
            None => {
                let (yes, no) = (self.value(yes)?, self.value(no)?);
                Ok(if yes == no { yes } else { Value::Unknown })
            }
        }
    }

    fn call(&self, name: &str, tree: &Tree, arguments: &[Tree]) -> Result<Value, Problem> {
        let operation: fn(&[f64]) -> f64 = match name {
            "abs" => |x| x[0].abs(),
            "ceil" => |x| x[0].ceil(),
            // Not f64::clamp, which panics where the bounds are in the wrong order.
            "clamp" => |x| x[0].max(x[1]).min(x[2]),
            "cos_degrees" => |x| turned(x[0], 1.0),
            "exp2" => |x| x[0].exp2(),
            "floor" => |x| x[0].floor(),
            "log2" => |x| x[0].log2(),
            "max" => |x| x.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            "min" => |x| x.iter().copied().fold(f64::INFINITY, f64::min),
            "pow" => |x| x[0].powf(x[1]),
            "round" => |x| x[0].round_ties_even(),
            "sin_degrees" => |x| turned(x[0], 0.0),
            "sqrt" => |x| x[0].sqrt(),
            "vec2" => return self.vector(tree, arguments, 2),
            "vec3" => return self.vector(tree, arguments, 3),
            "vec4" => return self.vector(tree, arguments, 4),
            _ => return self.reduce(name, tree, arguments),
        };
        self.componentwise(name, tree, arguments, operation)
    }

    /// `vec3(1)`, `vec3(1, 2, 3)`, `vec3(size, 1)` for a `size` of two components.
    fn vector(&self, tree: &Tree, arguments: &[Tree], length: usize) -> Result<Value, Problem> {
        let mut components = Vec::new();
        let mut known = true;
        for argument in arguments {
            match self.value(argument)? {
                Value::Number(number) => components.push(number),
                Value::Vector(vector) => components.extend(vector),
                Value::Unknown => known = false,
                other => {
                    return Err(self.wrong_type(
                        &format!("`vec{length}` takes"),
                        "numbers",
                        argument,
                        &other,
                    ));
                }
            }
        }
        match (known, components.as_slice()) {
            (false, _) => Ok(Value::Unknown),
            (true, [one]) => Ok(Value::Vector(vec![*one; length])),
            (true, all) if all.len() == length => Ok(Value::Vector(components)),
            (true, all) => {
                let message = format!("`vec{length}` needs {length} numbers (or one), not {}", all.len());
                Err(Problem::input("expression-type", message).at(&self.place(tree), "here"))
            }
        }
    }

    /// The functions that make a number of vectors.
    fn reduce(&self, name: &str, tree: &Tree, arguments: &[Tree]) -> Result<Value, Problem> {
        let mut vectors = Vec::new();
        for argument in arguments {
            match self.value(argument)? {
                Value::Vector(vector) => vectors.push(vector),
                Value::Unknown => vectors.push(Vec::new()),
                other => {
                    return Err(self.wrong_type(&format!("`{name}` takes"), "vectors", argument, &other));
                }
            }
        }
        if vectors.iter().any(Vec::is_empty) {
            return Ok(Value::Unknown);
        }
        let (first, last) = (&vectors[0], &vectors[vectors.len() - 1]);
        if first.len() != last.len() {
            return Err(self.lengths(name, tree, first.len(), last.len()));
        }
        let product = || first.iter().zip(last).map(|(a, b)| a * b).sum::<f64>();
        let number = match name {
            "dot" => product(),
            "length" => product().sqrt(),
            "max_of" => first.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            _ => first.iter().copied().fold(f64::INFINITY, f64::min),
        };
        self.finite(name, tree, number).map(Value::Number)
    }

    fn lengths(&self, name: &str, tree: &Tree, left: usize, right: usize) -> Problem {
        let message = format!("`{name}` takes vectors of one length, not of {left} and {right} components");
        Problem::input("expression-type", message).at(&self.place(tree), "here")
    }

    fn finite(&self, name: &str, tree: &Tree, number: f64) -> Result<f64, Problem> {
        if number.is_finite() {
            return Ok(number);
        }
        Err(Problem::input("not-finite", format!("the result of `{name}` is not a finite number"))
            .at(&self.place(tree), format!("this is {number}")))
    }

    /// Applies `operation` to numbers, or to each component where some are vectors.
    fn componentwise(
        &self,
        name: &str,
        tree: &Tree,
        arguments: &[Tree],
        operation: fn(&[f64]) -> f64,
    ) -> Result<Value, Problem> {
        let mut values = Vec::with_capacity(arguments.len());
        let mut length = None;
        for argument in arguments {
            let value = self.value(argument)?;
            match &value {
                Value::Number(_) | Value::Unknown => {}
                Value::Vector(vector) => match length {
                    Some(length) if length != vector.len() => {
                        return Err(self.lengths(name, tree, length, vector.len()));
                    }
                    _ => length = Some(vector.len()),
                },
                _ => {
                    return Err(self.wrong_type(
                        &format!("`{name}` takes"),
                        "numbers or vectors",
                        argument,
                        &value,
                    ));
                }
            }
            values.push(value);
        }
        if values.contains(&Value::Unknown) {
            return Ok(Value::Unknown);
        }
        let component = |value: &Value, i: usize| match value {
            Value::Vector(vector) => vector.get(i).copied().unwrap_or(f64::NAN),
            Value::Number(number) => *number,
            _ => f64::NAN,
        };
        let mut results = Vec::with_capacity(length.unwrap_or(1));
        for i in 0..length.unwrap_or(1) {
            let inputs: Vec<f64> = values.iter().map(|value| component(value, i)).collect();
            if matches!(name, "/" | "%") && inputs[1] == 0.0 {
                return Err(Problem::input("division-by-zero", "division by zero")
                    .at(&self.place(&arguments[1]), format!("this is {}", values[1])));
            }
            results.push(self.finite(name, tree, operation(&inputs))?);
        }
        Ok(match (length, results.as_slice()) {
            (None, [number]) => Value::Number(*number),
            _ => Value::Vector(results),
        })
    }
}

/// The sine of an angle in degrees and as many quarter turns more. Whole quarters are taken off first, so that
/// multiples of 90 give -1, 0 or 1 and nothing beside.
fn turned(degrees: f64, quarters: f64) -> f64 {
    let quarter = (degrees / 90.0).round();
    let rest = (degrees - 90.0 * quarter).to_radians();
    match (quarter + quarters).rem_euclid(4.0) as u8 {
        0 => rest.sin(),
        1 => rest.cos(),
        2 => -rest.sin(),
        _ => -rest.cos(),
    }
}
