//! A comparison: what several runs did on several scenes, held against each scene's reference. It is the file
//! `comparison.json` of a folder of runs, which every report is made from.
//!
//! Times are milliseconds; one that is not known is `null`. Paths are relative to the folder.

use crate::record::{Adapter, Spread};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Changes whenever a field changes its name, its place or its meaning.
pub const SCHEMA: u32 = 1;

/// The folder's file.
pub const FILE: &str = "comparison.json";

#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Comparison {
    pub schema: u32,
    /// What kind of command made it: `compare` or `sweep`.
    pub command: String,
    /// As the folder is called.
    pub name: String,
    /// UTC, `2026-11-22T08:30:00Z`.
    pub date: String,
    pub version: String,
    pub adapter: Adapter,
    /// Of the output, in pixels.
    pub size: [u32; 2],
    /// How PNGs are made from radiance, and what FLIP and SSIM look at: times 2^`exposure`, then the tone curve of this
    /// name.
    pub exposure: f32,
    pub curve: String,
    pub scenes: Vec<SceneEntry>,
    pub runs: Vec<Run>,
}

#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct SceneEntry {
    pub name: String,
    /// As given on the command line.
    pub file: String,
    pub camera: String,
    /// Of all its files, where things are, and the camera: the same only for the same scene.
    pub content: String,
    pub triangles: usize,
    /// What the loader left out, one sentence each.
    pub lacks: Vec<String>,
    /// By the name of the reference; runs say which is theirs.
    pub references: BTreeMap<String, Reference>,
}

/// What runs are held against. A scene has several where runs simulate different light, as with `diffuse_only`.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Reference {
    pub pipeline: String,
    pub knobs: BTreeMap<String, serde_json::Value>,
    /// For each pixel.
    pub samples: u64,
    /// That it took to make, in this run and in those that it was resumed from.
    pub seconds: f64,
    /// Samples that were in the cache already.
    pub cached_samples: u64,
    /// By output: what its own variance amounts to as relMSE. A run's error up to twice that can't be told from 0.
    pub noise: BTreeMap<String, f64>,
    /// Mean of each output, over all pixels and channels.
    pub mean: BTreeMap<String, f64>,
    pub pictures: BTreeMap<String, Pictures>,
}

/// Files of one output.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Pictures {
    /// Linear, layered: one file for all outputs of a run.
    pub exr: String,
    /// Tone-mapped by the comparison's exposure and curve, the same for the reference and all runs.
    pub png: String,
    /// Signed relative difference to the reference: blue darker, white alike, red brighter. Absent for references.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub difference: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub flip: Option<String>,
}

#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Run {
    /// Unlike all others of the same scene: the pipeline, parts and knobs that were set.
    pub name: String,
    pub scene: String,
    pub reference: String,
    pub pipeline: String,
    /// Role → part, all of them.
    pub parts: BTreeMap<String, String>,
    /// All of them.
    pub knobs: BTreeMap<String, serde_json::Value>,
    /// The knobs and parts that were asked for, as written; a sweep's coordinates.
    pub set: BTreeMap<String, String>,
    /// Of those, the knobs whose values tuning found.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub tuned: crate::tuned::Uses,
    pub clock: String,
    pub clock_reason: Option<String>,
    /// Of whole frames, on the GPU.
    pub gpu_ms: Timing,
    /// The median of each time that it was run, on a device of its own each time; in the order of running.
    pub repeats_ms: Vec<Option<f64>>,
    /// The first frame, in which drivers compile.
    pub first_use_ms: Option<f64>,
    pub encode_ms: Option<f64>,
    pub stages: Vec<StageTime>,
    /// Output → measure → value, over all pixels.
    pub errors: BTreeMap<String, BTreeMap<String, f64>>,
    /// Mask → output → measure → value, over the pixels of the mask alone.
    pub masked: BTreeMap<String, BTreeMap<String, BTreeMap<String, f64>>>,
    /// Outputs whose relMSE can't be told from the reference's own noise: [`crate::measure::within_noise`].
    pub within_noise: Vec<String>,
    pub memory: Memory,
    /// What the scene calls for and is not done, one sentence each.
    pub lacks: Vec<String>,
    pub pictures: BTreeMap<String, Pictures>,
    /// The files of pipeline, parts and kernels as they were read → the copy in the folder.
    pub documents: BTreeMap<String, String>,
}

#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Timing {
    pub median: Option<f64>,
    pub p10: Option<f64>,
    pub p90: Option<f64>,
    /// One for each sampled frame.
    pub samples: Vec<Option<f64>>,
}

#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct StageTime {
    pub path: String,
    /// `run`, `kept` or `dropped`.
    pub status: String,
    /// Why it was kept or dropped.
    pub reason: Option<String>,
    pub gpu_ms: Option<f64>,
    pub spread: Spread,
    pub samples_ms: Vec<Option<f64>>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Memory {
    /// Of the pipeline's resources at once, kept ones included.
    pub peak_bytes: u64,
}
