//! The slice map holds the same voxels as the payload of bits, for all who fill it and all who read it.

use crate::atlas::{through, unwrapped};
use crate::lattice::Lattice;
use crate::model::{Model, Part};
use crate::oracle::{Rule, Triangle, VOXEL, filled};
use crate::random::{Region, hardened};
use crate::turns::Turn;
use crate::voxelizer::{Grid, METHODS, Way, counted, gpu, library, run};
use fastrand::Rng;
use std::path::Path;
use voxgi::frame::{Changes, Clock, Image};
use voxgi::play::Play;
use voxgi::scene::{self, Scene};
use voxgi::session::{Request, prepare};

const PAYLOADS: [&str; 2] = ["payload/bits", "payload/slices"];

/// Still triangles, and some in a node that moves from the start on, if anything shall.
fn crowd(lattice: &Lattice, moving: bool) -> Scene {
    let [low, high] = [lattice.low.map(|x| x + VOXEL), lattice.high.map(|x| x - VOXEL)];
    let region = Region { low, high };
    let mut rng = Rng::with_seed(31);
    let mut some = |number, voxels: i64, step| region.triangles(&mut rng, number, voxels * VOXEL, step);
    let mut triangles = || [some(200, 2, 1), some(12, 12, 2), hardened(some(100, 4, 512), 512)].concat();
    let parts: [Vec<Triangle>; 2] = [lattice.fixed(&triangles()), triangles()];
    let parts: Vec<Part> = parts.iter().map(|triangles| lattice.part(triangles)).collect();
    let keys = "(time: 0), (time: 1, offset: (0.001, 0, 0)), (time: 2)";
    let motion = moving.then(|| format!("(node: \"part1\", keys: [{keys}])"));
    unwrapped(lattice.loaded(&Model { parts, motion, ..Model::default() }))
}

fn request(pipeline: &str, grid: &Grid, voxelize: &str, payload: &str) -> Request {
    let parts = [("grid", grid.part), ("payload", payload), ("voxelize", voxelize)];
    Request {
        pipeline: pipeline.to_owned(),
        size: [64, 64],
        sets: grid.knobs.iter().map(|(knob, value)| ((*knob).to_owned(), value.clone())).collect(),
        parts: parts.map(|(role, part)| (role.to_owned(), part.to_owned())).to_vec(),
        ..Request::default()
    }
}

fn bits(image: &Image) -> Vec<u32> {
    image.data.iter().map(|count| *count as u32).collect()
}

/// Depths below, at and beyond whole words; still, and with something that moves.
#[test]
fn slices_hold_the_same_voxels() {
    let cases = [
        (33, [1.0, 0.5, 0.3125], true, Rule::Thin),
        (32, [1.0; 3], false, Rule::Conservative),
        (70, [0.3, 0.25, 1.0], true, Rule::Conservative),
    ];
    for (resolution, parts, moving, rule) in cases {
        let lattice = Lattice::oblong(resolution, parts);
        let scene = crowd(&lattice, moving);
        let grid = &lattice.grid;
        for method in METHODS {
            let [expected, found] =
                PAYLOADS.map(|payload| counted(&scene, grid, &Way { method, payload, rule }));
            assert!(filled(&expected) > 500 && expected == found, "{method}, {resolution}");
        }
        let [expected, found] = PAYLOADS.map(|payload| through(&scene, grid, payload, 2.0));
        assert!(filled(&expected) > 200 && expected == found, "the atlas, {resolution}");
        let solid = |payload| {
            let request = request("occupancy", grid, "voxelize/solid", payload);
            bits(&run(&request, "occupancy", &scene).expect("solid voxels"))
        };
        let [expected, found] = PAYLOADS.map(solid);
        assert!(filled(&expected) > 500 && expected == found, "solid, {resolution}");
    }
}

fn cornell() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-moving.ron");
    scene::load(&path).expect("the scene")
}

/// Pictures of walks and of the list show the same; and depth is not width.
#[test]
fn who_reads_them_sees_the_same() {
    let scene = cornell();
    let grid = Turn { cover: [1.0, 0.7, 0.9], ..Turn::new(45, 20.0, 10.0, 0.0) };
    let grid = Grid { part: "grid/turned", knobs: grid.knobs(), size: [0; 3] };
    for pipeline in ["voxels", "cubes"] {
        let [expected, found] = PAYLOADS.map(|payload| {
            let request = request(pipeline, &grid, "voxelize/triangles", payload);
            run(&request, "color", &scene).expect("a picture").bytes
        });
        assert!(expected.iter().any(|byte| *byte != 0) && expected == found, "{pipeline}");
    }
}

/// What is filled when the scene has gone from the first of some times to the last.
fn played(payload: &str, times: &[f64]) -> Vec<u32> {
    let mut scene = cornell();
    scene.pose(times[0]);
    let grid = Grid::cube(45);
    let request = request("occupancy", &grid, "voxelize/triangles", payload);
    let prepared = prepare(&request, &library(), Some(&scene)).expect("a graph");
    let clock = Clock::Wall("for the test".to_owned());
    let mut frame = prepared.realise(gpu(), &scene, clock, None).expect("a frame");
    let mut play = Play::new(scene, 0, request.size, &frame);
    for time in times {
        play.go_to(&mut frame, gpu(), *time).expect("a moment");
        frame.run(gpu(), &Changes::All).expect("a frame");
    }
    let shown = frame.graph.plan.resource("occupancy").expect("the voxels");
    bits(&frame.read(gpu(), &shown).expect("the voxels"))
}

/// Nothing stays of where things were.
#[test]
fn what_was_filled_is_cleared() {
    let [first, last] = [0.0, 0.5].map(|time| played(PAYLOADS[0], &[time]));
    let differing = first.iter().zip(&last).filter(|(a, b)| a != b).count();
    assert!(differing > 100, "the control: it has moved");
    for payload in PAYLOADS {
        assert!(played(payload, &[0.0, 0.5]) == last, "{payload}");
    }
}
