//! What the engine may leave out, keep, reorder or share never shows in a picture, in no bit of it.

use crate::bench::{Job, differences, gpu, open, scene, shipped};
use std::sync::Arc;
use voxgi::device::LimitSet;
use voxgi::frame::Poison;
use voxgi::problem::Kind;
use voxgi::scene::atlas::Atlas;

/// Small enough for a software driver; everything else is as shipped.
fn small<'a>(scene: &'a voxgi::scene::Scene, pipeline: &str) -> Job<'a> {
    Job::new(scene, pipeline, [48, 48]).small("32", "128")
}

/// Runs all shipped pipelines on a scene in all ways. Two frames, since only in the second something is kept.
fn shipped_pipelines_keep_their_bits(scene_name: &str) {
    let scene = scene(scene_name);
    let mut compared = 0;
    for pipeline in shipped() {
        let job = small(&scene, &pipeline);
        // Two frames of what does not add up are as one.
        let plain = job.outputs(gpu(), if job.adds_up() { 8 } else { 1 });
        assert!(plain.values().any(|bytes| bytes.iter().any(|b| *b != 0)), "{pipeline} draws nothing");
        for (way, job) in job.ways() {
            if job.adds_up() && job.request.keep {
                continue; // What is said to change starts it again.
            }
            let frames = if job.adds_up() { 8 } else { 2 };
            let found = differences(&plain, &job.outputs(gpu(), frames));
            assert!(found.is_empty(), "{pipeline} on {scene_name}, {way}: {found:?}");
            compared += 1;
        }
    }
    assert!(compared >= 7);
}

/// Ways to voxelize, and what voxels hold: all that fill the same voxels. Running averages say that they depend on order.
const PARTS: [(&str, &str); 12] = [
    ("voxelize", "voxelize/fragments"),
    ("voxelize", "voxelize/hybrid"),
    ("voxelize", "voxelize/classified"),
    ("voxelize", "voxelize/queue"),
    ("voxelize", "voxelize/atlas"),
    ("voxelize", "voxelize/solid"),
    ("payload", "payload/maximum"),
    ("payload", "payload/slices"),
    ("payload", "payload/compact"),
    ("grid", "grid/box"),
    ("grid", "grid/window"),
    ("grid", "grid/turned"),
];

/// What parts leave from stage to stage, lists and indirect arguments among it, is never read before it is written.
#[test]
fn parts_keep_their_bits_where_things_move() {
    let scene = crate::bench::moving_scene();
    // Unwrapped here rather than in the user's cache.
    assert!(scene.atlas.set(Arc::new(Atlas::of(&scene, None))).is_ok());
    for (role, part) in PARTS {
        // Some have no attributes.
        let bare = ["voxelize/solid", "payload/slices"].contains(&part);
        let pipeline = if bare { "cubes" } else { "cones" };
        let mut job = small(&scene, pipeline).set_where_known("bounces", "1");
        job.request.parts.push((role.to_owned(), part.to_owned()));
        let job = job.set_where_known("cutoff", "8").set_where_known("yaw", "30.0");
        let plain = job.outputs(gpu(), 1);
        assert!(plain.values().any(|bytes| bytes.iter().any(|b| *b != 0)), "{part} draws nothing");
        for (way, job) in job.ways() {
            let found = differences(&plain, &job.outputs(gpu(), 2));
            assert!(found.is_empty(), "{part}, {way}: {found:?}");
        }
    }
}

#[test]
fn what_depends_on_the_order_of_threads_says_so() {
    let scene = scene("cornell-point");
    let reasons = |payload: &str| {
        let mut job = small(&scene, "cones");
        job.request.parts.push(("payload".to_owned(), payload.to_owned()));
        let prepared = job.prepare().expect("a graph");
        let stages = prepared.graph.stages.iter();
        stages.filter(|s| s.order_dependent.is_some()).map(|s| s.path.clone()).collect::<Vec<_>>()
    };
    assert_eq!(reasons("payload/average"), ["voxelize/still", "voxelize/moving"]);
    assert!(reasons("payload/sums").is_empty() && reasons("payload/maximum").is_empty());
}

#[test]
fn shipped_pipelines_keep_their_bits_with_a_point_light() {
    shipped_pipelines_keep_their_bits("cornell-point");
}

#[test]
fn shipped_pipelines_keep_their_bits_with_an_area_light() {
    shipped_pipelines_keep_their_bits("cornell-box");
}

/// A pipeline that asks for more than WebGPU guarantees must say so; one that does not looks the same.
#[test]
fn shipped_pipelines_keep_their_bits_within_the_limits_of_webgpu() {
    let scene = scene("cornell-point");
    let limited = open(&LimitSet::Webgpu);
    let mut compared = 0;
    for pipeline in shipped() {
        let job = small(&scene, &pipeline);
        match job.start(&limited) {
            Ok(mut run) => {
                let frames = if job.adds_up() { 8 } else { 1 };
                run.frames(frames).expect("frames");
                let found = differences(&job.outputs(gpu(), frames), &run.outputs());
                assert!(found.is_empty(), "{pipeline}: {found:?}");
                compared += 1;
            }
            Err(problems) => {
                assert!(problems.iter().any(|p| p.kind == Kind::Input), "{pipeline}: {problems:?}");
                println!("{pipeline} needs more than WebGPU guarantees");
            }
        }
    }
    assert!(compared > 0, "no pipeline runs within the limits of WebGPU");
}

/// The control of all that is above: a stage that reads what nobody wrote, which no check can know, shows.
#[test]
fn poison_shows_where_a_covered_resource_is_not_covered() {
    let scene = scene("cornell-point");
    let with = |poison, cover: &str| {
        let mut job = Job::new(&scene, "uncovered", [8, 8]).set("covered", cover);
        job.poison = Some(poison);
        job.outputs(gpu(), 1)
    };
    let both = |cover| differences(&with(Poison::Ones, cover), &with(Poison::Pattern, cover));
    assert_eq!(both("false").len(), 2, "texture and buffer");
    assert!(both("true").is_empty());
}
