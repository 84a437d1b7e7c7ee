//! What the commands that run a pipeline on a scene have in common: their options, and the way to a realised frame.

use super::tuned::{Kept, told};
use super::{PipelineArgs, tell};
use crate::converge::{Step, Until};
use crate::device::{Gpu, LimitSet};
use crate::frame::{Changes, Clock, Frame, Poison, calibrate};
use crate::play::Play;
use crate::problem::{Problem, Result};
use crate::record::{self, Record, Samples};
use crate::scene::{Camera, Scene};
use crate::session::{Prepared, Request, prepare};
use crate::tuned::{self, Uses};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::time::Duration;

#[derive(Args)]
pub struct RunArgs {
    /// A glTF file (.gltf, .glb) or a setting (.ron).
    pub scene: PathBuf,
    /// A pipeline's name, or the path of its .ron file.
    #[arg(short, long)]
    pub pipeline: String,
    #[command(flatten)]
    pub pipeline_args: PipelineArgs,
    /// Use the adapter whose name contains this.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Use values that `voxgi tune` kept for the adapter and the pipeline, for knobs that are not set.
    #[arg(long)]
    tuned: bool,
    /// Ask the device for no more than WebGPU guarantees.
    #[arg(long)]
    webgpu_limits: bool,
    /// Time stages by the wall clock, each submitted alone.
    #[arg(long)]
    wall_clock: bool,
}

/// How good the outputs of a pipeline are to be that get better from frame to frame.
#[derive(Args, Clone)]
pub struct UntilArgs {
    /// Of a pipeline that gets better from frame to frame: stop after so many samples for each pixel.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    /// … after this time.
    #[arg(long, value_name = "SECONDS", value_parser = super::seconds)]
    seconds: Option<f64>,
    /// … when the noise of every output is below this relative squared error.
    #[arg(long, value_name = "RELMSE", value_parser = super::rate)]
    error: Option<f64>,
}

impl UntilArgs {
    pub fn given(&self) -> bool {
        self.samples.is_some() || self.seconds.is_some() || self.error.is_some()
    }

    /// What was asked for, or else `otherwise`.
    pub fn until(&self, otherwise: Until) -> Until {
        let time = self.seconds.map(Duration::from_secs_f64);
        if self.given() { Until { samples: self.samples, time, error: self.error } } else { otherwise }
    }
}

/// A bar on standard error that goes from 0 to 1, for `what`.
pub fn steps(what: &str) -> ProgressBar {
    let bar = ProgressBar::new(STEPS);
    if let Ok(style) = ProgressStyle::with_template("{prefix} {wide_bar} {msg}") {
        bar.set_style(style);
    }
    bar.set_prefix(what.to_owned());
    bar
}

const STEPS: u64 = 1000;

/// From now on a bar shows how far surfaces are unwrapped, while that goes on.
pub fn watch_unwrapping() {
    let bar = steps("unwrapping surfaces");
    crate::scene::atlas::watch(move |done| {
        bar.set_position((done * STEPS as f64) as u64);
        if done >= 1.0 {
            bar.finish_and_clear();
        }
    });
}

pub fn show(bar: &ProgressBar, step: &Step) {
    bar.set_position((step.done * STEPS as f64) as u64);
    let left = step.left.map_or_else(String::new, |left| format!(", {left:.0} s left"));
    bar.set_message(format!("{} samples{left}", step.samples));
}

/// Everything that is known before a device is opened.
pub struct Ready {
    pub scene: Scene,
    pub request: Request,
    pub prepared: Prepared,
    /// What tuning found of the request's knobs.
    pub tuned: Uses,
}

/// A frame that can be run.
pub struct Started {
    pub play: Play,
    /// What it was made for.
    pub request: Request,
    tuned: Uses,
    /// Where the scene's motion begins, in seconds, and how many frames a second of it has, if it is played.
    motion: (f64, Option<f64>),
    pub gpu: Gpu,
    pub frame: Frame,
    pub clock: Clock,
    pub changes: Changes,
    warnings: Vec<Problem>,
}

impl RunArgs {
    /// Loads, plans and schedules; `adjust` has the last word on the request. Warnings are told.
    pub fn prepare(&self, adjust: impl FnOnce(&mut Request)) -> Result<Ready> {
        let library = self.pipeline_args.library()?;
        let scene = self.pipeline_args.scene(&self.scene)?;
        let mut request = self.pipeline_args.request_for(&self.pipeline, &scene);
        adjust(&mut request);
        let mut prepared = prepare(&request, &library, Some(&scene))?;
        let mut tuned = Uses::new();
        if self.tuned {
            tuned = Kept::on(self.adapter.as_deref())?.uses(&prepared.graph.plan)?;
            eprint!("{}", told(&prepared.graph.plan, &tuned));
            request.sets.extend(tuned::sets(&tuned));
            prepared = prepare(&request, &library, Some(&scene))?;
        }
        prepared.warnings.iter().for_each(tell);
        Ok(Ready { scene, request, prepared, tuned })
    }

