//! Runs the frames of a profile: one for the first use, some to warm up, then those that count.

use crate::device::Gpu;
use crate::document::Cause;
use crate::expr::Value;
use crate::frame::{Changes, Frame};
use crate::graph::facts;
use crate::problem::{Problem, Result};
use crate::record::Samples;
use crate::scene::Camera;
use crate::scene::layout::CameraUniform;
use crate::session::put_value;
use glam::DVec3;
use std::collections::BTreeMap;

/// What is run.
pub struct Course {
    /// Frames after the first one that don't count.
    pub warm_up: u32,
    pub frames: u32,
    /// What changes between frames, apart from the camera of `moves`.
    pub changes: Changes,
    /// The camera of each frame that counts, if it moves.
    pub moves: Option<Vec<Move>>,
    /// Counters are read after each frame, outside of all times.
    pub counters: bool,
}

/// All that follows from the place of the camera in one frame.
pub struct Move {
    camera: CameraUniform,
    values: Vec<Value>,
    changes: Changes,
}

/// What the cameras of a run change, frame by frame. The camera counts as changed in each, a named value where it
/// is not the one of the frame before (before the first: the planned one).
pub fn moves(frame: &Frame, cameras: &[Camera], aspect: f64, changes: &Changes) -> Result<Vec<Move>> {
    let plan = &frame.graph.plan;
    let mut last: Vec<Value> = plan.values.iter().map(|value| value.value.clone()).collect();
    let mut moves = Vec::with_capacity(cameras.len());
    for camera in cameras {
        let vector = |v: DVec3| Value::Vector(v.to_array().to_vec());
        let facts_now = BTreeMap::from([
            ("camera.position".to_owned(), vector(camera.position)),
            ("camera.forward".to_owned(), vector(camera.forward)),
        ]);
        let values = plan.values_with(&facts_now)?;
        let changes = match changes {
            Changes::All => Changes::All,
            Changes::Only(bits) => {
                let mut bits = bits.clone();
                bits.insert(facts::bit(Cause::Camera));
                let new = last.iter().zip(&values).enumerate().filter(|(_, (old, new))| old != new);
                bits.extend(new.map(|(index, _)| facts::value_bit(index)));
                Changes::Only(bits)
            }
        };
        last.clone_from(&values);
        moves.push(Move { camera: camera.uniform(aspect), values, changes });
    }
    Ok(moves)
}

impl Move {
    /// What is not as in the frame before.
    pub fn changes(&self) -> &Changes {
        &self.changes
    }

    fn apply(&self, frame: &mut Frame) {
        let table = frame.facts();
        table.put_camera(&self.camera);
        self.values.iter().enumerate().for_each(|(index, value)| put_value(table, index, value));
    }
}

/// What came out.
#[derive(Clone, Debug, Default)]
pub struct Ran {
    /// The first frame, and those that count.
    pub samples: Samples,
    /// The counters after each frame that counts, if they were asked for.
    pub counters: Vec<Vec<(String, u32)>>,
}

/// Runs the course from a frame that was just realised. `after` is called after each frame, counted or not.
pub fn run(
    frame: &mut Frame,
    gpu: &Gpu,
    course: &Course,
    mut after: impl FnMut(&Frame, &crate::frame::Times, &[(String, u32)]),
) -> Result<Ran, Problem> {
    let mut ran = Ran::default();
    for index in 0..=course.warm_up {
        let times = frame.run(gpu, &course.changes)?.clone();
        after(frame, &times, &[]);
        if index == 0 {
            ran.samples.first = Some(times);
        }
    }
    // What is kept stays kept; only a pipeline that goes on from frame to frame starts again.
    if frame.goes_on() {
        frame.reset();
    }
    for index in 0..course.frames as usize {
        let step = course.moves.as_ref().and_then(|moves| moves.get(index));
        if let Some(step) = step {
            step.apply(frame);
        }
        let times = frame.run(gpu, step.map_or(&course.changes, |step| &step.changes))?.clone();
        let counters = if course.counters { frame.counters(gpu)? } else { Vec::new() };
        after(frame, &times, &counters);
        ran.samples.frames.push(times);
        if course.counters {
            ran.counters.push(counters);
        }
    }
    Ok(ran)
}
