//! From a plan to a graph: composes, reflects and binds each stage's kernel.

use super::binding::{self, Binder};
use super::facts;
use super::missing::Missing;
use super::{
    Action, Draw, Graph, Linked, Raster, Resource, Stage, Threads, Touch, Usage, check, resource, target,
};
use crate::expr::{Names, Value};
use crate::kernel::{self, Choice, Composed, Entry, Reflected, Variants, compose};
use crate::library::Library;
use crate::plan::{self, Condition, Named, Plan, PlannedStage, ResourceId, ScopeId, Work};
use crate::problem::{Place, Problem, Problems, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What linking needs besides the plan.
pub struct Linking<'a> {
    pub library: &'a Library,
    /// Features of the scene and facts of the run, by dotted name; unknown ones are there too.
    pub features: &'a BTreeMap<String, Value>,
    pub variants: &'a mut Variants,
}

struct Linker<'a> {
    linking: Linking<'a>,
    plan: &'a Plan,
    resources: Vec<Resource>,
    first_use: BTreeMap<ResourceId, Place>,
    warnings: Vec<Problem>,
    missing: Missing,
}

/// Links every stage of `plan`. A stage that is off need not link; one that should run must.
pub fn link(plan: Plan, linking: Linking<'_>) -> Result<Graph> {
    let mut linker = Linker {
        linking,
        plan: &plan,
        resources: resource::planned(&plan),
        first_use: BTreeMap::new(),
        warnings: plan.warnings.clone(),
        missing: Missing::default(),
    };
    let mut problems: Vec<Problem> = Vec::new();
    let mut stages = Vec::with_capacity(plan.stages.len());
    // What runs decides how a buffer lies in memory; what is off must agree with that or stays unlinked.
    let (on, off): (Vec<usize>, Vec<usize>) =
        (0..plan.stages.len()).partition(|i| !matches!(plan.stages[*i].condition, Condition::Fails(_)));
    let mut linked: Vec<Option<Linked>> = (0..plan.stages.len()).map(|_| None).collect();
    for index in on {
        match linker.stage(&plan.stages[index]) {
            Ok(stage) => linked[index] = Some(stage),
            // Elements of a loop share a kernel and its problems.
            Err(found) => {
                for problem in found {
                    if !problems
                        .iter()
                        .any(|p| p.code == problem.code && p.labels.first() == problem.labels.first())
                    {
                        problems.push(problem);
                    }
                }
            }
        }
    }
    problems.extend(std::mem::take(&mut linker.missing).problems(&plan));
    if problems.is_empty() {
        for index in off {
            linked[index] = linker.stage(&plan.stages[index]).ok();
        }
    }
    let (mut resources, warnings) = (linker.resources, linker.warnings);
    for (planned, linked) in plan.stages.iter().zip(linked) {
        if let Some(linked) = &linked {
            resource::add_usages(&mut resources, &linked.touches);
        }
        stages.push(Stage {
            path: planned.path.clone(),
            place: planned.place.clone(),
            off: match &planned.condition {
                Condition::Fails(reason) => Some(reason.clone()),
                Condition::Holds | Condition::Unknown(_) => None,
            },
            undecided: matches!(planned.condition, Condition::Unknown(_)),
            order_dependent: planned.order_dependent.clone().or_else(|| by_module(&plan, linked.as_ref()?)),
            linked,
        });
    }
    let graph = Graph { plan, resources, stages, warnings };
    if problems.is_empty() {
        problems.extend(check::outputs(&graph));
    }
    if problems.is_empty() { Ok(graph) } else { Problems::check(problems).map(|_| graph) }
}

/// Names as conditions in kernels see them: what the stage sees, then the features.
struct ScopeNames<'a> {
    plan: &'a Plan,
    scope: ScopeId,
    features: &'a BTreeMap<String, Value>,
}

impl Names for ScopeNames<'_> {
    fn get(&self, name: &str) -> Option<Value> {
        match self.plan.lookup(self.scope, name) {
            Some(Named::Knob(index)) => self.plan.knobs.get(*index).map(|k| k.value.clone()),
            Some(Named::Index(value)) => Some(value.clone()),
            // A part's knob by its whole path.
            _ => match self.plan.knobs.iter().find(|k| k.path == name) {
                Some(knob) => Some(knob.value.clone()),
                None => self.features.get(name).cloned(),
            },
        }
    }

    fn known(&self) -> Vec<String> {
        let visible = self.plan.visible(self.scope).into_iter().filter(|n| self.get(n).is_some());
        visible.map(str::to_owned).chain(self.features.keys().cloned()).collect()
    }
}