    /// Opens the device, chooses the clock and makes the frame.
    pub fn start(&self, ready: Ready, poison: Option<Poison>) -> Result<Started> {
        let Ready { scene, request, prepared, tuned } = ready;
        let limits = if self.webgpu_limits { LimitSet::Webgpu } else { LimitSet::Adapter };
        let gpu = Gpu::open(self.adapter.as_deref(), &limits)?;
        let clock = match self.wall_clock {
            true => Clock::Wall("asked for by --wall-clock".to_owned()),
            false => calibrate::choose(&gpu)?,
        };
        let changes = match request.keep {
            true => Changes::Only(request.varying.clone()),
            false => Changes::All,
        };
        let warnings = prepared.warnings.clone();
        let frame = prepared.realise(&gpu, &scene, clock.clone(), poison)?;
        let play = Play::new(scene, request.camera, request.size, &frame);
        let motion = (self.pipeline_args.time, self.pipeline_args.play);
        Ok(Started { play, request, tuned, motion, gpu, frame, clock, changes, warnings })
    }
}

impl Started {
    /// The scene as it is now.
    pub fn scene(&self) -> &Scene {
        &self.play.scene
    }

    /// Brings the scene, if it is played, to the frame of this number, and looks through `camera`, if there is one; says
    /// what is not as it was.
    pub fn go_to(&mut self, index: u32, camera: Option<&Camera>) -> Result<Changes> {
        let (start, rate) = self.motion;
        let mut bits = match rate {
            Some(rate) => self.play.go_to(&mut self.frame, &self.gpu, start + f64::from(index) / rate)?,
            None => BTreeSet::new(),
        };
        if let Some(camera) = camera {
            bits.extend(self.play.look(&mut self.frame, camera)?);
        }
        Ok(match &self.changes {
            Changes::All => Changes::All,
            // What is said to change does so without being looked at.
            Changes::Only(said) if rate.is_none() => Changes::Only(bits.union(said).copied().collect()),
            Changes::Only(_) => Changes::Only(bits),
        })
    }

    pub fn record(&self, args: &RunArgs, samples: &Samples) -> Result<Record> {
        let (plan, scene, frame) = (&self.frame.graph.plan, self.scene(), &self.frame);
        let (clock, clock_reason) = record::clock(&self.clock);
        let [width, height] = args.pipeline_args.size;
        Ok(Record {
            schema: record::SCHEMA,
            pipeline: args.pipeline.clone(),
            scene: scene.name.clone(),
            camera: scene.cameras.get(args.pipeline_args.camera).map(|c| c.name.clone()).unwrap_or_default(),
            width,
            height,
            knobs: plan.knobs.iter().map(|k| (k.path.clone(), record::value(&k.value))).collect(),
            tuned: self.tuned.clone(),
            parts: plan.parts.clone(),
            adapter: record::adapter(&self.gpu),
            clock,
            clock_reason,
            frames: samples.frames.len(),
            frame_ms: samples.median(|t| t.frame),
            frame: samples.frame_spread(),
            first_use_ms: samples.first.as_ref().and_then(|t| t.frame),
            encode_ms: samples.median(|t| Some(t.encode)),
            fills_ms: samples.median(|t| record::fills(frame, t)),
            stages: record::stages(frame, samples),
            effects: None,
            counters: frame.counters(&self.gpu)?.into_iter().collect(),
            memory: record::memory(frame),
            lacks: record::lacks(scene, &frame.graph),
            warnings: self.warnings.iter().map(Problem::to_json).collect(),
            outputs: BTreeMap::new(),
            scan: None,
        })
    }
}

/// A bar on standard error for so many frames.
pub fn progress(frames: u64) -> ProgressBar {
    let bar = ProgressBar::new(frames);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} frames, {eta} left") {
        bar.set_style(style);
    }
    bar
}

pub fn to_json(record: &impl serde::Serialize) -> Result<serde_json::Value> {
    serde_json::to_value(record)
        .map_err(|e| Problem::failure("record", format!("the record can't be written as JSON: {e}")).into())
}

/// Where it ran, on two lines without an end; `frames` says of what the times are.
pub fn heading(record: &Record, frames: &str) -> String {
    let Record { scene, pipeline, width, height, adapter, .. } = record;
    let why = record.clock_reason.as_ref().map_or_else(String::new, |why| format!(", since {why}"));
    format!(
        "{scene} by {pipeline}, {width}x{height}, on {} ({} {})\nclock: {}{why}; {frames}",
        adapter.name, adapter.driver, adapter.driver_info, record.clock
    )
}
