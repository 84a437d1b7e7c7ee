//! Uniforms: each field of a kernel's uniform is tied by name to a constant of the plan or to a word of the fact
//! table, and later filled at the offset that reflection gave.
//!
//! | uniform | fields |
//! |---|---|
//! | `knobs`, `values` | knobs and named values that the stage can see, by name |
//! | `camera`, `frame`, `view` | see [`super::facts`]; `view` is the element of the `Each(over: Views)` around the stage |
//! | `element` | the indices of the loops around the stage, by the loops' names |
//! | `geometry` | `first` and `triangles`: the scene's triangles that the stage goes over |
//! | `output`, `scene`, `lighting` | `output.width`, …: features; `lighting.total` is the feature `lights.total` |

use super::facts::{self, Slot};
use crate::document::Cause;
use crate::expr::Value;
use crate::kernel::{Binding, FieldKind, Scalar, StructLayout};
use crate::plan::{self, ElementOf, Named, Plan, PlannedStage, ScopeId};
use crate::problem::Problem;
use std::collections::{BTreeMap, BTreeSet};

/// Which names the engine fills.
pub const UNIFORMS: [&str; 9] =
    ["knobs", "values", "camera", "frame", "view", "element", "output", "lighting", "geometry"];

/// A uniform's bytes: constants already in place, the rest copied from the fact table each frame.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct UniformBlock {
    /// Constants in place. Not final while `complete` is false: without a scene.
    pub bytes: Vec<u8>,
    pub copies: Vec<Copy>,
    pub complete: bool,
}

/// Words of the fact table that go to an offset of a uniform.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Copy {
    pub from: Slot,
    pub offset: u32,
    pub kind: FieldKind,
}

/// Whether the engine fills the uniform `name`.
pub fn is_engine_uniform(name: &str) -> bool {
    name == "scene" || UNIFORMS.contains(&name)
}

enum Found {
    Constant(Value),
    Fact(Slot),
}

/// What a uniform is filled from.
pub struct Filler<'a> {
    pub plan: &'a Plan,
    pub stage: &'a PlannedStage,
    pub features: &'a BTreeMap<String, Value>,
}

