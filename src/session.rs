//! The whole way for one scene and one pipeline: from files to a schedule ([`prepare`], without a GPU), and from there to
//! a frame ([`Prepared::realise`]).

use crate::device::Gpu;
use crate::document;
use crate::expr::Value;
use crate::frame::{Clock, Frame, Poison, Setup};
use crate::graph::{self, Graph, Linking};
use crate::kernel::Variants;
use crate::library::Library;
use crate::plan;
use crate::play;
use crate::problem::{Problem, Problems, Result};
use crate::scene::{self, Bounds, Camera, Scene, features};
use crate::schedule::{self, Schedule, schedule};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What is to be run.
#[derive(Clone, Debug)]
pub struct Request {
    /// A pipeline's name, or the path of its `.ron` file.
    pub pipeline: String,
    /// `--set`: knob and value, as written.
    pub sets: Vec<(String, String)>,
    /// `--part`: role and part.
    pub parts: Vec<(String, String)>,
    pub size: [u32; 2],
    pub camera: usize,
    pub reuse: bool,
    pub drop: bool,
    pub keep: bool,
    /// What may change between frames, as bits of `depends`; only asked where `keep` is set.
    pub varying: BTreeSet<u32>,
    /// Bytes that the pipeline's resources may take.
    pub memory: Option<u64>,
    /// Features that conditions are told instead of the scene's own, to see what it would take to simulate them.
    pub claims: Vec<(&'static str, features::Feature)>,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            pipeline: String::new(),
            sets: Vec::new(),
            parts: Vec::new(),
            size: [256, 256],
            camera: 0,
            reuse: true,
            drop: true,
            keep: false,
            varying: graph::work::all_causes(),
            memory: None,
            claims: Vec::new(),
        }
    }
}

/// Everything that is known without a GPU.
#[derive(Debug)]
pub struct Prepared {
    pub graph: Arc<Graph>,
    pub schedule: Schedule,
    /// By stage: the bits on whose change it has to run again. Empty for what is dropped.
    pub depends: Vec<BTreeSet<u32>>,
    pub size: [u32; 2],
    pub camera: usize,
    pub warnings: Vec<Problem>,
}

/// Parses, plans, links and schedules. Without a scene, what depends on it stays open.
pub fn prepare(request: &Request, library: &Library, scene: Option<&Scene>) -> Result<Prepared> {
    let facts = facts(request, scene);
    let prepared = prepare_with(request, library, scene, facts.clone())?;
    match scene {
        // Only now is it known that they are asked for.
        Some(scene) if prepared.names_slow() => {
            let slow =
                features::slow(scene).into_iter().map(|(name, feature)| (name.to_owned(), value(feature)));
            prepare_with(request, library, Some(scene), facts.into_iter().chain(slow).collect())
        }
        _ => Ok(prepared),
    }
}

