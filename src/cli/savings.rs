//! What omissions save: the time that stages which were kept or dropped take when they run all the same.

use super::run::{RunArgs, Started};
use crate::frame::Changes;
use crate::problem::Result;
use crate::record::{self, Samples, StageRecord};
use crate::session::{Request, prepare};

/// Frames over which the medians are taken, after a first one.
const FRAMES: usize = 3;

/// Runs the pipeline with nothing left out, and notes in `stages` what those that were left out then take. A stage that
/// can't be bound for this scene has no such time: what it would read is not there.
pub fn measure(stages: &mut [StageRecord], args: &RunArgs, started: &Started) -> Result<()> {
    let (gpu, scene) = (&started.gpu, started.scene());
    let library = args.pipeline_args.library()?;
    let request = Request { drop: false, keep: false, ..args.pipeline_args.request(&args.pipeline) };
    let prepared = prepare(&request, &library, Some(scene))?;
    let mut frame = prepared.realise(gpu, scene, started.clock.clone(), None)?;
    let mut samples = Samples { first: Some(frame.run(gpu, &Changes::All)?.clone()), ..Samples::default() };
    for _ in 0..FRAMES {
        samples.frames.push(frame.run(gpu, &Changes::All)?.clone());
    }
    let whole = record::stages(&frame, &samples);
    for stage in stages.iter_mut().filter(|stage| stage.status != "run") {
        stage.saved_ms = whole.iter().find(|other| other.path == stage.path).and_then(|other| other.gpu_ms);
    }
    Ok(())
}
