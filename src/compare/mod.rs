//! Comparing: several pipelines on several scenes, each held against the scene's reference.
//!
//! [`Comparing`] makes a folder: `comparison.json` ([`Comparison`]) and for each scene a folder with the pictures of its
//! references and runs. The file is written anew after each run, so that a folder whose making was stopped is valid,
//! and goes on where it stopped when it is made again.
//!
//! A run meets the reference that simulates the same light: every knob of the reference that the run's pipeline has too, by
//! its last name, takes the run's value (`diffuse_only`, `ao_distance`), unless it is set for the reference.

mod diff;
mod files;
mod merge;
mod subject;
mod sweep;
pub(crate) mod truth;

pub use diff::{Difference, diff};
pub use merge::merge;
pub use subject::Subject;
pub use sweep::{Axis, Order, expand, shard};

use crate::comparison::{Comparison, FILE, Run, SCHEMA, SceneEntry, Timing};
use crate::converge::Until;
use crate::device::{Gpu, LimitSet};
use crate::library::Library;
use crate::measure;
use crate::picture;
use crate::problem::{Problem, Result};
use crate::record;
use crate::reference::{self, Cache};
use crate::scene::{self, Scene};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use truth::Truth;

/// What is compared, and how.
#[derive(Clone, Debug)]
pub struct Plan {
    /// `compare` or `sweep`.
    pub command: &'static str,
    pub folder: PathBuf,
    pub scenes: Vec<PathBuf>,
    /// In the order in which they are run, on each scene.
    pub subjects: Vec<Subject>,
    pub size: [u32; 2],
    pub camera: usize,
    /// Of the scenes' motion, in seconds.
    pub time: f64,
    /// Frames that are timed, after a first one.
    pub frames: u32,
    /// How often each is run, on a device of its own each time.
    pub repeats: u32,
    /// Shuffles the order of running; as listed without.
    pub shuffle: Option<u64>,
    /// The pipeline that makes references.
    pub reference: String,
    /// Knobs of it.
    pub reference_sets: Vec<(String, String)>,
    pub until: Until,
    pub measure: measure::Options,
    pub adapter: Option<String>,
    pub limits: LimitSet,
    pub wall_clock: bool,
}

/// What a comparison is doing.
#[derive(Clone, Debug, PartialEq)]
pub enum Doing {
    Reference {
        scene: String,
        step: crate::converge::Step,
    },
    /// The run of this number, from 0, of so many.
    Run {
        scene: String,
        name: String,
        number: usize,
        of: usize,
    },
}

pub struct Comparing<'a> {
    plan: &'a Plan,
    library: &'a Library,
    cache: &'a Cache,
    comparison: Comparison,
}

impl<'a> Comparing<'a> {
    /// Goes on in the plan's folder, if there is a comparison of the same kind in it, or begins one.
    pub fn begin(plan: &'a Plan, library: &'a Library, cache: &'a Cache) -> Result<Self> {
        let gpu = Gpu::open(plan.adapter.as_deref(), &plan.limits)?;
        let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        let name = plan.folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let fresh = Comparison {
            schema: SCHEMA,
            command: plan.command.to_owned(),
            name,
            date: now,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            adapter: record::adapter(&gpu),
            size: plan.size,
            exposure: plan.measure.exposure,
            curve: plan.measure.curve.name().to_owned(),
            scenes: Vec::new(),
            runs: Vec::new(),
        };
        let comparison = match Comparison::read(&plan.folder) {
            Ok(Some(before)) if before.like(&fresh) => before,
            Ok(None) => fresh,
            Ok(Some(_)) => {
                let message = format!("`{}` holds a comparison of another kind", plan.folder.display());
                let help = "size, exposure, curve, adapter and version must be the same; choose another folder with `--out`";
                return Err(Problem::input("other-comparison", message).help(help).into());
            }
            Err(problems) => return Err(problems),
        };
        Ok(Self { plan, library, cache, comparison })
    }

    /// Makes all that is not there yet. Nothing is written before all that is asked for is known to be right.
    pub fn run(mut self, watch: &mut dyn FnMut(&Doing)) -> Result<Comparison> {
        let plan = self.plan;
        let mut scenes = Vec::new();
        for path in &plan.scenes {
            let mut scene = scene::load(path)?;
            scene.pose(plan.time);
            for subject in &plan.subjects {
                truth::light(plan, self.library, &subject.prepare(plan, self.library, &scene)?)?;
            }
            self.enter(path, &scene)?;
            scenes.push(scene);
        }
        for scene in &scenes {
            self.scene(scene, watch)?;
        }
        Ok(self.comparison)
    }

    /// Notes a scene, or finds it noted as what it is.
    fn enter(&mut self, path: &Path, scene: &Scene) -> Result<()> {
        let plan = self.plan;
        let content = reference::content(scene, plan.camera, plan.size)?;
        match self.comparison.scenes.iter().find(|entry| entry.name == scene.name) {
            Some(entry) if entry.content == content => Ok(()),
            Some(entry) => {
                let message =
                    format!("`{}` is another scene than `{}` of the same name", path.display(), entry.file);
                let help =
                    "rename one of the two; if the file was changed, choose another folder with `--out`";
                Err(Problem::input("other-scene", message).help(help).into())
            }
            None => {
                let camera = scene.cameras.get(plan.camera).map(|c| c.name.clone()).unwrap_or_default();
                self.comparison.scenes.push(SceneEntry {
                    name: scene.name.clone(),
                    file: path.display().to_string(),
                    camera,
                    content,
                    triangles: scene.triangles.len(),
                    lacks: scene.lacks.iter().map(ToString::to_string).collect(),
                    references: BTreeMap::new(),
                });
                Ok(())
            }
        }
    }