/// The same where all that expressions can ask, but for the picture's size, is known.
fn prepare_with(
    request: &Request,
    library: &Library,
    scene: Option<&Scene>,
    mut features: BTreeMap<String, Value>,
) -> Result<Prepared> {
    if request.size.contains(&0) {
        let [w, h] = request.size;
        return Err(Problem::input("size", format!("a picture of {w}x{h} has no pixels"))
            .help("`--size` takes a width and a height of at least 1: `--size 256x256`")
            .into());
    }
    if let Some(scene) = scene
        && request.camera >= scene.cameras.len()
    {
        let names: Vec<_> =
            scene.cameras.iter().enumerate().map(|(i, c)| format!("{i} ({})", c.name)).collect();
        return Err(Problem::input(
            "unknown-camera",
            format!("`{}` has no camera {}", scene.name, request.camera),
        )
        .help(format!("there are: {}", names.join(", ")))
        .into());
    }
    let source = library.pipeline(&request.pipeline)?;
    let document = document::parse(&source)?;
    let [width, height] = request.size.map(f64::from);
    features.insert("output.width".to_owned(), Value::Number(width));
    features.insert("output.height".to_owned(), Value::Number(height));
    let setup = plan::Setup {
        sets: request.sets.clone(),
        parts: request.parts.clone(),
        output: request.size,
        features: features.clone(),
        elements: scene.map(elements),
    };
    let plan = plan::expand(&document, library, &setup)?;
    let mut variants = Variants::default();
    let graph = graph::link(plan, Linking { library, features: &features, variants: &mut variants })?;
    let options = schedule::Options {
        reuse: request.reuse,
        drop: request.drop,
        keep: request.keep,
        varying: with_values(&graph.plan, &request.varying),
    };
    let work = graph::work::work(&graph);
    let scheduled = |options: &schedule::Options| {
        schedule(&work, options)
            .map_err(|error| Problem::failure("schedule", format!("the graph can't be scheduled: {error}")))
    };
    let varying = (0..graph.plan.values.len()).map(graph::facts::value_bit);
    let varying = graph::work::all_causes().into_iter().chain(varying).collect();
    let depends = reruns(&scheduled(&schedule::Options { keep: true, varying, ..options.clone() })?);
    let schedule = scheduled(&options)?;
    let mut problems = graph::work::unwritten(&graph, &schedule);
    problems.extend(over_budget(request, &graph, &schedule));
    let mut warnings = graph.warnings.clone();
    warnings.extend(Problems::check(problems)?);
    Ok(Prepared {
        graph: Arc::new(graph),
        schedule,
        depends,
        size: request.size,
        camera: request.camera,
        warnings,
    })
}

/// What may change, and with it the values that depend on it.
fn with_values(plan: &plan::Plan, varying: &BTreeSet<u32>) -> BTreeSet<u32> {
    let mut all = varying.clone();
    for (index, value) in plan.values.iter().enumerate() {
        if value.causes.iter().any(|cause| varying.contains(&graph::facts::bit(*cause))) {
            all.insert(graph::facts::value_bit(index));
        }
    }
    all
}

fn reruns(schedule: &Schedule) -> Vec<BTreeSet<u32>> {
    let steps = schedule.fates.iter().map(|fate| match fate {
        schedule::Fate::Run { step } => {
            schedule.steps.get(*step).map(|s| s.reruns().clone()).unwrap_or_default()
        }
        schedule::Fate::Dropped(_) => BTreeSet::new(),
    });
    steps.collect()
}

fn over_budget(request: &Request, graph: &Graph, schedule: &Schedule) -> Option<Problem> {
    let needs = schedule.memory.peak_bytes + schedule.memory.kept_bytes;
    let budget = request.memory.filter(|budget| needs > *budget)?;
    let largest = graph.resources.iter().enumerate().max_by_key(|(_, r)| r.bytes)?;
    let planned = &graph.plan.resources[largest.0];
    Some(
        Problem::input(
            "over-memory",
            format!("the pipeline needs {}, over the budget of {}", bytes(needs), bytes(budget)),
        )
        .at(&planned.place, format!("the largest resource: {}", bytes(largest.1.bytes.unwrap_or(0))))
        .help("raise `--memory`, or choose a smaller size: `--size`, or the knob it depends on"),
    )
}

/// A number of bytes for people.
pub fn bytes(n: u64) -> String {
    match n {
        0..1024 => format!("{n} B"),
        1024..1_048_576 => format!("{:.1} KiB", n as f64 / 1024.0),
        1_048_576..1_073_741_824 => format!("{:.1} MiB", n as f64 / 1_048_576.0),
        _ => format!("{:.2} GiB", n as f64 / 1_073_741_824.0),
    }
}

/// What `each` goes over.
fn elements(scene: &Scene) -> plan::Elements {
    plan::Elements {
        views: scene.views.len() as u32,
        lights: scene
            .lights
            .iter()
            .map(|light| match light.kind {
                scene::layout::SPOT => plan::LightKind::Spot,
                scene::layout::DIRECTIONAL => plan::LightKind::Directional,
                _ => plan::LightKind::Point,
            })
            .collect(),
    }
}

