//! What omissions save: the time that stages which were kept or dropped take when they run all the same.

use crate::device::Gpu;
use crate::frame::{Changes, Clock};
use crate::library::Library;
use crate::problem::Result;
use crate::record::{self, Samples, StageRecord};
use crate::scene::Scene;
use crate::session::{Request, prepare};

/// Frames over which the medians are taken, after a first one.
const FRAMES: usize = 3;

/// Runs the pipeline with nothing left out, and notes in `stages` what those that were left out then take. A stage that
/// can't be bound for this scene has no such time: what it would read is not there.
pub fn measure(
    stages: &mut [StageRecord],
    request: &Request,
    library: &Library,
    scene: &Scene,
    (gpu, clock): (&Gpu, &Clock),
) -> Result<()> {
    let request = Request { drop: false, keep: false, ..request.clone() };
    let mut frame = prepare(&request, library, Some(scene))?.realise(gpu, scene, clock.clone(), None)?;
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