impl Linker<'_> {
    fn stage(&mut self, planned: &PlannedStage) -> Result<Linked, Vec<Problem>> {
        let reflected = self.reflect(planned)?;
        let entries = choose(planned, &reflected).map_err(|p| vec![p])?;
        let vertex = entries.iter().any(|e| e.stage == kernel::Stage::Vertex);
        let mut depends = BTreeSet::new();
        let mut binder = Binder {
            plan: self.plan,
            stage: planned,
            features: self.linking.features,
            resources: &mut self.resources,
            first_use: &mut self.first_use,
            depends: &mut depends,
            touches: Vec::new(),
            formats: BTreeMap::new(),
            problems: Vec::new(),
            used: BTreeSet::new(),
        };
        let used = binding::used(&reflected, &entries);
        let mut bound: BTreeMap<String, super::Bound> = BTreeMap::new();
        for use_ in &used {
            if let Some(found) = binder.bind(use_, vertex) {
                bound.insert(use_.binding.name.clone(), found);
            }
        }
        let (mut touches, formats, mut problems, mut named) =
            (binder.touches, binder.formats, binder.problems, binder.used);
        let action = match &planned.work {
            Work::Compute(threads) => self.compute(planned, entries[0], threads, &mut touches, &mut problems),
            Work::Raster { draw, depth, blend } => {
                let targets =
                    target::resolve(self.plan, planned, &self.resources, &entries, &mut named, &mut problems);
                target::touch(&targets, depth.as_ref(), draw, blend.is_some(), &mut touches);
                let size = target::size(
                    self.plan,
                    planned,
                    &self.resources,
                    &targets,
                    depth.as_ref(),
                    &mut problems,
                );
                if matches!(draw, plan::Draw::Scene) {
                    depends.extend(facts::geometry(planned.geometry, self.linking.features));
                }
                let fragment = entries.iter().find(|e| e.stage == kernel::Stage::Fragment);
                Action::Raster(Box::new(Raster {
                    vertex: entries[0].name.clone(),
                    fragment: fragment.map(|e| e.name.clone()),
                    targets,
                    depth: depth.as_ref().map(|d| (d.target, d.compare, d.write)),
                    blend: *blend,
                    draw: self.draw(planned, draw, &mut touches),
                    size,
                }))
            }
        };
        self.warn_unused(planned, &reflected, &named);
        problems.extend(check::stage(self.plan, planned, &self.resources, &touches));
        if !problems.is_empty() {
            return Err(problems);
        }
        let names: Vec<&str> = entries.iter().map(|e| e.name.as_str()).collect();
        let choice = Choice { formats: formats.clone(), ..Choice::default() };
        let program = self.linking.variants.finish(&reflected, &names, &choice).map_err(|p| {
            p.iter().cloned().map(|p| p.at(&planned.place, "used by this stage")).collect::<Vec<_>>()
        })?;
        let bindings = program.bindings.iter().filter_map(|b| bound.remove(&b.binding.name)).collect();
        Ok(Linked { reflected, program, bindings, action, touches, depends, formats })
    }

    fn reflect(&mut self, planned: &PlannedStage) -> Result<Arc<Reflected>, Vec<Problem>> {
        let roles =
            self.plan.modules.iter().map(|(role, module)| (role.clone(), module.kernel.clone())).collect();
        let names = ScopeNames { plan: self.plan, scope: planned.scope, features: self.linking.features };
        let library = self.linking.library;
        let composed = compose(library, &planned.kernel, &planned.kernel_place, &roles, &names)
            .map_err(|found| found.iter().cloned().collect::<Vec<_>>())?;
        let overrides = self.overrides(planned, &composed);
        let reflected = self.linking.variants.reflect(&composed, &overrides);
        reflected.map_err(|found| self.missing.sort(&found, &composed, self.plan, library))
    }

    /// The knobs that the stage sees and the kernel declares as `override`.
    fn overrides(&self, planned: &PlannedStage, composed: &Composed) -> BTreeMap<String, f64> {
        let knob = |name: &str| match self.plan.lookup(planned.scope, name)? {
            Named::Knob(index) => match self.plan.knobs.get(*index)?.value {
                Value::Number(number) => Some((name.to_owned(), number)),
                Value::Flag(flag) => Some((name.to_owned(), f64::from(u8::from(flag)))),
                _ => None,
            },
            _ => None,
        };
        let declared = |name: &&str| composed.declarations.contains_key(*name);
        self.plan.visible(planned.scope).into_iter().filter(declared).filter_map(knob).collect()
    }

    fn compute(
        &self,
        planned: &PlannedStage,
        entry: &Entry,
        threads: &plan::Threads,
        touches: &mut Vec<Touch>,
        problems: &mut Vec<Problem>,
    ) -> Action {
        let threads = match threads {
            plan::Threads::Count(count) => Threads::Count(*count),
            plan::Threads::Texels(reference, place) => {
                let resource = &self.resources[reference.resource];
                match &resource.shape {
                    super::Shape::Texture(texture) => {
                        let size = texture.mip_size(reference.mip.unwrap_or(0));
                        let layers = if reference.layer.is_none() { resource.layers } else { 1 };
                        Threads::Count(size.map(|[w, h, d]| [w, h, d.max(layers)].map(u64::from)))
                    }
                    _ => {
                        problems.push(
                            Problem::input(
                                "extent",
                                format!("stage `{}`: only a texture has texels", planned.path),
                            )
                            .at(place, "this is a buffer")
                            .help("for a buffer say `over: Count(\"…\")`"),
                        );
                        Threads::Count(None)
                    }
                }
            }
            plan::Threads::Indirect(reference, offset, _) => {
                touches.push(indirect(reference));
                Threads::Indirect { resource: reference.resource, offset: 4 * offset }
            }
        };
        Action::Compute { entry: entry.name.clone(), workgroup: entry.workgroup_size, threads }
    }

    fn draw(&self, planned: &PlannedStage, draw: &plan::Draw, touches: &mut Vec<Touch>) -> Draw {
        match draw {
            plan::Draw::Scene => {
                let triangles = plan::triangles(self.linking.features, planned.geometry);
                Draw::Vertices(triangles.map(|(first, count)| (3 * first, 3 * count)))
            }
            plan::Draw::Screen => Draw::Vertices(Some((0, 3))),
            plan::Draw::Vertices(count) => Draw::Vertices(count.map(|count| (0, count))),
            plan::Draw::Points(count) => Draw::Points(*count),
            plan::Draw::Indirect(reference, offset, _) => {
                touches.push(indirect(reference));
                Draw::Indirect { resource: reference.resource, offset: 4 * offset }
            }
        }
    }

    fn warn_unused(&mut self, planned: &PlannedStage, reflected: &Reflected, used: &BTreeSet<String>) {
        for (name, (_, place)) in planned.bind.iter().filter(|(name, _)| !used.contains(*name)) {
            let warning = Problem::warning(
                "unused-binding",
                format!("the kernel `{}` has no binding or target `{name}`", planned.kernel),
            )
            .at(place, "bound here, for nothing")
            .suggest(name, reflected.bindings.iter().map(|b| b.name.as_str()));
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
    }
}

