//! Goes through the stages of a pipeline in listed order, into its parts and loops.

use super::parts::Player;
use super::world::{Live, World};
use super::{
    Condition, Element, Named, PlannedLack, PlannedProgress, PlannedStage, Reference, ResourceId, ScopeId,
    Work,
};
use crate::document::{self, Call, Cause, Document, ExprText, Spanned, Stage};
use crate::expr::Value;
use crate::problem::{Place, Problem};
use std::collections::{BTreeMap, BTreeSet};

/// How many stages a pipeline can have, and how many rounds all its loops together.
pub const MAX_STAGES: usize = 4096;
/// How many resources, so that calls of parts can't exhaust memory.
const MAX_RESOURCES: usize = 16_384;

/// What holds at one point of the listing.
#[derive(Clone)]
pub(super) struct Around {
    pub scope: ScopeId,
    /// The calls around it: `mipmap_emitted[0]/`.
    pub prefix: String,
    /// The rounds of the loops since the last call: `[2]`.
    pub suffix: String,
    pub condition: Condition,
    pub elements: Vec<Element>,
    /// Inside of a part.
    pub in_part: bool,
    /// A condition that can change from frame to frame.
    pub per_frame: Option<Place>,
}

impl Around {
    /// The pipeline's own list of stages.
    pub fn top(scope: ScopeId) -> Self {
        Self {
            scope,
            prefix: String::new(),
            suffix: String::new(),
            condition: Condition::Holds,
            elements: Vec::new(),
            in_part: false,
            per_frame: None,
        }
    }

    pub fn live(&self) -> Live {
        if matches!(self.condition, Condition::Fails(_)) { Live::No } else { Live::Yes }
    }
}

pub(super) struct Walk<'w, 'a> {
    pub world: &'w mut World<'a>,
    /// The parts, with the scopes of their own names.
    pub players: &'w [(&'a Player, ScopeId)],
    pub stages: Vec<PlannedStage>,
    /// Taken paths: where, and whether the file says the name itself.
    paths: BTreeMap<String, (Place, bool)>,
    /// What the names of resources mean now, where swaps have changed that.
    pub swapped: BTreeMap<ResourceId, ResourceId>,
    /// Where a resource changed names last.
    pub swap_places: BTreeMap<ResourceId, Place>,
    /// Scopes that say what names mean after swaps.
    overlays: BTreeMap<(ScopeId, BTreeMap<ResourceId, ResourceId>), ScopeId>,
    /// Resources whose slot of the frame before is read.
    pub history: BTreeSet<ResourceId>,
    pub rounds: usize,
    pub full: bool,
}

