//! The rows of a profile's table: stages in listed order, below the parts they belong to.

use crate::profile::Profile;
use crate::profile::copy::gb_per_s;
use crate::profile::traffic::Traffic;
use crate::record::{Spread, StageRecord, quantile};

/// One line of numbers; `None` is unknown.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// With two spaces for each part that it is in.
    pub name: String,
    pub median: Option<f64>,
    pub spread: Spread,
    /// Of the frame, 1 is all.
    pub share: Option<f64>,
    pub first_use: Option<f64>,
    pub bytes: Option<Traffic>,
    pub gb_per_s: Option<f64>,
    /// Of the device's copy speed, 1 is as fast.
    pub of_copy: Option<f64>,
}

/// The stages that ran, or ran once and are kept since. A part with several of them has a line for all together.
pub fn rows(profile: &Profile) -> Vec<Row> {
    let ran: Vec<&StageRecord> =
        profile.record.stages.iter().filter(|stage| stage.gpu_ms.is_some()).collect();
    let mut rows = Vec::new();
    nest(profile, &ran, 0, 0, &mut rows);
    rows
}

/// Rows of stages whose paths are the same up to byte `from`.
fn nest(profile: &Profile, stages: &[&StageRecord], from: usize, depth: usize, rows: &mut Vec<Row>) {
    let indent = "  ".repeat(depth);
    let part = |stage: &StageRecord| stage.path[from..].split_once('/').map(|(part, _)| part.to_owned());
    for group in stages.chunk_by(|a, b| part(a).is_some() && part(a) == part(b)) {
        match (group, group.first().and_then(|stage| part(stage))) {
            ([_, _, ..], Some(name)) => {
                rows.push(Row { name: format!("{indent}{name}"), ..together(profile, group) });
                nest(profile, group, from + name.len() + 1, depth + 1, rows);
            }
            _ => rows.extend(group.iter().map(|stage| Row {
                name: format!("{indent}{}", &stage.path[from..]),
                ..together(profile, &[stage])
            })),
        }
    }
}

/// Stages as one: the sum of their times in each frame, then the statistics of that.
fn together(profile: &Profile, stages: &[&StageRecord]) -> Row {
    let frames = stages.first().map_or(0, |stage| stage.samples_ms.len());
    let sum = |of: &mut dyn Iterator<Item = Option<f64>>| {
        of.flatten().fold(None, |sum: Option<f64>, time| Some(sum.unwrap_or(0.0) + time))
    };
    let sums: Vec<f64> =
        (0..frames).filter_map(|frame| sum(&mut stages.iter().map(|s| s.samples_ms[frame]))).collect();
    let bytes =
        stages.iter().map(|stage| bytes_of(stage)).try_fold(Traffic::default(), |all, b| Some(all.and(b?)));
    let first_use = sum(&mut stages.iter().map(|stage| stage.first_use_ms));
    numbers(profile, &sums, first_use, bytes)
}

/// All fills before stages.
pub fn fills(profile: &Profile) -> Row {
    let sums: Vec<f64> = profile.fills_samples_ms.iter().flatten().copied().collect();
    Row { name: "fills".to_owned(), ..numbers(profile, &sums, None, Some(profile.fills)) }
}

/// The whole frame.
pub fn frame(profile: &Profile) -> Row {
    let samples: Vec<f64> = profile.frame_samples_ms.iter().flatten().copied().collect();
    let mut ran = profile.record.stages.iter().filter(|stage| stage.gpu_ms.is_some());
    let bytes = ran.try_fold(profile.fills, |all, stage| Some(all.and(bytes_of(stage)?)));
    Row { name: "frame".to_owned(), ..numbers(profile, &samples, profile.record.first_use_ms, bytes) }
}

fn bytes_of(stage: &StageRecord) -> Option<Traffic> {
    let profile = stage.profile?;
    Some(Traffic { read_bytes: profile.read_bytes?, written_bytes: profile.written_bytes? })
}

fn numbers(profile: &Profile, samples: &[f64], first_use: Option<f64>, bytes: Option<Traffic>) -> Row {
    let median = quantile(samples, 0.5);
    let speed = median.zip(bytes).filter(|(_, b)| b.total() > 0).and_then(|(ms, b)| gb_per_s(b.total(), ms));
    let ratio = |(part, whole): (f64, f64)| (whole > 0.0).then(|| part / whole);
    Row {
        name: String::new(),
        median,
        spread: Spread { p10: quantile(samples, 0.1), p90: quantile(samples, 0.9) },
        share: median.zip(profile.record.frame_ms).and_then(ratio),
        first_use,
        bytes,
        gb_per_s: speed,
        of_copy: speed.zip(profile.copy.best()).and_then(ratio),
    }
}
