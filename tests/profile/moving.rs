//! Under a moving camera, only what depends on it runs, and that sees the camera of its own frame.

use crate::world::{gpu, scene, started};
use std::collections::BTreeSet;
use voxgi::document::Cause;
use voxgi::frame::Changes;
use voxgi::graph::facts;
use voxgi::profile::path::orbit;
use voxgi::profile::run::{Course, moves, run};

fn eye_after(frames: u32, varying: Option<BTreeSet<u32>>) -> ([f32; 3], [f64; 3]) {
    let scene = scene();
    let (mut frame, changes) = started(&scene, "where", [3, 1], varying);
    let cameras = orbit(&scene.cameras[0], &scene.bounds, 200.0, frames);
    let expected = cameras.last().expect("frames").position.to_array();
    let moves = Some(moves(&frame, &cameras, 3.0, &changes).expect("values"));
    let course = Course { warm_up: 1, frames, changes, moves, counters: false };
    let mut calls = 0;
    let ran = run(&mut frame, gpu(), &course, |_, _, _| calls += 1).expect("frames");
    assert_eq!((ran.samples.frames.len(), calls), (frames as usize, frames + 2));
    let reference = frame.graph.plan.resource("shown").expect("an output");
    let bytes = frame.read(gpu(), &reference).expect("a picture").bytes;
    let words: Vec<f32> =
        bytes.chunks_exact(4).map(|w| f32::from_le_bytes([w[0], w[1], w[2], w[3]])).collect();
    (words.try_into().expect("three numbers"), expected)
}

#[test]
fn values_follow_the_camera() {
    let camera = BTreeSet::from([facts::bit(Cause::Camera)]);
    for varying in [None, Some(camera)] {
        for frames in [1, 2, 5] {
            let (found, expected) = eye_after(frames, varying.clone());
            let far = (0..3).map(|i| (f64::from(found[i]) - expected[i]).abs()).fold(0.0, f64::max);
            assert!(far < 1e-6, "{found:?}, {expected:?} after {frames} frames");
        }
    }
    // The control: where nothing may change, the first frame's place stays.
    let (found, expected) = eye_after(5, Some(BTreeSet::new()));
    assert!((f64::from(found[0]) - expected[0]).abs() > 1e-3);
}

/// The bits of each frame: always the camera's, and the value's only where it is not the one before.
#[test]
fn only_what_differs_counts_as_changed() {
    let scene = scene();
    let camera = BTreeSet::from([facts::bit(Cause::Camera)]);
    let (frame, changes) = started(&scene, "where", [3, 1], Some(camera.clone()));
    let still = vec![scene.cameras[0].clone(); 2];
    let turned = orbit(&scene.cameras[0], &scene.bounds, 90.0, 2);
    let bits = |cameras: &[_]| -> Vec<Changes> {
        let moves = moves(&frame, cameras, 1.0, &changes).expect("values");
        moves.iter().map(|step| step.changes().clone()).collect()
    };
    let only_camera = Changes::Only(camera.clone());
    assert_eq!(bits(&still), [only_camera.clone(), only_camera]);
    let both = Changes::Only(camera.into_iter().chain([facts::value_bit(0)]).collect());
    assert_eq!(bits(&turned)[1], both);
}