impl<'w, 'a> Walk<'w, 'a> {
    pub fn new(world: &'w mut World<'a>, players: &'w [(&'a Player, ScopeId)]) -> Self {
        Self {
            world,
            players,
            stages: Vec::new(),
            paths: BTreeMap::new(),
            swapped: BTreeMap::new(),
            swap_places: BTreeMap::new(),
            overlays: BTreeMap::new(),
            history: BTreeSet::new(),
            rounds: 0,
            full: false,
        }
    }

    pub fn stages(&mut self, stages: &'a [Spanned<Stage>], around: &Around) {
        for stage in stages {
            if self.full || self.exhausted(&stage.place) {
                return;
            }
            match &stage.value {
                Stage::Compute(compute) => {
                    self.kernel(&compute.call, &stage.place, around, |walk, scope, bind, around| {
                        walk.threads(compute, scope, bind, around)
                    });
                }
                Stage::Raster(raster) => {
                    self.kernel(&raster.call, &stage.place, around, |walk, scope, _, around| {
                        let draw = walk.draw(raster, scope, around);
                        let depth = raster.depth.as_ref().map(|depth| walk.depth(depth, scope, around));
                        let depth = depth.map_or(Some(None), |depth| depth.map(Some));
                        Some(Work::Raster { draw: draw?, depth: depth?, blend: raster.blend })
                    });
                }
                Stage::Part { role, name, when, bind } => {
                    self.part(
                        role,
                        name.as_ref().unwrap_or(role),
                        name.is_some(),
                        when.as_ref(),
                        bind,
                        around,
                    );
                }
                Stage::Each { name, over, when, stages } => {
                    self.each(name, over, when.as_ref(), stages, around);
                }
                Stage::Repeat { times, swap, when, stages } => {
                    self.repeat(times, swap, when.as_ref(), stages, around);
                }
            }
        }
    }

    /// Whether there are too many of something; says so the first time.
    pub fn exhausted(&mut self, place: &Place) -> bool {
        let (what, most) = if self.stages.len() >= MAX_STAGES {
            ("stages", MAX_STAGES)
        } else if self.rounds > MAX_STAGES {
            ("rounds of loops", MAX_STAGES)
        } else if self.world.resources.len() > MAX_RESOURCES {
            ("resources", MAX_RESOURCES)
        } else {
            return false;
        };
        self.full = true;
        let problem = Problem::input("too-many-stages", format!("this pipeline has more than {most} {what}"));
        self.world
            .report(problem.at(place, "too many from here on").help("loops in kernels have no such limit"));
        true
    }

    /// `around` with one more condition.
    pub fn inside(&self, when: Option<&ExprText>, around: &Around) -> Around {
        let mut inside = around.clone();
        let Some(when) = when else { return inside };
        let text = when.value.trim();
        let own = match self.world.value(when, around.scope, around.live()) {
            Value::Flag(true) => Condition::Holds,
            Value::Flag(false) => Condition::Fails(format!("{text} is false")),
            Value::Unknown => Condition::Unknown(text.to_owned()),
            other => {
                let problem =
                    Problem::input("bad-condition", format!("a condition is a flag, not {}", other.kind()));
                let help = "compare it with something: `… > 0`";
                self.world.report(problem.at(&when.place, format!("this is {other}")).help(help));
                Condition::Holds
            }
        };
        if self.world.causes(when, around.scope).contains(&Cause::Frame) {
            inside.per_frame = Some(when.place.clone());
        }
        inside.condition = around.condition.and(own);
        inside
    }

    /// What of a file's `lacks` holds.
    pub fn lacks(&self, document: &Document, scope: ScopeId) -> Vec<PlannedLack> {
        let lack = |lack: &document::Lack| {
            let inside = self.inside(Some(&lack.when), &Around::top(scope));
            let what = lack.what.value.clone();
            match inside.condition {
                Condition::Holds => Some(PlannedLack { what, unknown: None }),
                Condition::Fails(_) => None,
                Condition::Unknown(when) => Some(PlannedLack { what, unknown: Some(when) }),
            }
        };
        document.lacks.iter().filter_map(lack).collect()
    }

    /// How the pipeline's outputs get better; `None` also where that can't be known without a scene.
    pub fn progress(&self, document: &Document, scope: ScopeId) -> Option<PlannedProgress> {
        let document::Root::Pipeline { progress: Some(progress), .. } = &document.root else { return None };
        let batch = self.world.whole(&progress.batch, scope, 1, Live::Yes);
        let frames = self.world.whole(&progress.frames, scope, 1, Live::Yes);
        let first = &progress.first;
        if !self.world.knobs.iter().any(|knob| knob.path == first.value) {
            let problem = Problem::input("unknown-knob", format!("there is no knob `{}`", first.value))
                .at(&first.place, "named here")
                .suggest(&first.value, self.world.knobs.iter().map(|knob| knob.path.as_str()));
            self.world.report(problem);
        }
        Some(PlannedProgress { batch: batch?, frames: frames?, first: first.value.clone() })
    }

    /// A path that no stage has yet. Names that the file doesn't say get a number where needed.
    fn path(&mut self, name: &Place, text: &str, explicit: bool, around: &Around) -> String {
        let path = format!("{}{text}{}", around.prefix, around.suffix);
        let mut unique = path.clone();
        match self.paths.get(&path) {
            None => {}
            Some((first, true)) if explicit => {
                let problem = Problem::input("duplicate-name", format!("two stages are called `{path}`"))
                    .at(name, "again here")
                    .at(first, "first here");
                self.world.report(problem.help("rename one of the two"));
            }
            Some(_) => {
                let mut number = 2;
                while self.paths.contains_key(&unique) {
                    unique = format!("{path}#{number}");
                    number += 1;
                }
            }
        }
        self.paths.insert(unique.clone(), (name.clone(), explicit));
        unique
    }

    fn kernel(
        &mut self,
        call: &Call,
        place: &Place,
        around: &Around,
        work: impl FnOnce(&mut Self, ScopeId, &BTreeMap<String, (Reference, Place)>, &mut Around) -> Option<Work>,
    ) {
        let (name, explicit) = match &call.name {
            Some(name) => (name, true),
            None => (&call.kernel, false),
        };
        let last = name.value.rsplit('/').next().unwrap_or_default();
        let path = self.path(&name.place, last, explicit, around);
        let mut around = self.inside(call.when.as_ref(), around);
        let mut scope = around.scope;
        let mut bind = BTreeMap::new();
        for (key, text) in &call.bind {
            // Anything but a resource is renamed by a scope of the stage's own.
            if let Some(named) = self.other_than_resource(text, around.scope) {
                if scope == around.scope {
                    scope = self.world.add_scope(Some(around.scope));
                }
                self.world.declare(scope, &key.value, named, &key.place);
            } else if let Some(reference) = self.reference(text, around.scope, &around) {
                bind.insert(key.value.clone(), (reference, key.place.clone()));
            }
        }
        let Some(work) = work(self, around.scope, &bind, &mut around) else { return };
        let modules = self.modules_now();
        let scope = self.overlay(scope);
        self.stages.push(PlannedStage {
            path,
            place: place.clone(),
            scope,
            modules,
            kernel: call.kernel.value.clone(),
            kernel_place: call.kernel.place.clone(),
            bind,
            condition: around.condition,
            elements: around.elements,
            geometry: call.geometry,
            work,
            order_dependent: call.order_dependent.clone(),
        });
    }

    fn other_than_resource(&self, text: &Spanned<String>, scope: ScopeId) -> Option<Named> {
        self.world.lookup(scope, &text.value).filter(|named| !matches!(named, Named::Resource(_))).cloned()
    }

    /// What `text` refers to now.
    pub fn reference(
        &mut self,
        text: &Spanned<String>,
        scope: ScopeId,
        around: &Around,
    ) -> Option<Reference> {
        let reference = self.now(self.world.reference(text, scope, around.live())?);
        if reference.previous {
            self.history.insert(reference.resource);
        }
        Some(reference)
    }

    /// `reference` after the swaps so far.
    fn now(&self, reference: Reference) -> Reference {
        let resource = self.swapped.get(&reference.resource).copied().unwrap_or(reference.resource);
        Reference { resource, ..reference }
    }

    /// `scope` after the swaps so far.
    fn overlay(&mut self, scope: ScopeId) -> ScopeId {
        if self.swapped.is_empty() {
            return scope;
        }
        let names: BTreeMap<String, Named> = super::visible(&self.world.scopes, scope)
            .into_iter()
            .filter_map(|(name, named)| match named {
                Named::Resource(reference) if self.swapped.contains_key(&reference.resource) => {
                    Some((name.to_owned(), Named::Resource(self.now(*reference))))
                }
                _ => None,
            })
            .collect();
        if names.is_empty() {
            return scope;
        }
        *self.overlays.entry((scope, self.swapped.clone())).or_insert_with(|| {
            let overlay = self.world.add_scope(Some(scope));
            self.world.scopes[overlay].names = names;
            overlay
        })
    }

    /// `role/NAME` → the scope of its module, where swaps have changed it.
    fn modules_now(&mut self) -> BTreeMap<String, ScopeId> {
        let mut changed = BTreeMap::new();
        for (player, scope) in self.players {
            let now = self.overlay(*scope);
            if now != *scope {
                changed.extend(player.modules().map(|(name, _)| (name.to_owned(), now)));
            }
        }
        changed
    }

    /// The stages of the part in a role, with private resources of this call's own.
    fn part(
        &mut self,
        role: &Spanned<String>,
        name: &Spanned<String>,
        explicit: bool,
        when: Option<&ExprText>,
        bind: &document::Entries<String>,
        around: &Around,
    ) {
        if around.in_part {
            let problem =
                Problem::input("part-in-part", "a part can't call parts").at(&role.place, "called here");
            self.world.report(problem.help("call both from the pipeline, and tie them by exports or `bind`"));
            return;
        }
        let Some((player, own)) = self.players.iter().find(|(player, _)| player.role == role.value).copied()
        else {
            let known = self.players.iter().map(|(player, _)| player.role.as_str());
            let problem =
                Problem::input("unknown-role", format!("the pipeline has no role `{}`", role.value))
                    .at(&role.place, "called here")
                    .suggest(&role.value, known);
            self.world.report(problem);
            return;
        };
        let path = self.path(&name.place, &name.value, explicit, around);
        let inner = Around {
            scope: self.world.add_scope(Some(own)),
            prefix: format!("{path}/"),
            suffix: String::new(),
            in_part: true,
            ..self.inside(when, around)
        };
        for (key, text) in bind {
            let named = match self.other_than_resource(text, around.scope) {
                Some(named) => Some(named),
                None => self.world.reference(text, around.scope, inner.live()).map(Named::Resource),
            };
            if let Some(named) = named {
                self.world.declare(inner.scope, &key.value, named, &key.place);
            }
        }
        for (key, resource) in &player.document.resources {
            let bound = bind.iter().any(|(bound, _)| bound.value == key.value);
            if !bound && !player.exports_named(&key.value) {
                let path = format!("{path}.{}", key.value);
                let declared = Some(&resource.value);
                let id = self.world.add_resource(path, &key.place, declared, inner.scope, inner.live());
                self.world.declare(inner.scope, &key.value, Named::Resource(id.into()), &key.place);
            }
        }
        self.stages(&player.document.stages, &inner);
    }
}
