//! Small pipelines, in memory of the device.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use voxgi::device::{Gpu, LimitSet};
use voxgi::frame::{Clock, Frame};
use voxgi::library::Library;
use voxgi::scene::{self, Scene};
use voxgi::session::{Prepared, Request, prepare};

/// A path below the repository's root.
pub fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| {
        Gpu::open(None, &LimitSet::Adapter)
            .expect("a Vulkan device: `sh scripts/setup.sh` installs a software one")
    })
}

pub fn scene() -> Scene {
    scene::load(&root("scenes/cornell-point.glb")).expect("a scene of this repository")
}

/// A pipeline of these tests' libraries; what depends on none of the bits of `varying` is kept.
pub fn prepared(scene: &Scene, pipeline: &str, size: [u32; 2], varying: Option<BTreeSet<u32>>) -> Prepared {
    let folders = vec![root("tests/profile/library"), root("tests/library-engine")];
    let library = Library::new(folders).expect("the tests' libraries");
    let mut request = Request { pipeline: pipeline.to_owned(), size, ..Request::default() };
    if let Some(varying) = varying {
        request.keep = true;
        request.varying = varying;
    }
    prepare(&request, &library, Some(scene)).expect("a pipeline that is right")
}

/// The same, ready to run on the test's device.
pub fn started(scene: &Scene, pipeline: &str, size: [u32; 2], varying: Option<BTreeSet<u32>>) -> Frame {
    let frame = prepared(scene, pipeline, size, varying).realise(gpu(), scene, Clock::Timestamps, None);
    frame.expect("a frame")
}
