//! Runs pipelines in-process, in every way that must not show in the picture.

use std::collections::{BTreeMap, BTreeSet};
use voxgi::device::Gpu;
use voxgi::document::Cause;
use voxgi::frame::{Changes, Image, Poison};
use voxgi::graph::facts;
use voxgi::plan::Reference;
use voxgi::problem::Problems;
use voxgi::scene::{self, Scene};

pub use crate::job::{Job, Run, gpu, open, root, scene, shipped};

/// The Cornell box with a block and a light that move.
pub fn moving_scene() -> Scene {
    scene::load(&root("scenes/cornell-moving.ron")).expect("a scene of this repository")
}

/// What a problem's reader is told, on one line.
pub fn messages(problems: &Problems) -> String {
    let texts: Vec<String> = problems.iter().map(|p| format!("[{}] {}", p.code, p.message)).collect();
    texts.join("; ")
}

impl Job<'_> {
    /// The outputs after some frames.
    pub fn outputs(&self, gpu: &Gpu, frames: usize) -> Outputs {
        let run = self.start(gpu).and_then(|mut run| {
            run.frames(frames)?;
            Ok(run.outputs())
        });
        run.unwrap_or_else(|problems| panic!("{}: {}", self.request.pipeline, messages(&problems)))
    }

    /// Whether frames add to those before, so that pictures differ from frame to frame.
    pub fn adds_up(&self) -> bool {
        self.prepare().is_ok_and(|prepared| prepared.graph.plan.progress.is_some())
    }

    /// The same job in every way that must not show, each with a name.
    pub fn ways(&self) -> Vec<(&'static str, Self)> {
        let way = |change: &dyn Fn(&mut Self)| {
            let mut job = self.clone();
            change(&mut job);
            job
        };
        vec![
            ("without reuse", way(&|job| job.request.reuse = false)),
            ("without dropping", way(&|job| job.request.drop = false)),
            ("keeping, as nothing changes", self.clone().keep(&[])),
            ("keeping, as the camera changes", self.clone().keep(&[Cause::Camera])),
            ("poisoned with ones", way(&|job| job.poison = Some(Poison::Ones))),
            ("poisoned with a pattern", way(&|job| job.poison = Some(Poison::Pattern))),
            ("timed by the wall clock", way(&|job| job.wall_clock = true)),
        ]
    }
}

/// By output (and subresource), its bytes.
pub type Outputs = BTreeMap<String, Vec<u8>>;

/// What differs, in words.
pub fn differences(a: &Outputs, b: &Outputs) -> Vec<String> {
    assert!(a.keys().eq(b.keys()), "other outputs: {:?}, {:?}", a.keys(), b.keys());
    let mut found = Vec::new();
    for (name, bytes) in a {
        let other = &b[name];
        let differing = bytes.iter().zip(other).filter(|(x, y)| x != y).count();
        if differing > 0 || bytes.len() != other.len() {
            found.push(format!("{name}: {differing} of {} bytes", bytes.len()));
        }
    }
    found
}

impl Run<'_> {
    /// One frame, before which only `causes` changed.
    pub fn frame_after(&mut self, causes: &[Cause]) -> Result<(), Problems> {
        let bits: BTreeSet<u32> = causes.iter().map(|cause| facts::bit(*cause)).collect();
        self.frame.run(self.gpu, &Changes::Only(bits))?;
        Ok(())
    }

    fn reference(&self, name: &str) -> Reference {
        self.frame.graph.plan.resource(name).unwrap_or_else(|p| panic!("{}", p.message))
    }

    /// A texture, or one mip or layer of it.
    pub fn image(&self, name: &str) -> Image {
        self.frame.read(self.gpu, &self.reference(name)).unwrap_or_else(|p| panic!("{}", p.message))
    }

    /// The 32-bit words of a picture that shows a list.
    pub fn words(&self, name: &str) -> Vec<u32> {
        let bytes = self.image(name).bytes;
        bytes.chunks_exact(4).map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]])).collect()
    }

    pub fn floats(&self, name: &str) -> Vec<f32> {
        self.words(name).into_iter().map(f32::from_bits).collect()
    }

    /// All that the pipeline is for: each mip and layer of its outputs.
    pub fn outputs(&self) -> Outputs {
        let mut outputs = Outputs::new();
        for (name, whole, _) in &self.frame.graph.plan.outputs {
            let resource = &self.frame.graph.resources[whole.resource];
            let one = |chosen: Option<u32>, count| chosen.map_or(0..count, |n| n..n + 1);
            for mip in one(whole.mip, resource.mips) {
                for layer in one(whole.layer, resource.layers) {
                    let cell = Reference { mip: Some(mip), layer: Some(layer), ..*whole };
                    let image = self.frame.read(self.gpu, &cell);
                    let image = image.unwrap_or_else(|problem| panic!("{name}: {}", problem.message));
                    outputs.insert(format!("{name}@mip{mip}@layer{layer}"), image.bytes);
                }
            }
        }
        outputs
    }
}