/// Why a module that the stage imports makes it depend on the order of threads.
fn by_module(plan: &Plan, linked: &Linked) -> Option<String> {
    let roles = linked.reflected.bindings.iter().filter_map(|binding| binding.role.as_deref());
    roles.filter_map(|role| plan.modules.get(role)).find_map(|module| module.order_dependent.clone())
}

fn indirect(reference: &plan::Reference) -> Touch {
    Touch {
        reference: *reference,
        read: true,
        write: false,
        how: Usage::Indirect,
        binding: "arguments".into(),
    }
}

/// The entry points that a stage uses: one for compute; a vertex and perhaps a fragment one for raster.
fn choose<'a>(planned: &PlannedStage, reflected: &'a Reflected) -> Result<Vec<&'a Entry>, Problem> {
    let of = |stage: kernel::Stage| reflected.entries.iter().filter(move |e| e.stage == stage);
    let wrong = |message: String| {
        Err(Problem::input("entry-points", format!("kernel `{}` {message}", planned.kernel))
            .at(&planned.kernel_place, "named here"))
    };
    match planned.work {
        Work::Compute(_) => match of(kernel::Stage::Compute).collect::<Vec<_>>()[..] {
            [one] => Ok(vec![one]),
            [] => wrong("has no @compute entry point, which a Compute stage needs".into()),
            _ => wrong("has more than one @compute entry point; one kernel, one file".into()),
        },
        Work::Raster { .. } => {
            let (vertex, fragment): (Vec<_>, Vec<_>) =
                (of(kernel::Stage::Vertex).collect(), of(kernel::Stage::Fragment).collect());
            match (&vertex[..], &fragment[..]) {
                ([vertex], []) => Ok(vec![*vertex]),
                ([vertex], [fragment]) => Ok(vec![*vertex, *fragment]),
                ([], _) => wrong("has no @vertex entry point, which a Raster stage needs".into()),
                _ => wrong("has several @vertex or @fragment entry points; one kernel, one file".into()),
            }
        }
    }
}
