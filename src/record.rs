//! The record: what a run did, for programs (JSON, with a schema version) and for people.
//!
//! A time that is not known is `null`, never 0. Times are milliseconds.

use crate::device::Gpu;
use crate::frame::{Clock, Frame, Times};
use crate::graph::{Graph, facts};
use crate::scene::Scene;
use crate::schedule::{Fate, Step};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Changes whenever a field changes its name, its place or its meaning.
pub const SCHEMA: u32 = 1;

#[derive(Clone, Debug, Serialize)]
pub struct Record {
    pub schema: u32,
    pub pipeline: String,
    pub scene: String,
    pub camera: String,
    pub width: u32,
    pub height: u32,
    pub knobs: BTreeMap<String, serde_json::Value>,
    /// Of those, the ones whose values tuning found.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub tuned: crate::tuned::Uses,
    pub parts: BTreeMap<String, String>,
    pub adapter: Adapter,
    pub clock: &'static str,
    /// Why the clock is not the GPU's timestamps.
    pub clock_reason: Option<String>,
    /// Frames that were sampled: after the first one, or that one alone if no number was asked for.
    pub frames: usize,
    /// Median over the sampled frames.
    pub frame_ms: Option<f64>,
    pub frame: Spread,
    /// The very first frame: drivers compile kernels at their first use.
    pub first_use_ms: Option<f64>,
    /// CPU time to encode and submit a frame, median.
    pub encode_ms: Option<f64>,
    /// Fills before stages, median of their sum; `null` if the adapter can't time them.
    pub fills_ms: Option<f64>,
    pub stages: Vec<StageRecord>,
    /// What not simulating an effect that the scene has nothing of saves, if that was measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effects: Option<Vec<EffectRecord>>,
    pub counters: BTreeMap<String, u32>,
    pub memory: MemoryRecord,
    /// What the scene calls for and is not done.
    pub lacks: Vec<String>,
    pub warnings: Vec<serde_json::Value>,
    pub outputs: BTreeMap<String, String>,
    /// What `--scan` found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scan: Option<Vec<crate::frame::Finding>>,
}

#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Adapter {
    pub name: String,
    pub driver: String,
    pub driver_info: String,
    pub backend: String,
    pub kind: String,
}

impl Adapter {
    pub fn new(info: &wgpu::AdapterInfo) -> Self {
        Self {
            name: info.name.clone(),
            driver: info.driver.clone(),
            driver_info: info.driver_info.clone(),
            backend: info.backend.to_string(),
            kind: format!("{:?}", info.device_type),
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct StageRecord {
    pub path: String,
    /// `run`, `kept` or `dropped`.
    pub status: &'static str,
    pub reason: Option<String>,
    /// Median over the sampled frames in which it ran.
    pub gpu_ms: Option<f64>,
    pub spread: Spread,
    pub first_use_ms: Option<f64>,
    pub samples_ms: Vec<Option<f64>>,
    /// What it takes where it is not kept or dropped, if that was measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub saved_ms: Option<f64>,
    /// Why its result depends on thread order, if it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order_dependent: Option<String>,
    #[serde(flatten)]
    pub profile: Option<StageProfile>,
}

/// An effect that the scene has nothing of, simulated all the same: kernels with it compiled in, and the stages that
/// it needs.
#[derive(Clone, Debug, Serialize)]
pub struct EffectRecord {
    /// The flag that says whether a scene has it.
    pub feature: &'static str,
    /// What the stages below take longer with it, in sum: median over frames with and without, run in turns.
    pub saved_ms: Option<f64>,
    pub spread: Spread,
    /// Stages that run only with it, or another program with it, and what each then takes longer.
    pub stages: BTreeMap<String, Option<f64>>,
}

/// What only a profile says of a stage that is in the schedule.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StageProfile {
    /// Of the frame's median.
    pub share: Option<f64>,
    /// What the stage binds, once: see [`crate::profile::traffic`].
    pub read_bytes: Option<u64>,
    pub written_bytes: Option<u64>,
    /// Both together in the median time, in 10⁹ bytes a second, and as a part of the device's copy speed.
    pub gb_per_s: Option<f64>,
    pub of_copy: Option<f64>,
}

/// Tenth and ninetieth percentile.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Spread {
    pub p10: Option<f64>,
    pub p90: Option<f64>,
}

#[derive(Clone, Copy, Debug, Serialize)]
pub struct MemoryRecord {
    pub peak_bytes: u64,
    pub without_reuse_bytes: u64,
    pub kept_bytes: u64,
    /// The largest set alive at once: no sharing takes less.
    pub lower_bound_bytes: u64,
}

/// Quantile `q` of what is known, between the nearest two.
pub fn quantile(samples: &[f64], q: f64) -> Option<f64> {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = q * sorted.len().checked_sub(1)? as f64;
    let (low, high) = (at.floor() as usize, at.ceil() as usize);
    Some(sorted[low] + (sorted[high] - sorted[low]) * (at - low as f64))
}

pub fn spread(samples: &[f64]) -> Spread {
    Spread { p10: quantile(samples, 0.1), p90: quantile(samples, 0.9) }
}

/// All times of a run: the first frame, then the sampled ones.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    pub first: Option<Times>,
    pub frames: Vec<Times>,
}

