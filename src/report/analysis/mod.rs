//! What a set of runs says in numbers: which settings are worth their time, and what each knob costs and gives.
//!
//! Pure functions over [`Run`]s. An error is any measure that is better the smaller it is. What is not known (no time,
//! no such output) takes no part; it is never read as 0.

mod marginal;
#[cfg(test)]
mod tests;

pub use marginal::{Change, Line, Marginal, coordinate, coordinates, lines, marginals};

use crate::comparison::Run;

/// A run as its time and its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Index into the runs that it was taken from.
    pub run: usize,
    /// Median of whole frames on the GPU, ms; finite, above 0.
    pub time: f64,
    /// Finite, not below 0.
    pub error: f64,
}

/// The error of `run` by `measure` in `output` over all pixels, if it is known and finite.
pub fn error(run: &Run, output: &str, measure: &str) -> Option<f64> {
    run.errors.get(output)?.get(measure).copied().filter(|error| error.is_finite())
}

/// The median time of `run` in ms, if it is known and can be drawn.
pub fn time(run: &Run) -> Option<f64> {
    run.gpu_ms.median.filter(|time| time.is_finite() && *time > 0.0)
}

/// The runs of `scene` whose time and error are known, in their order.
pub fn points(runs: &[Run], scene: &str, output: &str, measure: &str) -> Vec<Point> {
    let of_scene = runs.iter().enumerate().filter(|(_, run)| run.scene == scene);
    let point = |(index, run): (usize, &Run)| {
        let error = error(run, output, measure).filter(|error| *error >= 0.0)?;
        Some(Point { run: index, time: time(run)?, error })
    };
    of_scene.filter_map(point).collect()
}

/// The non-dominated points, from the fastest to the one of least error: no other point is as fast with less error, or
/// faster with as little. Of equal points the first is kept.
pub fn front(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.error.total_cmp(&b.error)));
    let mut least = f64::INFINITY;
    sorted.retain(|point| {
        let better = point.error < least;
        least = least.min(point.error);
        better
    });
    sorted
}

/// The fastest point whose error is at most `percent` % above the least one. Errors below `noise`, which can't be told
/// apart, count as `noise`.
pub fn cheapest_within(points: &[Point], percent: f64, noise: f64) -> Option<Point> {
    let error = |point: &Point| point.error.max(noise);
    let least = points.iter().map(error).min_by(f64::total_cmp)?;
    let enough = points.iter().filter(|point| error(point) <= least * (1.0 + percent / 100.0));
    enough.min_by(|a, b| a.time.total_cmp(&b.time).then(error(a).total_cmp(&error(b)))).copied()
}

/// Runs whose times are alike: each group starts at the fastest run that is in none, and holds those that take at most
/// `share` longer (0.2: a fifth). Groups of one are left out; if nothing else is there, the two that are nearest by
/// ratio are a group. Both are in order of time.
pub fn equal_times(points: &[Point], share: f64) -> Vec<Vec<Point>> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.run.cmp(&b.run)));
    let mut groups: Vec<Vec<Point>> = Vec::new();
    for point in &sorted {
        match groups.last_mut() {
            Some(group) if point.time <= group[0].time * (1.0 + share) => group.push(*point),
            _ => groups.push(vec![*point]),
        }
    }
    groups.retain(|group| group.len() > 1);
    if groups.is_empty() {
        let ratio = |pair: &&[Point]| pair[1].time / pair[0].time;
        let nearest = sorted.windows(2).min_by(|a, b| ratio(a).total_cmp(&ratio(b)));
        groups.extend(nearest.map(<[Point]>::to_vec));
    }
    groups
}
