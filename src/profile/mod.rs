//! Profiles: many frames of a pipeline, what each stage took and moved, and how near that is to what the device can do.
//!
//! | file | what |
//! |---|---|
//! | [`path`] | ways of the camera |
//! | [`run`](mod@run) | the frames |
//! | [`traffic`](mod@traffic) | bytes that each step has to move |
//! | [`copy`] | the device's own copy speed |
//! | [`align`](mod@align) | GPU times on the CPU's clock |
//! | [`trace`](mod@trace) | the frames as a trace file |
//! | `tracy` | the frames as zones for the Tracy profiler, behind the cargo feature of that name |

pub mod align;
pub mod copy;
pub mod path;
pub mod run;
pub mod trace;
#[cfg(feature = "tracy")]
pub mod tracy;
pub mod traffic;

use crate::frame::Frame;
use crate::record::{self, Record, Samples, StageProfile};
use crate::scene::Scene;
use crate::schedule::{Fate, Step};
use copy::{CopySpeeds, gb_per_s};
use serde::Serialize;
use traffic::{Traffic, traffic};

/// A record with all raw samples, bytes and the device's copy speed. Its stages have a [`StageProfile`].
#[derive(Clone, Debug, Serialize)]
pub struct Profile {
    #[serde(flatten)]
    pub record: Record,
    /// Frames between the first one and those that count.
    pub warm_up: u32,
    /// What changes between frames, if not everything does.
    pub changes: Option<Vec<String>>,
    /// How the camera moves: the path's file, or the degrees of an orbit.
    pub camera_moves: Option<String>,
    /// By frame, like every list of samples; `null` where unknown.
    pub frame_samples_ms: Vec<Option<f64>>,
    pub encode_samples_ms: Vec<f64>,
    pub fills_samples_ms: Vec<Option<f64>>,
    pub fills: Traffic,
    pub copy: CopySpeeds,
}

impl Profile {
    /// Adds to `record` what `samples` and the schedule say.
    pub fn new(
        mut record: Record,
        frame: &Frame,
        scene: &Scene,
        samples: &Samples,
        copy: CopySpeeds,
    ) -> Self {
        let bytes = traffic(&frame.graph, &frame.schedule, scene);
        let whole = samples.median(|times| times.frame);
        for (stage, fate) in record.stages.iter_mut().zip(&frame.schedule.fates) {
            let Fate::Run { step } = fate else { continue };
            let traffic = bytes.get(*step).copied().flatten();
            stage.profile = Some(StageProfile::new(stage.gpu_ms, whole, traffic, copy.best()));
        }
        let is_fill = |step: &Step| matches!(step, Step::Start { .. });
        let fills = frame.schedule.steps.iter().zip(&bytes).filter(|(step, _)| is_fill(step));
        let fills = fills.filter_map(|(_, bytes)| *bytes).fold(Traffic::default(), Traffic::and);
        Self {
            record,
            warm_up: 0,
            changes: None,
            camera_moves: None,
            frame_samples_ms: samples.frames.iter().map(|times| times.frame).collect(),
            encode_samples_ms: samples.frames.iter().map(|times| times.encode).collect(),
            fills_samples_ms: samples.frames.iter().map(|times| record::fills(frame, times)).collect(),
            fills,
            copy,
        }
    }
}

impl StageProfile {
    /// Of a stage that takes `ms` of a frame's `whole`, and moves `traffic` on a device that copies `best` · 10⁹ bytes a
    /// second.
    pub fn new(ms: Option<f64>, whole: Option<f64>, traffic: Option<Traffic>, best: Option<f64>) -> Self {
        let speed = ms.zip(traffic).and_then(|(ms, traffic)| gb_per_s(traffic.total(), ms));
        let ratio = |(part, of): (f64, f64)| (of > 0.0).then(|| part / of);
        Self {
            share: ms.zip(whole).and_then(ratio),
            read_bytes: traffic.map(|t| t.read_bytes),
            written_bytes: traffic.map(|t| t.written_bytes),
            gb_per_s: speed,
            of_copy: speed.zip(best).and_then(ratio),
        }
    }
}