impl Samples {
    /// Median of the known values of `of`.
    pub fn median(&self, of: impl Fn(&Times) -> Option<f64>) -> Option<f64> {
        quantile(&self.known(of), 0.5)
    }

    fn known(&self, of: impl Fn(&Times) -> Option<f64>) -> Vec<f64> {
        self.frames.iter().filter_map(of).collect()
    }

    pub fn frame_spread(&self) -> Spread {
        spread(&self.known(|t| t.frame))
    }
}

/// What became of each stage, in the order of the listing. `last`: which steps the last frame did.
pub fn stages(frame: &Frame, samples: &Samples) -> Vec<StageRecord> {
    let last = frame.done();
    let record = |(index, stage): (usize, &crate::graph::Stage)| {
        let mut record = StageRecord {
            path: stage.path.clone(),
            status: "dropped",
            reason: None,
            gpu_ms: None,
            spread: Spread::default(),
            first_use_ms: None,
            samples_ms: Vec::new(),
            saved_ms: None,
            order_dependent: stage.order_dependent.clone(),
            profile: None,
        };
        match &frame.schedule.fates[index] {
            Fate::Dropped(reason) => record.reason = Some(reason.clone()),
            Fate::Run { step } => {
                let time = |times: &Times| times.steps.get(*step).copied().flatten();
                let known = samples.known(time);
                record.gpu_ms = quantile(&known, 0.5);
                record.spread = spread(&known);
                record.first_use_ms = samples.first.as_ref().and_then(time);
                record.samples_ms = samples.frames.iter().map(time).collect();
                if last.get(*step).copied().unwrap_or(false) {
                    record.status = "run";
                } else {
                    record.status = "kept";
                    record.reason = Some(kept_reason(frame, *step));
                }
            }
        }
        record
    };
    frame.graph.stages.iter().enumerate().map(record).collect()
}

/// What the scene calls for and is not done: by the loader, and by the pipeline.
pub fn lacks(scene: &Scene, graph: &Graph) -> Vec<String> {
    let pipeline = graph.plan.lacks.iter().filter(|lack| lack.unknown.is_none());
    scene.lacks.iter().map(ToString::to_string).chain(pipeline.map(|lack| lack.what.clone())).collect()
}

fn kept_reason(frame: &Frame, step: usize) -> String {
    let bits = frame.schedule.steps[step].reruns();
    if bits.is_empty() {
        return "nothing it depends on can change".to_owned();
    }
    let names: Vec<String> = bits.iter().map(|bit| facts::name_of_bit(&frame.graph.plan, *bit)).collect();
    format!("it depends on {}, and that did not change", names.join(", "))
}

/// Sum of the fills of a frame, if any is known.
pub fn fills(frame: &Frame, times: &Times) -> Option<f64> {
    let fills = frame.schedule.steps.iter().zip(&times.steps).filter_map(|(step, time)| match step {
        Step::Start { .. } => *time,
        Step::Run { .. } => None,
    });
    fills.fold(None, |sum: Option<f64>, time| Some(sum.unwrap_or(0.0) + time))
}

pub fn memory(frame: &Frame) -> MemoryRecord {
    let memory = &frame.schedule.memory;
    MemoryRecord {
        peak_bytes: memory.peak_bytes,
        without_reuse_bytes: memory.without_reuse_bytes,
        kept_bytes: memory.kept_bytes,
        lower_bound_bytes: memory.lower_bound_bytes,
    }
}

/// Name of the clock and, if it is not the preferred one, why.
pub fn clock(clock: &Clock) -> (&'static str, Option<String>) {
    match clock {
        Clock::Timestamps => (clock.name(), None),
        Clock::Wall(why) => (clock.name(), Some(why.clone())),
    }
}

pub fn adapter(gpu: &Gpu) -> Adapter {
    Adapter::new(&gpu.info)
}

/// A knob's value as JSON.
pub fn value(value: &crate::expr::Value) -> serde_json::Value {
    use crate::expr::Value as V;
    match value {
        V::Number(number) => (*number).into(),
        V::Vector(numbers) => numbers.clone().into(),
        V::Flag(flag) => (*flag).into(),
        V::Text(text) => text.clone().into(),
        V::Unknown => serde_json::Value::Null,
    }
}
