//! The plan: a pipeline with its parts put in, knobs set, conditions decided, loops unrolled. No names left to choose.
//!
//! Conditions and sizes are three-valued: without a scene, what depends on it is unknown; `each` over an unknown
//! number of elements is then unrolled once, so that its kernels are checked all the same.

use crate::document::{Blend, Cause, Compare, Knob, Sampler};
use crate::expr::Value;
use crate::problem::Place;
use std::collections::{BTreeMap, BTreeSet};

/// Index into [`Plan::resources`].
pub type ResourceId = usize;
/// Index into [`Plan::scopes`].
pub type ScopeId = usize;

#[derive(Clone, Debug)]
pub struct Plan {
    /// The pipeline's name.
    pub name: String,
    pub about: String,
    pub knobs: Vec<PlannedKnob>,
    pub values: Vec<PlannedValue>,
    pub resources: Vec<PlannedResource>,
    /// What names mean, at each point of the listing; bindings of kernels are looked up here.
    pub scopes: Vec<Scope>,
    /// In listed order.
    pub stages: Vec<PlannedStage>,
    /// Output name → what holds it, with the place that says so.
    pub outputs: Vec<(String, Reference, Place)>,
    /// Role → its WGSL module and the scope in which that module's bindings are looked up.
    pub modules: BTreeMap<String, Module>,
    /// What is wrong but does not stop the plan.
    pub warnings: Vec<crate::problem::Problem>,
}

#[derive(Clone, Debug)]
pub struct PlannedKnob {
    /// Dotted: `resolution` of the pipeline, `trace.aperture` of the part in the role `trace`.
    pub path: String,
    pub value: Value,
    /// Whether it was set by the user, apart from the default.
    pub set: bool,
    pub knob: Knob,
    pub place: Place,
}

#[derive(Clone, Debug)]
pub struct PlannedValue {
    pub path: String,
    pub value: Value,
    /// What its expression depends on, through other values too.
    pub causes: BTreeSet<Cause>,
    pub place: Place,
}

#[derive(Clone, Debug)]
pub struct PlannedResource {
    pub path: String,
    pub place: Place,
    pub kind: ResourceKind,
    pub start: Start,
    /// Some stage names its `@previous`: it then has two slots that change places each frame.
    pub history: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ResourceKind {
    /// Size in texels (components absent in the file are 1), layers 1 if `array` is false. `None`: not known without a scene.
    Texture {
        format: wgpu_types::TextureFormat,
        dimensions: u8,
        size: Option<[u32; 3]>,
        mips: Option<u32>,
        layers: Option<u32>,
        array: bool,
    },
    /// Elements of the runtime-sized array, or 1.
    Buffer { count: Option<u64> },
    /// What the scene gives: `vertices`, `triangles`, …; layout and size are the engine's.
    Scene,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    Fill(f64),
    Covered,
    Kept {
        value: f64,
        reset: BTreeSet<Cause>,
    },
    /// Made before the frame, by the engine.
    Given,
}

/// A resource or a part of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Reference {
    pub resource: ResourceId,
    pub mip: Option<u32>,
    pub layer: Option<u32>,
    /// The slot that the frame before wrote.
    pub previous: bool,
}

/// Names at one point of the listing.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    pub parent: Option<ScopeId>,
    pub names: BTreeMap<String, Named>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Named {
    Resource(Reference),
    /// Index into [`Plan::knobs`].
    Knob(usize),
    /// Index into [`Plan::values`].
    Value(usize),
    /// A loop's index.
    Index(Value),
    Sampler(Sampler),
}

#[derive(Clone, Debug)]
pub struct Module {
    pub kernel: String,
    pub scope: ScopeId,
    pub place: Place,
}

#[derive(Clone, Debug)]
pub struct PlannedStage {
    /// Unique: part calls, loop elements and the stage's name: `mipmap_emitted/mean[2]`.
    pub path: String,
    pub place: Place,
    /// Where bindings, knobs and values that `bind` does not say are looked up.
    pub scope: ScopeId,
    pub kernel: String,
    pub kernel_place: Place,
    /// Binding or target name → reference, with the place that says so.
    pub bind: BTreeMap<String, (Reference, Place)>,
    pub condition: Condition,
    /// The elements of the loops around it, outermost first.
    pub elements: Vec<Element>,
    pub work: Work,
    pub order_dependent: Option<String>,
}

/// A stage's `when`, and those of the parts and loops around it.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    Holds,
    /// With the expression that is false, as written: `scene.emissive is false`.
    Fails(String),
    /// With the expression that can't be decided without a scene.
    Unknown(String),
}

/// One element of an `each`.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    pub name: String,
    pub index: u32,
    pub of: ElementOf,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementOf {
    Range,
    Light,
    View,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    Compute(Threads),
    Raster { draw: Draw, depth: Option<DepthUse>, blend: Option<Blend> },
}

#[derive(Clone, Debug, PartialEq)]
pub enum Threads {
    /// One for each texel of this.
    Texels(Reference, Place),
    /// `None`: not known without a scene. Never zero components: a count of zero is a failed condition.
    Count(Option<[u64; 3]>),
    /// Three u32 from `offset` (in u32) of a buffer.
    Indirect(Reference, u64, Place),
}

#[derive(Clone, Debug, PartialEq)]
pub enum Draw {
    Scene,
    Screen,
    Points(Option<u64>),
    Vertices(Option<u64>),
    Indirect(Reference, u64, Place),
}

#[derive(Clone, Debug, PartialEq)]
pub struct DepthUse {
    pub target: Reference,
    pub place: Place,
    pub compare: Compare,
    pub write: bool,
}

impl Plan {
    /// What `name` means in `scope`.
    pub fn lookup(&self, scope: ScopeId, name: &str) -> Option<&Named> {
        let mut at = Some(scope);
        while let Some(scope) = at.and_then(|id| self.scopes.get(id)) {
            if let Some(named) = scope.names.get(name) {
                return Some(named);
            }
            at = scope.parent;
        }
        None
    }

    /// All names that can be seen from `scope`, for suggestions.
    pub fn visible(&self, scope: ScopeId) -> Vec<&str> {
        let mut names = Vec::new();
        let mut at = Some(scope);
        while let Some(scope) = at.and_then(|id| self.scopes.get(id)) {
            names.extend(scope.names.keys().map(String::as_str));
            at = scope.parent;
        }
        names
    }
}
