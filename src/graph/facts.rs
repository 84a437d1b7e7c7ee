//! Facts: the numbers that the engine tells kernels and expressions, and what can change them.
//!
//! Some are fixed for a plan (scene numbers, output size); the others live in one table of 32-bit words
//! ([`FactTable`]) from which uniforms are filled each frame: camera, frame number, views, named values.

use crate::document::{Cause, Geometry};
use crate::expr::Value;
use crate::kernel::Scalar;
use crate::plan::Plan;
use crate::scene::layout::{CameraUniform, FieldKind, View, layout};
use std::collections::{BTreeMap, BTreeSet};

/// The bit of [`crate::schedule::Task::depends`] for a cause.
pub fn bit(cause: Cause) -> u32 {
    match cause {
        Cause::Frame => crate::schedule::FRAME,
        Cause::Geometry => 1,
        Cause::Moving => 2,
        Cause::Lights => 3,
        Cause::Camera => 4,
        Cause::Knobs => 5,
    }
}

/// What a stage over this geometry depends on; nothing moves where it is known that nothing can.
pub fn geometry(geometry: Geometry, features: &BTreeMap<String, Value>) -> BTreeSet<u32> {
    let still = geometry == Geometry::Still || features.get("scene.moving") == Some(&Value::Flag(false));
    let causes = [Cause::Geometry, Cause::Moving];
    causes[..if still { 1 } else { 2 }].iter().map(|cause| bit(*cause)).collect()
}

/// What a stage over this geometry depends on if it binds the scene's buffer `name`.
pub fn of_scene(name: &str, over: Geometry, features: &BTreeMap<String, Value>) -> BTreeSet<u32> {
    match name {
        "lights" => BTreeSet::from([bit(Cause::Lights)]),
        "views" => BTreeSet::from([bit(Cause::Lights), bit(Cause::Geometry)]),
        "instances" => geometry(over, features),
        "bvh" => geometry(Geometry::All, features),
        "emitters" => geometry(Geometry::All, features).into_iter().chain([bit(Cause::Lights)]).collect(),
        _ => BTreeSet::from([bit(Cause::Geometry)]),
    }
}

/// All causes, by their bits.
pub const CAUSES: [Cause; 6] =
    [Cause::Frame, Cause::Geometry, Cause::Moving, Cause::Lights, Cause::Camera, Cause::Knobs];

/// The first bit of named values.
const FIRST_VALUE: u32 = 16;

/// The bit for the named value at this index of [`Plan::values`].
pub fn value_bit(index: usize) -> u32 {
    FIRST_VALUE.saturating_add(u32::try_from(index).unwrap_or(u32::MAX - FIRST_VALUE))
}

/// What a bit of `depends` is called.
pub fn name_of_bit(plan: &Plan, bit_: u32) -> String {
    match CAUSES.iter().find(|cause| bit(**cause) == bit_) {
        Some(cause) => format!("{cause:?}").to_lowercase(),
        None => bit_
            .checked_sub(FIRST_VALUE)
            .and_then(|index| plan.values.get(index as usize))
            .map_or_else(|| format!("bit {bit_}"), |value| format!("value {}", value.path)),
    }
}

/// The bits of causes.
pub fn bits(causes: &BTreeSet<Cause>) -> BTreeSet<u32> {
    causes.iter().map(|cause| bit(*cause)).collect()
}

/// Words of a fact within the table, and what they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Slot {
    pub start: u32,
    /// A matrix has all its columns.
    pub words: u32,
    pub scalar: Scalar,
}

/// Words of a named value: vectors have up to four components.
const VALUE_WORDS: u32 = 4;

fn words(uniform: &str) -> u32 {
    layout(uniform).map_or(0, |l| l.stride / 4)
}

/// The field of one of the scene's structs, in a table part that begins at `start`.
fn field(uniform: &str, start: u32, name: &str) -> Option<Slot> {
    let field = layout(uniform)?.fields.iter().find(|f| f.name == name)?;
    let scalar = if field.kind == FieldKind::U32 { Scalar::U32 } else { Scalar::F32 };
    Some(Slot { start: start + field.offset / 4, words: field.kind.size() / 4, scalar })
}

/// Where the field `name` of uniform `camera` lies in the table.
pub fn camera(name: &str) -> Option<Slot> {
    field("camera", 0, name)
}

/// Where the frame's number lies, the only field of uniform `frame`.
pub fn frame(name: &str) -> Option<Slot> {
    (name == "index").then(|| Slot { start: words("camera"), words: 1, scalar: Scalar::U32 })
}

/// Where named value `index` lies.
pub fn value(index: usize) -> Slot {
    let start = words("camera") + 1 + VALUE_WORDS * index as u32;
    Slot { start, words: VALUE_WORDS, scalar: Scalar::F32 }
}

/// Where the field `name` of uniform `view` lies, for view `index`; `values`: how many named values there are.
pub fn view(values: usize, index: u32, name: &str) -> Option<Slot> {
    field("views", value(values).start + index * words("views"), name)
}

/// Field names of an engine uniform, for suggestions.
pub fn field_names(uniform: &str) -> Vec<&'static str> {
    match uniform {
        "frame" => vec!["index"],
        "geometry" => vec!["first", "triangles"],
        "view" => field_names("views"),
        _ => layout(uniform).map_or(Vec::new(), |l| l.fields.iter().map(|f| f.name).collect()),
    }
}

/// The numbers themselves as 32-bit words, written in place each frame.
#[derive(Clone, Debug)]
pub struct FactTable {
    pub words: Vec<u32>,
    values: usize,
}

impl FactTable {
    pub fn new(values: usize, views: usize) -> Self {
        let length = value(values).start as usize + views * words("views") as usize;
        Self { words: vec![0; length], values }
    }

    fn put(&mut self, start: u32, words: &[u32]) {
        for (target, word) in self.words.iter_mut().skip(start as usize).zip(words) {
            *target = *word;
        }
    }

    pub fn put_camera(&mut self, camera: &CameraUniform) {
        self.put(0, bytemuck::cast_slice(std::slice::from_ref(camera)));
    }

    pub fn put_frame(&mut self, index: u32) {
        self.put(words("camera"), &[index]);
    }

    /// Named value `index`; texts and unknown ones have no word.
    pub fn put_value(&mut self, index: usize, to: &Value) {
        let mut number = |component: usize, number: f64| {
            self.put(value(index).start + component as u32, &[(number as f32).to_bits()]);
        };
        match to {
            Value::Number(n) => number(0, *n),
            Value::Flag(flag) => number(0, f64::from(u8::from(*flag))),
            Value::Vector(numbers) => numbers.iter().enumerate().for_each(|(i, n)| number(i, *n)),
            Value::Text(_) | Value::Unknown => {}
        }
    }

    pub fn put_views(&mut self, views: &[View]) {
        self.put(value(self.values).start, bytemuck::cast_slice(views));
    }
}
