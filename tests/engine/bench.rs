//! Runs pipelines in-process, in every way that must not show in the picture.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use voxgi::device::{Gpu, LimitSet};
use voxgi::document::Cause;
use voxgi::frame::{Changes, Clock, Frame, Image, Poison};
use voxgi::graph::facts;
use voxgi::library::Library;
use voxgi::plan::Reference;
use voxgi::problem::Problems;
use voxgi::scene::{self, Scene};
use voxgi::session::{Prepared, Request, prepare};

/// A path below the repository's root.
pub fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The one device that tests share; tests that provoke its errors open their own.
pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| open(&LimitSet::Adapter))
}

pub fn open(limits: &LimitSet) -> Gpu {
    Gpu::open(None, limits).expect("a Vulkan device: `sh scripts/setup.sh` installs a software one")
}

/// The Cornell box with a point light (`cornell-point`) or its area light (`cornell-box`).
pub fn scene(name: &str) -> Scene {
    scene::load(&root(&format!("scenes/{name}.glb"))).expect("a scene of this repository")
}

/// The Cornell box with a block and a light that move.
pub fn moving_scene() -> Scene {
    scene::load(&root("scenes/cornell-moving.ron")).expect("a scene of this repository")
}

/// The names of all shipped pipelines.
pub fn shipped() -> Vec<String> {
    let names: Vec<String> = std::fs::read_dir(root("pipelines"))
        .expect("the folder of pipelines")
        .filter_map(|entry| entry.expect("an entry").path().to_str().map(str::to_owned))
        .filter(|path| path.ends_with(".ron"))
        .map(|path| Path::new(&path).file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    assert!(!names.is_empty(), "no pipelines are shipped");
    names
}

/// What a problem's reader is told, on one line.
pub fn messages(problems: &Problems) -> String {
    let texts: Vec<String> = problems.iter().map(|p| format!("[{}] {}", p.code, p.message)).collect();
    texts.join("; ")
}

/// A pipeline to be run, and how.
#[derive(Clone)]
pub struct Job<'a> {
    pub scene: &'a Scene,
    pub library: Library,
    /// Its name, size, knobs and what the scheduler may do.
    pub request: Request,
    pub poison: Option<Poison>,
    pub wall_clock: bool,
}

impl<'a> Job<'a> {
    /// A pipeline of the library that is there for these tests, or of the shipped one.
    pub fn new(scene: &'a Scene, pipeline: &str, size: [u32; 2]) -> Self {
        let library = Library::new(vec![root("tests/library-engine")]).expect("the tests' library");
        let request = Request { pipeline: pipeline.to_owned(), size, ..Request::default() };
        Self { scene, library, request, poison: None, wall_clock: false }
    }

    pub fn set(mut self, knob: &str, value: &str) -> Self {
        self.request.sets.push((knob.to_owned(), value.to_owned()));
        self
    }

    /// Keeps what depends on none of `causes`, which are what changes between frames.
    pub fn keep(mut self, causes: &[Cause]) -> Self {
        self.request.keep = true;
        self.request.varying = causes.iter().map(|cause| facts::bit(*cause)).collect();
        self
    }

    pub fn prepare(&self) -> Result<Prepared, Problems> {
        prepare(&self.request, &self.library, Some(self.scene))
    }

    pub fn start<'g>(&self, gpu: &'g Gpu) -> Result<Run<'g>, Problems> {
        let clock = match self.wall_clock || !gpu.has(wgpu::Features::TIMESTAMP_QUERY) {
            true => Clock::Wall("for the test".to_owned()),
            false => Clock::Timestamps,
        };
        let changes = match self.request.keep {
            true => Changes::Only(self.request.varying.clone()),
            false => Changes::All,
        };
        let frame = self.prepare()?.realise(gpu, self.scene, clock, self.poison)?;
        Ok(Run { gpu, frame, changes })
    }

    /// The outputs after some frames.
    pub fn outputs(&self, gpu: &Gpu, frames: usize) -> Outputs {
        let run = self.start(gpu).and_then(|mut run| {
            run.frames(frames)?;
            Ok(run.outputs())
        });
        run.unwrap_or_else(|problems| panic!("{}: {}", self.request.pipeline, messages(&problems)))
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

/// A pipeline in memory of the device.
pub struct Run<'g> {
    pub gpu: &'g Gpu,
    pub frame: Frame,
    pub changes: Changes,
}

impl Run<'_> {
    pub fn frames(&mut self, count: usize) -> Result<(), Problems> {
        for _ in 0..count {
            self.frame.run(self.gpu, &self.changes)?;
        }
        Ok(())
    }

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
