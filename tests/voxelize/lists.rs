//! The list of filled voxels: each once, and what does not fit is said.

use crate::compact::{counter, request, set, start, words_of};
use crate::lattice::Lattice;
use crate::random::Region;
use crate::voxelizer::{Grid, METHODS, Way, counted, gpu};
use crate::{oracle::Rule, oracle::VOXEL};
use fastrand::Rng;
use voxgi::frame::Changes;
use voxgi::scene::Scene;

/// Not a power of two, and not a multiple of the words' 32 voxels.
const SIDE: i64 = 37;

fn scene() -> Scene {
    let lattice = Lattice::cube(SIDE);
    let mut rng = Rng::with_seed(41);
    let triangles = Region::scene(&lattice).triangles(&mut rng, 400, 6 * VOXEL, 1);
    lattice.scene(&lattice.fixed(&triangles))
}

/// How often each voxel is listed, vertices of the draw, and voxels that found no room.
fn listed(scene: &Scene, list: &str) -> (Vec<u32>, u32, u64) {
    let mut request = set(request("listed", "payload/bits", ("voxelize/triangles", &[])), "resolution", SIDE);
    request.parts.push(("list".to_owned(), list.to_owned()));
    // The draw is read when the frame is over.
    request.reuse = false;
    let mut frame = start(&request, scene);
    frame.run(gpu(), &Changes::All).expect("a frame");
    let resource = |name| frame.graph.plan.resource(name).expect("a resource");
    let image = frame.read(gpu(), &resource("listed")).expect("the picture");
    let draw = frame.read_buffer(gpu(), resource("voxel_draw").resource).expect("the draw");
    (words_of(&image.bytes), words_of(&draw)[0], counter(&frame, "unlisted_voxels"))
}

#[test]
fn each_filled_voxel_is_listed_once() {
    let scene = scene();
    let way = Way { method: METHODS[0], payload: "payload/bits", rule: Rule::Thin };
    let filled = counted(&scene, &Grid::cube(SIDE), &way);
    let all: u32 = filled.iter().sum();
    assert!(all > 2000);
    let (times, vertices, unlisted) = listed(&scene, "list/filled");
    assert!(times == filled, "every one once");
    assert_eq!((vertices, unlisted), (36 * all, 0));
    // With room for fewer, as many of them as fit.
    let (times, vertices, unlisted) = listed(&scene, "list/short");
    assert!(times.iter().zip(&filled).all(|(times, filled)| times <= filled));
    assert_eq!(times.iter().sum::<u32>(), 1000);
    assert_eq!((vertices, unlisted), (36 * 1000, u64::from(all) - 1000));
}