fn value(feature: features::Feature) -> Value {
    match feature {
        features::Feature::Number(n) => Value::Number(n),
        features::Feature::Flag(f) => Value::Flag(f),
        features::Feature::Vector(v) => Value::Vector(v.to_vec()),
    }
}

/// All names that expressions and conditions can ask, with their values; unknown ones where there is no scene, and
/// those that take long.
fn facts(request: &Request, scene: Option<&Scene>) -> BTreeMap<String, Value> {
    let mut facts: BTreeMap<String, Value> =
        features::NAMES.iter().chain(features::SLOW).map(|f| (f.name.to_owned(), Value::Unknown)).collect();
    let features = scene.map(features::features).unwrap_or_default();
    for (name, feature) in features.into_iter().chain(request.claims.iter().copied()) {
        facts.insert(name.to_owned(), value(feature));
    }
    let camera = scene.and_then(|s| s.cameras.get(request.camera));
    let seen = play::features(camera.unwrap_or(&Camera::framing(&Bounds::default())));
    facts.extend(seen.into_iter().map(|(name, value)| (name, camera.map_or(Value::Unknown, |_| value))));
    facts
}

impl Prepared {
    /// Name and text of every file that it comes from: pipeline, parts, kernels.
    pub fn documents(&self) -> BTreeMap<&str, &str> {
        let plan = &self.graph.plan;
        let places =
            plan.stages.iter().map(|stage| &stage.place).chain(plan.knobs.iter().map(|knob| &knob.place));
        let places = places
            .chain(plan.values.iter().map(|value| &value.place))
            .chain(plan.resources.iter().map(|resource| &resource.place));
        let linked = self.graph.stages.iter().filter_map(|stage| stage.linked.as_ref());
        let kernels = linked.flat_map(|linked| linked.reflected.composed.segments.iter().map(|s| &s.source));
        let sources = places.map(|place| &place.source).chain(kernels);
        sources.map(|source| (source.name(), source.text())).collect()
    }

    /// Whether some file has the name of a feature that takes long; in a kernel that may be a field of `scene`.
    fn names_slow(&self) -> bool {
        let documents = self.documents();
        let names = features::SLOW.iter().map(|feature| feature.name.trim_start_matches("scene."));
        { names }.any(|name| documents.values().any(|text| text.contains(name)))
    }

    /// Makes the GPU objects and tells them all facts of the scene.
    pub fn realise(self, gpu: &Gpu, scene: &Scene, clock: Clock, poison: Option<Poison>) -> Result<Frame> {
        let limits = gpu.device.limits();
        let whose = format!("the adapter `{}`", gpu.info.name);
        Problems::check(graph::check::limits(&self.graph, &limits, "the device"))?;
        let features = |format| gpu.format_features(format);
        Problems::check(graph::formats::check(&self.graph, &features, &whose))?;
        let aspect = f64::from(self.size[0]) / f64::from(self.size[1]);
        let setup = Setup { gpu, scene, poison, clock };
        let mut frame = Frame::realise(self.graph, self.schedule, &setup)?;
        let graph = frame.graph.clone();
        let table = frame.facts();
        if let Some(camera) = scene.cameras.get(self.camera) {
            table.put_camera(&camera.uniform(aspect));
        }
        table.put_views(&scene.views);
        for (index, value) in graph.plan.values.iter().enumerate() {
            if value.value == Value::Unknown {
                return Err(Problem::input(
                    "unknown-value",
                    format!("the value `{}` depends on what changes within a run", value.path),
                )
                .at(&value.place, "declared here")
                .help("read the uniform `frame` in the kernel instead")
                .into());
            }
            table.put_value(index, &value.value);
        }
        Ok(frame)
    }
}
