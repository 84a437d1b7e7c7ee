//! The plan: a pipeline with its parts put in, knobs set, conditions decided, loops unrolled. No names left to choose.
//!
//! Conditions and sizes are three-valued: without a scene, what depends on it is unknown; `each` over an unknown
//! number of elements is then unrolled once, so that its kernels are checked all the same.

//!
//! What names mean, from the inside out: the `bind` of a part's call, the resources that the call has for its own, the
//! part's knobs, values and exports, the pipeline's (with what its parts export), what the scene gives. A part sees
//! no loop around its call unless the call binds the index. A swap changes what names mean from there on, wherever they
//! are bound: the resource that a part knows as `front` is also swapped for the pipeline that calls it `radiance`.
//!
//! Stages whose condition fails are planned like the others, so that they can be listed; numbers that are out of bounds
//! there are no errors.

mod find;
mod knobs;
mod later;
mod loops;
mod parts;
mod reference;
mod resources;
mod setup;
#[cfg(test)]
mod tests;
mod walk;
mod work;
mod world;

pub use parts::{SCENE_RESOURCES, with_module};
pub use setup::{Elements, LightKind, Setup};
pub use walk::MAX_STAGES;
pub use work::triangles;

use crate::document::{Blend, Cause, Compare, Document, ExprText, Geometry, Knob, Root, Sampler};
use crate::expr::Value;
use crate::library::Library;
use crate::problem::{Place, Problems, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use walk::{Around, Walk};
use world::World;

/// Index into [`Plan::resources`].
pub type ResourceId = usize;
/// Index into [`Plan::scopes`].
pub type ScopeId = usize;

#[derive(Clone, Debug)]
pub struct Plan {
    /// The pipeline's name.
    pub name: String,
    pub about: String,
    /// All features by name, as they were when planning.
    pub features: BTreeMap<String, Value>,
    pub knobs: Vec<PlannedKnob>,
    pub values: Vec<PlannedValue>,
    pub resources: Vec<PlannedResource>,
    /// What names mean, at each point of the listing; bindings of kernels are looked up here.
    pub scopes: Vec<Scope>,
    /// In listed order.
    pub stages: Vec<PlannedStage>,
    /// Output name → what holds it, with the place that says so.
    pub outputs: Vec<(String, Reference, Place)>,
    /// Role → the part that plays it.
    pub parts: BTreeMap<String, String>,
    /// Role, or another name that a part gives → the WGSL module and the scope in which its bindings are looked up.
    pub modules: BTreeMap<String, Module>,
    /// What the scene calls for and the pipeline or a part of it can't do; without a scene, what that could be.
    pub lacks: Vec<PlannedLack>,
    /// How outputs get better from frame to frame, if they do.
    pub progress: Option<PlannedProgress>,
    /// What is wrong but does not stop the plan.
    pub warnings: Vec<crate::problem::Problem>,
}

/// Something that is not simulated, though the scene calls for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlannedLack {
    /// What is done instead.
    pub what: String,
    /// Without a scene: when that is so.
    pub unknown: Option<String>,
}

/// Outputs are means over samples that frames add.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlannedProgress {
    /// Samples of a batch: outputs are whole after each.
    pub batch: u64,
    /// Frames that a batch takes.
    pub frames: u64,
    /// Path of the knob that says how many samples were drawn before.
    pub first: String,
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
    /// Its expression, and where the names in that are looked up (see [`Plan::values_with`]).
    pub text: ExprText,
    pub scope: ScopeId,
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
        steady: bool,
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
    /// The part that brings it: its role, its name and what it says of itself.
    pub role: String,
    pub part: String,
    pub about: String,
    pub scope: ScopeId,
    pub place: Place,
    /// Bindings that stand for other resources in stages over what moves.
    pub moving: BTreeMap<String, String>,
    /// Why what it writes depends on the order of threads.
    pub order_dependent: Option<String>,
}

