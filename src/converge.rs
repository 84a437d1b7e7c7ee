//! Pipelines whose outputs get better from frame to frame: runs one until it is good enough.
//!
//! Outputs are means over samples; an output `X_variance` is the variance of the mean `X`, by pixel and channel.
//! An [`Estimate`] holds both, apart from the GPU: it can be kept, and a later run goes on from its samples.

use crate::device::Gpu;
use crate::frame::{Changes, Frame, Times};
use crate::measure::{self, Truth};
use crate::picture::Picture;
use crate::plan::PlannedProgress;
use crate::problem::{Problem, Result};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Ends the name of an output that is the variance of another.
pub const VARIANCE: &str = "_variance";

/// When to stop; whichever comes first, and at once if nothing is said. At least two batches are run, since one has no
/// variance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Until {
    /// For each pixel, those of an estimate that the run goes on from included.
    pub samples: Option<u64>,
    pub time: Option<Duration>,
    /// Noise, as [`Estimate::noise`], of every output that has a variance.
    pub error: Option<f64>,
}

/// Means and their variances.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// For each pixel.
    pub samples: u64,
    /// That it took.
    pub seconds: f64,
    /// By output, those of variances included.
    pub pictures: BTreeMap<String, Picture>,
}

impl Estimate {
    /// The outputs that have a variance.
    pub fn means(&self) -> impl Iterator<Item = (&str, &Picture, &Picture)> {
        self.pictures.iter().filter_map(|(name, picture)| {
            Some((name.as_str(), picture, self.pictures.get(&format!("{name}{VARIANCE}"))?))
        })
    }

    /// What the variance of an output amounts to as relMSE: [`measure::noise`].
    pub fn noise(&self, output: &str) -> Option<f64> {
        let (name, picture, variance) = self.means().find(|(name, _, _)| *name == output)?;
        measure::noise(&Truth { name, picture, variance: Some(variance) }, None).ok().flatten()
    }

    /// The largest noise of all outputs that have one.
    pub fn worst_noise(&self) -> f64 {
        self.means().filter_map(|(name, _, _)| self.noise(name)).fold(0.0, f64::max)
    }

    /// Both together, as one of all their samples. `None` if they are not alike.
    pub fn joined(&self, other: &Self) -> Option<Self> {
        let samples = self.samples + other.samples;
        let (a, b) = (self.samples as f64 / samples as f64, other.samples as f64 / samples as f64);
        let join = |(name, one): (&String, &Picture)| {
            let two = other.pictures.get(name)?;
            // The variance of a weighted mean takes the squares of the weights.
            let (a, b) = if name.ends_with(VARIANCE) { (a * a, b * b) } else { (a, b) };
            let same =
                (one.width(), one.height(), one.channels()) == (two.width(), two.height(), two.channels());
            let pairs = one.data().iter().zip(two.data());
            let data = pairs.map(|(x, y)| (a * f64::from(*x) + b * f64::from(*y)) as f32).collect();
            let picture = same.then(|| Picture::new(one.width(), one.height(), one.channels(), data))??;
            Some((name.clone(), picture))
        };
        let pictures = self.pictures.iter().map(join).collect::<Option<_>>()?;
        Some(Self { samples, seconds: self.seconds + other.seconds, pictures })
    }
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// For each pixel, those before this run included.
    pub samples: u64,
    /// From 0 to 1, as far as that can be told.
    pub done: f64,
    /// Seconds still to go, if that can be told.
    pub left: Option<f64>,
}

/// Runs batches until `until` is met, and gives what all of them together amount to, `before` included. `frame` was realised
/// with its knob [`PlannedProgress::first`] at `before.samples`. `watch` sees each step, and each estimate on the way that
/// is worth keeping (about twice a minute). The times are those of the frames that were run.
pub fn converge(
    gpu: &Gpu,
    frame: &mut Frame,
    progress: &PlannedProgress,
    before: Option<&Estimate>,
    until: &Until,
    watch: &mut dyn FnMut(Step, Option<&Estimate>) -> Result<()>,
) -> Result<(Estimate, Vec<Times>)> {
    // What an interruption may cost: a third of the time so far, and half a minute at most.
    const KEEP: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(30)];
    let start = Instant::now();
    let first = before.map_or(0, |estimate| estimate.samples);
    let (mut batches, mut next_look, mut kept) = (0, 2, start);
    let mut error = None;
    let mut spent = Vec::new();
    let nothing_said = *until == Until::default();
    loop {
        for _ in 0..progress.frames {
            let times = frame.run(gpu, &Changes::All)?;
            spent.push(times.clone());
        }
        batches += 1;
        let samples = first + batches * progress.batch;
        let elapsed = start.elapsed();
        let enough = [
            until.samples.map(|most| samples as f64 / most as f64),
            until.time.map(|most| elapsed.as_secs_f64() / most.as_secs_f64().max(1e-9)),
            // Noise falls as the number of samples grows.
            until
                .error
                .zip(error)
                .map(|(goal, (at, error)): (f64, (u64, f64))| goal / (error * at as f64 / samples as f64)),
        ];
        let done = enough.into_iter().flatten().fold(if nothing_said { 1.0 } else { 0.0 }, f64::max);
        let missing = samples as f64 * (1.0 - done).max(0.0) / done;
        let left = (done > 0.0).then(|| elapsed.as_secs_f64() * missing / (samples - first) as f64);
        watch(Step { samples, done: done.min(1.0), left }, None)?;
        let look = until.error.is_some() && (batches >= next_look || done >= 1.0);
        let keep = kept.elapsed() > (elapsed / 3).clamp(KEEP[0], KEEP[1]);
        if batches < 2 || !(look || keep || done >= 1.0) {
            continue;
        }
        let estimate = read(gpu, frame, batches * progress.batch, elapsed)?;
        let all = match before {
            None => estimate,
            Some(before) => before.joined(&estimate).ok_or_else(|| {
                Problem::failure("estimate", "what was kept of an earlier run is of another kind")
            })?,
        };
        if look {
            error = Some((samples, all.worst_noise()));
            // A quarter more samples changes the error enough to look again.
            next_look = batches + (batches / 4).max(1);
        }
        let good = until.error.zip(error).is_some_and(|(goal, (_, error))| error <= goal);
        let over = nothing_said
            || until.samples.is_some_and(|most| samples >= most)
            || until.time.is_some_and(|most| elapsed >= most);
        if good || over {
            return Ok((all, spent));
        }
        if keep {
            kept = Instant::now();
            watch(Step { samples, done: done.min(1.0), left }, Some(&all))?;
        }
    }
}

/// All outputs as they are now.
fn read(gpu: &Gpu, frame: &Frame, samples: u64, elapsed: Duration) -> Result<Estimate> {
    let mut pictures = BTreeMap::new();
    for (name, reference, _) in &frame.graph.plan.outputs {
        let image = frame.read(gpu, reference)?;
        // What is coded for a display is no mean.
        if image.float && image.depth == 1 {
            let picture = Picture::new(image.width, image.height, image.channels as u32, image.data);
            pictures.insert(
                name.clone(),
                picture.ok_or_else(|| Problem::failure("picture", "an output is empty"))?,
            );
        }
    }
    Ok(Estimate { samples, seconds: elapsed.as_secs_f64(), pictures })
}