    fn scene(&mut self, scene: &Scene, watch: &mut dyn FnMut(&Doing)) -> Result<()> {
        let plan = self.plan;
        let mut truths: BTreeMap<String, Truth> = BTreeMap::new();
        let mut order: Vec<(u32, &Subject)> =
            (0..plan.repeats).flat_map(|repeat| plan.subjects.iter().map(move |s| (repeat, s))).collect();
        if let Some(seed) = plan.shuffle {
            fastrand::Rng::with_seed(seed).shuffle(&mut order);
        }
        let all = order.len();
        // How often each has been met in this order.
        let mut met: BTreeMap<String, usize> = BTreeMap::new();
        for (number, (_, subject)) in order.into_iter().enumerate() {
            let name = subject.name();
            let turn = met.entry(name.clone()).or_default();
            *turn += 1;
            let prepared = subject.prepare(plan, self.library, scene)?;
            let light = truth::light(plan, self.library, &prepared)?;
            let documents = files::copies(&prepared.documents());
            let same = |run: &Run| run.scene == scene.name && run.name == name;
            // What was run from other files, or held against another reference, is not this.
            self.comparison
                .runs
                .retain(|run| !same(run) || (run.documents == documents && run.reference == light.name));
            let before = self.comparison.runs.iter().position(same);
            if before.is_some_and(|index| self.comparison.runs[index].repeats_ms.len() >= *turn) {
                continue;
            }
            if !truths.contains_key(&light.name) {
                let mut step = |step| {
                    watch(&Doing::Reference { scene: scene.name.clone(), step });
                    Ok(())
                };
                let (truth, entry) = truth::make(plan, self.library, self.cache, scene, &light, &mut step)?;
                if let Some(into) = self.comparison.scenes.iter_mut().find(|entry| entry.name == scene.name) {
                    into.references.insert(light.name.clone(), entry);
                }
                truths.insert(light.name.clone(), truth);
            }
            watch(&Doing::Run { scene: scene.name.clone(), name: name.clone(), number, of: all });
            let done = subject.run(plan, scene, prepared)?;
            let run = truths[&light.name].hold_against(plan, scene, subject, &light.name, done)?;
            match before {
                Some(index) => self.comparison.runs[index].add_repeat(run),
                None => self.comparison.runs.push(run),
            }
            self.comparison.write(&plan.folder)?;
        }
        self.comparison.write(&plan.folder)
    }
}

impl Run {
    /// Adds the times of another run of the same; pictures and errors are those of the first.
    fn add_repeat(&mut self, other: Run) {
        self.repeats_ms.extend(other.repeats_ms);
        self.gpu_ms = Timing::of([std::mem::take(&mut self.gpu_ms.samples), other.gpu_ms.samples].concat());
        for (stage, other) in self.stages.iter_mut().zip(other.stages) {
            stage.samples_ms.extend(other.samples_ms);
            let known: Vec<f64> = stage.samples_ms.iter().flatten().copied().collect();
            (stage.gpu_ms, stage.spread) = (record::quantile(&known, 0.5), record::spread(&known));
        }
    }
}

impl Timing {
    pub fn of(samples: Vec<Option<f64>>) -> Self {
        let known: Vec<f64> = samples.iter().flatten().copied().collect();
        let spread = record::spread(&known);
        Self { median: record::quantile(&known, 0.5), p10: spread.p10, p90: spread.p90, samples }
    }
}

impl Comparison {
    /// The one in a folder; `None` if there is none.
    pub fn read(folder: &Path) -> Result<Option<Self>> {
        let path = folder.join(FILE);
        let text = match std::fs::read(&path) {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(e) => {
                let message = format!("can't read `{}`: {e}", path.display());
                return Err(Problem::input("comparison-file", message).into());
            }
        };
        let comparison: Self = serde_json::from_slice(&text).map_err(|e| {
            Problem::input("comparison-file", format!("`{}` is no comparison: {e}", path.display()))
                .help("`voxgi compare` and `voxgi sweep` write such files")
        })?;
        if comparison.schema != SCHEMA {
            let message = format!("`{}` has schema {}, not {SCHEMA}", path.display(), comparison.schema);
            return Err(Problem::input("comparison-schema", message).help("make it again").into());
        }
        Ok(Some(comparison))
    }

    /// Writes the file into the folder, whole.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let json = serde_json::to_vec_pretty(self).map_err(|e| {
            Problem::failure("record", format!("the comparison can't be written as JSON: {e}"))
        })?;
        picture::write_bytes(&folder.join(FILE), &json)
    }

    /// Whether runs of both can stand side by side.
    pub fn like(&self, other: &Self) -> bool {
        let kind = |c: &Self| (c.schema, c.command.clone(), c.version.clone(), c.size, c.curve.clone());
        kind(self) == kind(other) && self.adapter == other.adapter && self.exposure == other.exposure
    }
}
