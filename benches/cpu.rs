//! CPU cost of what happens before and around the GPU's work: loading, planning, linking, scheduling, encoding.
//!
//! `cargo bench` runs all; the frame needs a Vulkan device (lavapipe will do).

use divan::Bencher;
use std::path::Path;
use voxgi::device::{Gpu, LimitSet};
use voxgi::frame::{Changes, Clock};
use voxgi::library::Library;
use voxgi::scene::{self, Scene};
use voxgi::session::{Request, prepare};

fn main() {
    divan::main();
}

fn cornell() -> Scene {
    scene::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-point.glb"))
        .expect("a built-in scene")
}

fn request(pipeline: &str) -> Request {
    Request { pipeline: pipeline.to_owned(), size: [64, 64], ..Request::default() }
}

#[divan::bench]
fn load_cornell() -> Scene {
    cornell()
}

/// The triangles' hierarchy: of Sponza where `VOXGI_SCENES` has it, else of the Cornell box.
#[divan::bench(sample_count = 5)]
fn hierarchy(bencher: Bencher) {
    let sponza = std::env::var_os("VOXGI_SCENES").map(|folder| Path::new(&folder).join("sponza-crytek.glb"));
    let scene = sponza.and_then(|file| scene::load(&file).ok()).unwrap_or_else(cornell);
    println!("{} triangles, {} bytes", scene.triangles.len(), 4 * scene::bvh::words(&scene).len());
    bencher.bench(|| scene::bvh::words(&scene));
}

/// From the text of the files to a schedule.
#[divan::bench(args = ["cones", "volume"])]
fn check(bencher: Bencher, pipeline: &str) {
    let (library, scene) = (Library::default(), cornell());
    bencher.bench(|| prepare(&request(pipeline), &library, Some(&scene)).expect("a built-in pipeline"));
}

/// GPU objects, with the driver's shader cache warm.
#[divan::bench(sample_count = 10)]
fn realise(bencher: Bencher) {
    let (library, scene) = (Library::default(), cornell());
    let gpu = Gpu::open(None, &LimitSet::Adapter).expect("a device");
    let prepared = || prepare(&request("cones"), &library, Some(&scene)).expect("a built-in pipeline");
    bencher.with_inputs(prepared).bench_local_values(|prepared| {
        prepared.realise(&gpu, &scene, Clock::Timestamps, None).expect("a frame")
    });
}

/// Encoding and submitting a frame of `cones` in steady state, as the engine's own clock has it: the printed times are of
/// the whole frame; the median of the encoding follows.
#[divan::bench(sample_count = 20)]
fn frame(bencher: Bencher) {
    let (library, scene) = (Library::default(), cornell());
    let gpu = Gpu::open(None, &LimitSet::Adapter).expect("a device");
    let mut request = request("cones");
    request.sets = vec![("resolution".to_owned(), "16".to_owned())];
    let prepared = prepare(&request, &library, Some(&scene)).expect("a built-in pipeline");
    let mut frame = prepared.realise(&gpu, &scene, Clock::Timestamps, None).expect("a frame");
    let mut encode = Vec::new();
    bencher.bench_local(|| encode.push(frame.run(&gpu, &Changes::All).expect("a frame").encode));
    println!(
        "encode and submit, median: {:.3} ms",
        voxgi::record::quantile(&encode, 0.5).unwrap_or(f64::NAN)
    );
}
