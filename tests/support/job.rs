//! Pipelines run in-process on the scenes of this repository.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use voxgi::device::{Gpu, LimitSet};
use voxgi::document::Cause;
use voxgi::frame::{Changes, Clock, Frame, Poison};
use voxgi::graph::facts;
use voxgi::library::Library;
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

    /// Sets a knob where the pipeline has it.
    pub fn set_where_known(self, knob: &str, value: &str) -> Self {
        let set = self.clone().set(knob, value);
        let unknown = |problems: Problems| problems.iter().any(|p| p.code == "unknown-knob");
        if set.prepare().is_err_and(unknown) { self } else { set }
    }

    /// So small that a software driver has it in no time, whatever pipeline it is.
    pub fn small(self, resolution: &str, light_map_size: &str) -> Self {
        let of_voxels = [("resolution", resolution), ("light_map_size", light_map_size)];
        let of_paths = [("batch", "4"), ("samples_per_frame", "1")];
        let all = of_voxels.into_iter().chain(of_paths);
        all.fold(self, |job, (knob, value)| job.set_where_known(knob, value))
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
}