impl Filler<'_> {
    /// Ties the fields of `binding` and adds to `depends` what they depend on. `scope`: where the binding's names are
    /// looked up (a role's module has its part's scope).
    pub fn fill(
        &self,
        binding: &Binding,
        layout: &StructLayout,
        scope: ScopeId,
        depends: &mut BTreeSet<u32>,
    ) -> Result<UniformBlock, Vec<Problem>> {
        let mut block =
            UniformBlock { bytes: vec![0; layout.size as usize], copies: Vec::new(), complete: true };
        let mut problems = Vec::new();
        for field in &layout.fields {
            if field.name.starts_with("_") {
                continue;
            }
            match self.find(&binding.name, &field.name, scope, depends) {
                None => problems.push(self.unknown(binding, &field.name, scope)),
                Some(Found::Constant(value)) => match encode(&value, field.kind) {
                    Some(Some(bytes)) => {
                        let at = field.offset as usize;
                        if let Some(target) = block.bytes.get_mut(at..at + bytes.len()) {
                            target.copy_from_slice(&bytes);
                        }
                    }
                    Some(None) => block.complete = false,
                    None => problems.push(
                        Problem::input(
                            "field-type",
                            format!(
                                "`{}.{}` is {}, which does not fit the field's type",
                                binding.name,
                                field.name,
                                describe(&value)
                            ),
                        )
                        .at(&binding.place, "declared here"),
                    ),
                },
                Some(Found::Fact(from)) => {
                    let words = match field.kind {
                        FieldKind::Vector { components, .. } => u32::from(components),
                        FieldKind::Matrix { columns, rows } => u32::from(columns) * u32::from(rows),
                        FieldKind::Other => 0,
                    };
                    // Named values take four words, whatever their length.
                    if words != from.words && !(binding.name == "values" && (1..=4).contains(&words)) {
                        problems.push(
                            Problem::input(
                                "field-type",
                                format!("`{}.{}` has {} components", binding.name, field.name, from.words),
                            )
                            .at(&binding.place, format!("declared here with {words}")),
                        );
                    }
                    block.copies.push(Copy {
                        from: Slot { words, ..from },
                        offset: field.offset as u32,
                        kind: field.kind,
                    });
                }
            }
        }
        if problems.is_empty() { Ok(block) } else { Err(problems) }
    }

    fn find(&self, uniform: &str, field: &str, scope: ScopeId, depends: &mut BTreeSet<u32>) -> Option<Found> {
        let feature = |prefix: &str| {
            self.features.get(&format!("{prefix}.{field}")).map(|v| Found::Constant(v.clone()))
        };
        match uniform {
            "knobs" => match self.plan.lookup(scope, field)? {
                Named::Knob(index) => {
                    Some(Found::Constant(self.plan.knobs.get(*index).map(|k| k.value.clone())?))
                }
                _ => None,
            },
            "values" => match self.plan.lookup(scope, field)? {
                Named::Value(index) => {
                    depends.insert(facts::value_bit(*index));
                    Some(Found::Fact(facts::value(*index)))
                }
                _ => None,
            },
            "camera" => {
                depends.insert(facts::bit(Cause::Camera));
                facts::camera(field).map(Found::Fact)
            }
            "frame" => {
                depends.insert(facts::bit(Cause::Frame));
                facts::frame(field).map(Found::Fact)
            }
            "view" => {
                depends.insert(facts::bit(Cause::Lights));
                depends.insert(facts::bit(Cause::Geometry));
                let element = self.stage.elements.iter().rev().find(|e| e.of == ElementOf::View)?;
                facts::view(self.plan.values.len(), element.index, field).map(Found::Fact)
            }
            "element" => {
                let element = self.stage.elements.iter().rev().find(|e| e.name == field)?;
                Some(Found::Constant(Value::Number(f64::from(element.index))))
            }
            "geometry" => {
                depends.insert(facts::bit(Cause::Geometry));
                let triangles = plan::triangles(self.features, self.stage.geometry);
                let number = |n: u64| Value::Number(n as f64);
                let value = match field {
                    "first" => triangles.map(|(first, _)| number(first)),
                    "triangles" => triangles.map(|(_, count)| number(count)),
                    _ => return None,
                };
                Some(Found::Constant(value.unwrap_or(Value::Unknown)))
            }
            "output" => feature("output"),
            "scene" => {
                depends.insert(facts::bit(Cause::Geometry));
                feature("scene")
            }
            "lighting" => {
                depends.insert(facts::bit(Cause::Lights));
                feature("lights")
            }
            _ => None,
        }
    }

    fn unknown(&self, binding: &Binding, field: &str, scope: ScopeId) -> Problem {
        let problem = Problem::input(
            if binding.name == "knobs" { "unknown-knob" } else { "unknown-field" },
            format!("stage `{}`: the uniform `{}` has no `{field}`", self.stage.path, binding.name),
        )
        .at(&binding.place, "declared here")
        .at(&self.stage.kernel_place, "used here");
        let visible = self.plan.visible(scope);
        let named = |want: fn(&Named) -> bool| {
            visible
                .iter()
                .copied()
                .filter(|n| self.plan.lookup(scope, n).is_some_and(want))
                .collect::<Vec<_>>()
        };
        match binding.name.as_str() {
            "knobs" => problem.suggest(field, named(|n| matches!(n, Named::Knob(_)))),
            "values" => problem.suggest(field, named(|n| matches!(n, Named::Value(_)))),
            "element" => problem.suggest(field, self.stage.elements.iter().map(|e| e.name.as_str())),
            "view" if !self.stage.elements.iter().any(|e| e.of == ElementOf::View) => {
                problem.help("`view` is there only inside `Each(over: Views)`; put the stage into one")
            }
            "output" | "scene" | "lighting" => {
                let prefix =
                    if binding.name == "lighting" { "lights." } else { &format!("{}.", binding.name) };
                problem.suggest(field, self.features.keys().filter_map(|k| k.strip_prefix(prefix)))
            }
            name => problem.suggest(field, facts::field_names(name)),
        }
    }
}

fn describe(value: &Value) -> String {
    match value {
        Value::Number(n) => format!("the number {n}"),
        Value::Vector(v) => format!("a vector of {} components", v.len()),
        Value::Flag(_) => "a flag".into(),
        Value::Text(t) => format!("the text \"{t}\""),
        Value::Unknown => "not known yet".into(),
    }
}

/// A number as a word of a uniform; numbers beyond an integer's range saturate.
pub fn word(number: f64, scalar: Scalar) -> [u8; 4] {
    match scalar {
        Scalar::F32 => (number as f32).to_le_bytes(),
        Scalar::I32 => (number as i32).to_le_bytes(),
        Scalar::U32 => (number as u32).to_le_bytes(),
    }
}

/// `None`: the value does not fit the kind; `Some(None)`: it is not known yet.
fn encode(value: &Value, kind: FieldKind) -> Option<Option<Vec<u8>>> {
    let FieldKind::Vector { components, scalar } = kind else { return None };
    let numbers = match value {
        Value::Number(n) => std::slice::from_ref(n),
        Value::Flag(f) if scalar != Scalar::F32 => &[f64::from(u8::from(*f))][..],
        Value::Vector(v) => v,
        Value::Unknown => return Some(None),
        Value::Flag(_) | Value::Text(_) => return None,
    };
    let whole = scalar == Scalar::F32 || numbers.iter().all(|n| n.fract() == 0.0);
    (numbers.len() == usize::from(components) && whole)
        .then(|| Some(numbers.iter().flat_map(|n| word(*n, scalar)).collect()))
}
