//! Under a moving camera, only what depends on it runs, and that sees the camera of its own frame.

use crate::world::{gpu, scene, started};
use std::collections::BTreeSet;
use voxgi::device::Gpu;
use voxgi::document::Cause;
use voxgi::frame::{Changes, Frame, Times};
use voxgi::graph::facts;
use voxgi::play::Play;
use voxgi::problem::Result;
use voxgi::profile::path::orbit;
use voxgi::profile::run::{Course, Subject, run};
use voxgi::scene::Camera;

/// A pipeline that shows where the camera is, by a named value.
struct Watched {
    frame: Frame,
    play: Play,
    cameras: Vec<Camera>,
    everything: bool,
    after: usize,
}

impl Watched {
    fn new(turn: f64, frames: u32, varying: Option<BTreeSet<u32>>) -> Self {
        let scene = scene();
        let everything = varying.is_none();
        let frame = started(&scene, "where", [3, 1], varying);
        let camera = scene.cameras[0].clone();
        let cameras = orbit(&camera, &scene.bounds, turn, frames);
        let play = Play::new(scene, 0, [3, 1], &frame);
        Self { frame, play, cameras, everything, after: 0 }
    }

    fn eye(&self) -> [f32; 3] {
        let reference = self.frame.graph.plan.resource("shown").expect("an output");
        let bytes = self.frame.read(gpu(), &reference).expect("a picture").bytes;
        let word = |w: &[u8]| f32::from_le_bytes([w[0], w[1], w[2], w[3]]);
        let words: Vec<f32> = bytes.chunks_exact(4).map(word).collect();
        words.try_into().expect("three numbers")
    }

    /// How far the eye is from where the last camera is.
    fn error(&self) -> f64 {
        let expected = self.cameras.last().expect("frames").position.to_array();
        let eye = self.eye();
        (0..3).map(|i| (f64::from(eye[i]) - expected[i]).abs()).fold(0.0, f64::max)
    }
}

impl Subject for Watched {
    fn before(&mut self, counted: Option<u32>) -> Result<Changes> {
        let camera = counted.map(|index| self.cameras[index as usize].clone());
        let bits = match camera {
            Some(camera) => self.play.look(&mut self.frame, &camera)?,
            None => BTreeSet::new(),
        };
        Ok(if self.everything { Changes::All } else { Changes::Only(bits) })
    }

    fn frame(&mut self) -> (&mut Frame, &Gpu) {
        (&mut self.frame, gpu())
    }

    fn after(&mut self, times: &Times, _: &[(String, u32)]) {
        self.after += 1;
        assert_eq!(times.spans.len(), self.frame.schedule.steps.len());
    }
}

const COURSE: Course = Course { warm_up: 1, frames: 5, counters: false };

#[test]
fn values_follow_the_camera() {
    let camera = BTreeSet::from([facts::bit(Cause::Camera)]);
    for varying in [None, Some(camera)] {
        for frames in [1, 2, 5] {
            let mut watched = Watched::new(200.0, frames, varying.clone());
            let ran = run(&mut watched, Course { frames, ..COURSE }).expect("frames");
            assert_eq!((ran.samples.frames.len(), watched.after), (frames as usize, frames as usize + 2));
            assert!(watched.error() < 1e-6, "{} after {frames} frames", watched.error());
        }
    }
    // The control: where nothing was to change, the first frame's place stays.
    let mut watched = Watched::new(200.0, 5, Some(BTreeSet::new()));
    run(&mut watched, COURSE).expect("frames");
    assert!(watched.error() > 1e-3);
}

/// A camera that stands still changes nothing; one that moves makes the stage that sees it run again.
#[test]
fn what_does_not_move_is_not_run() {
    let camera = BTreeSet::from([facts::bit(Cause::Camera)]);
    for (turn, known) in [(0.0, false), (90.0, true)] {
        let mut watched = Watched::new(turn, 5, Some(camera.clone()));
        let base = scene().cameras[0].clone();
        if turn == 0.0 {
            watched.cameras.fill(base);
        }
        let ran = run(&mut watched, COURSE).expect("frames");
        let last = ran.samples.frames.last().expect("frames");
        assert_eq!(last.steps.iter().any(Option::is_some), known, "turned by {turn}");
    }
}
