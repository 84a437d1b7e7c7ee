//! Runs the frames of a profile: one for the first use, some to warm up, then those that count.

use crate::device::Gpu;
use crate::frame::{Changes, Frame, Times};
use crate::problem::Result;
use crate::record::Samples;

/// How many frames are run, after the first one, and how many of them count.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// Frames after the first one that don't count.
    pub warm_up: u32,
    pub frames: u32,
    /// Counters are read after each frame, outside of all times.
    pub counters: bool,
}

/// What is run: a frame, and what comes before and after.
pub trait Subject {
    /// Before the frame of this number among those that count, or before one that doesn't. Says what changed.
    fn before(&mut self, counted: Option<u32>) -> Result<Changes>;
    fn frame(&mut self) -> (&mut Frame, &Gpu);
    /// After each frame, counted or not.
    fn after(&mut self, times: &Times, counters: &[(String, u32)]);
}

/// What came out.
#[derive(Clone, Debug, Default)]
pub struct Ran {
    /// The first frame, and those that count.
    pub samples: Samples,
    /// The counters after each frame that counts, if they were asked for.
    pub counters: Vec<Vec<(String, u32)>>,
}

/// Runs the course from a frame that was just realised.
pub fn run(subject: &mut impl Subject, course: Course) -> Result<Ran> {
    let mut ran = Ran::default();
    for index in 0..=course.warm_up {
        let changes = subject.before(None)?;
        let (frame, gpu) = subject.frame();
        let times = frame.run(gpu, &changes)?.clone();
        subject.after(&times, &[]);
        if index == 0 {
            ran.samples.first = Some(times);
        }
    }
    // What is kept stays kept; only a pipeline that goes on from frame to frame starts again.
    if subject.frame().0.goes_on() {
        subject.frame().0.reset();
    }
    for index in 0..course.frames {
        let changes = subject.before(Some(index))?;
        let (frame, gpu) = subject.frame();
        let times = frame.run(gpu, &changes)?.clone();
        let counters = if course.counters { frame.counters(gpu)? } else { Vec::new() };
        subject.after(&times, &counters);
        ran.samples.frames.push(times);
        if course.counters {
            ran.counters.push(counters);
        }
    }
    Ok(ran)
}