#[derive(Clone, Debug)]
pub struct PlannedStage {
    /// Unique: part calls, loop elements and the stage's name: `mipmap_emitted/mean[2]`.
    pub path: String,
    pub place: Place,
    /// Where bindings, knobs and values that `bind` does not say are looked up.
    pub scope: ScopeId,
    /// Role → the scope of its module at this stage, where a swap has changed it (see [`Plan::module_scope`]).
    pub modules: BTreeMap<String, ScopeId>,
    pub kernel: String,
    pub kernel_place: Place,
    /// Binding or target name → reference, with the place that says so.
    pub bind: BTreeMap<String, (Reference, Place)>,
    pub condition: Condition,
    /// The elements of the loops around it, outermost first.
    pub elements: Vec<Element>,
    pub geometry: Geometry,
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

impl Condition {
    /// Both conditions; of two that fail, the outer one is the reason.
    fn and(&self, inner: Condition) -> Condition {
        match (self, inner) {
            (Condition::Fails(why), _) => Condition::Fails(why.clone()),
            (Condition::Holds, inner) => inner,
            (_, Condition::Fails(why)) => Condition::Fails(why),
            (Condition::Unknown(outer), Condition::Holds) => Condition::Unknown(outer.clone()),
            (Condition::Unknown(outer), Condition::Unknown(inner)) => {
                Condition::Unknown(format!("{outer} && {inner}"))
            }
        }
    }
}

impl Plan {
    /// What `name` means in `scope`.
    pub fn lookup(&self, scope: ScopeId, name: &str) -> Option<&Named> {
        lookup(&self.scopes, scope, name)
    }

    /// All names that can be seen from `scope`, for suggestions.
    pub fn visible(&self, scope: ScopeId) -> Vec<&str> {
        visible(&self.scopes, scope).into_keys().collect()
    }

    /// Where the bindings of the module behind `role/ROLE` are looked up for this stage.
    pub fn module_scope(&self, stage: &PlannedStage, role: &str) -> Option<ScopeId> {
        stage.modules.get(role).copied().or_else(|| self.modules.get(role).map(|module| module.scope))
    }
}

fn lookup<'s>(scopes: &'s [Scope], scope: ScopeId, name: &str) -> Option<&'s Named> {
    let mut at = Some(scope);
    while let Some(scope) = at.and_then(|id| scopes.get(id)) {
        if let Some(named) = scope.names.get(name) {
            return Some(named);
        }
        at = scope.parent;
    }
    None
}

/// All names that can be seen from `scope`, once each, with what they mean there.
fn visible(scopes: &[Scope], scope: ScopeId) -> BTreeMap<&str, &Named> {
    let mut names = BTreeMap::new();
    let mut at = Some(scope);
    while let Some(scope) = at.and_then(|id| scopes.get(id)) {
        for (name, named) in &scope.names {
            names.entry(name.as_str()).or_insert(named);
        }
        at = scope.parent;
    }
    names
}

/// Plans a pipeline for `setup`, with its parts from `library`. All that is wrong is reported at once, except that
/// parts that can't be read are reported alone.
pub fn expand(document: &Document, library: &Library, setup: &Setup) -> Result<Plan> {
    let players = parts::players(document, library, setup)?;
    let mut world = World::new(setup);
    let scene = world.scene_scope();
    let pipeline = world.file_scope(document, "", scene, |_| false);
    let mut scoped = Vec::new();
    for player in &players {
        let prefix = format!("{}.", player.role);
        let own = world.file_scope(&player.document, &prefix, pipeline, |name| !player.exports_named(name));
        world.export(player, own, pipeline);
        scoped.push((player, own));
    }
    world.set_knobs();
    let values = world.planned_values();
    let mut walk = Walk::new(&mut world, &scoped);
    let top = Around::top(pipeline);
    walk.stages(&document.stages, &top);
    walk.check_kept();
    let mut outputs = Vec::new();
    if let Root::Pipeline { outputs: named, .. } = &document.root {
        for (name, text) in named {
            if let Some(reference) = walk.reference(text, pipeline, &top) {
                outputs.push((name.value.clone(), reference, text.place.clone()));
            }
        }
    }
    let progress = walk.progress(document, pipeline);
    let lacks = scoped.iter().map(|(player, own)| (&player.document, *own));
    let lacks = std::iter::once((document, pipeline)).chain(lacks);
    let lacks = lacks.flat_map(|(document, scope)| walk.lacks(document, scope)).collect();
    let Walk { stages, history, .. } = walk;
    let resources = world.planned_resources(&history);
    let modules = parts::modules(&scoped, &mut world);
    let warnings = Problems::check(world.take_problems())?;
    let stem = Path::new(document.source.name()).file_stem().and_then(|stem| stem.to_str());
    Ok(Plan {
        name: stem.unwrap_or(document.source.name()).to_owned(),
        about: document.about.value.clone(),
        parts: players.iter().map(|p| (p.role.clone(), p.part.clone())).collect(),
        modules,
        features: world.features,
        knobs: world.knobs,
        values,
        resources,
        scopes: world.scopes,
        stages,
        outputs,
        lacks,
        progress,
        warnings,
    })
}
