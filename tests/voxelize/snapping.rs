//! What snapping corners does: how many voxels are other ones than those of corners that are not snapped. By the oracle
//! alone, since the voxelizers fill just what it does with snapped corners (see `scans.rs`).

use crate::corners::world_corners;
use crate::oracle::{self, Point, Rule, Set, Triangle, VOXEL};
use crate::scans::place;
use crate::support::scenes;
use glam::DVec3;
use voxgi::scene::{self, Scene};

/// Units of a voxel's side for corners as they are: fine enough to be taken for exact.
const EXACT: i64 = 1 << 28;

/// A scene's triangles in the voxels of a grid, in [`EXACT`] units.
fn exact(scene: &Scene, place: impl Fn(DVec3) -> DVec3) -> Vec<Triangle> {
    let units =
        |world: DVec3| -> Point { (place(world) * EXACT as f64).floor().to_array().map(|x| x as i64) };
    scene.triangles.iter().map(|t| world_corners(scene, t).map(units)).collect()
}

/// The same as the voxelizer snaps them, in units of [`VOXEL`].
fn snapped(exact: &[Triangle]) -> Vec<Triangle> {
    let coarse = |x: i64| x.div_euclid(EXACT / VOXEL);
    let coarse: Vec<Triangle> = exact.iter().map(|t| t.map(|corner| corner.map(coarse))).collect();
    oracle::snapped(&coarse)
}

/// In how many voxels each rule's set differs once corners are snapped, at most one of a thousand. `full`: the sets of
/// corners as they are.
fn changed(name: &str, triangles: &[Triangle], resolution: i64, full: &[Set; 2]) -> usize {
    let snapped = snapped(triangles);
    let of = |(rule, full): (Rule, &Set)| {
        let (changed, filled) =
            (Set::of(&snapped, [resolution; 3], VOXEL, rule).differences(full), full.filled());
        println!("{name} at {resolution}³, {rule:?}: snapping changes {changed} of {filled} voxels");
        assert!(filled > 0 && 1000 * changed < filled, "{changed} of {filled}");
        changed
    };
    Rule::BOTH.into_iter().zip(full).map(of).sum()
}

#[test]
fn few_voxels_of_scans_and_a_hall_change() {
    let Some(folder) = scenes() else { return };
    let mut all = 0;
    for name in ["bunny.glb", "dragon-100k.glb", "sponza-crytek.glb"] {
        let scene = scene::load(&folder.join(name)).expect("the scene");
        for resolution in [64, 128] {
            let triangles = exact(&scene, place(&scene, resolution));
            let full = Rule::BOTH.map(|rule| Set::of(&triangles, [resolution; 3], EXACT, rule));
            all += changed(name, &triangles, resolution, &full);
        }
    }
    assert!(all > 0, "a control: some voxel changes");
}

/// Resolution, and published counts of the bunny's voxels: by separating axes in double precision, and of the thin set
/// without the triangles' bounds.
const PUBLISHED: [(i64, usize, usize); 3] =
    [(128, 56_950, 36_026), (256, 228_255, 138_146), (512, 913_469, 544_431)];

/// From the world to the voxels of the cube that those counts are of: around the middle of the scene's bounds, and on
/// each side larger than they are by one of 10,001 parts.
fn published_cube(scene: &Scene, resolution: i64) -> impl Fn(DVec3) -> DVec3 {
    let (low, high) = (scene.bounds.min.as_dvec3(), scene.bounds.max.as_dvec3());
    let side = (high - low).max_element() * (1.0 + 2.0 / 10_001.0);
    let corner = (low + high) / 2.0 - side / 2.0;
    move |world| (world - corner) / side * resolution as f64
}

/// The oracle finds what others have counted, and snapping changes few of these voxels.
#[test]
fn the_bunny_has_the_voxels_that_others_count() {
    let Some(folder) = scenes() else { return };
    let scene = scene::load(&folder.join("bunny.glb")).expect("the scene");
    let mut all = 0;
    for (resolution, conservative, thin) in PUBLISHED {
        let triangles = exact(&scene, published_cube(&scene, resolution));
        let set = |rule| Set::of(&triangles, [resolution; 3], EXACT, rule);
        let full = Rule::BOTH.map(set);
        assert_eq!([set(Rule::ThinBeyond).filled(), full[1].filled()], [thin, conservative], "{resolution}³");
        assert!(full[0].filled() < thin, "a control: bounds matter");
        all += changed("bunny", &triangles, resolution, &full);
    }
    assert!(all > 0, "a control: some voxel changes");
}
