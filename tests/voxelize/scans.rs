//! Scenes as they are: scans and halls, their corners snapped as the voxelizer says it does.

use crate::corners::{snapped, world_corners};
use crate::oracle::{self, Point, Rule, Ties, Triangle, number};
use crate::support::scenes;
use crate::voxelizer::{Case, Grid, METHODS, Way, counted};
use glam::DVec3;
use std::path::Path;
use voxgi::scene::{self, Scene};

/// From the world to the voxels of `grid/cube`, not rounded.
fn place(scene: &Scene, resolution: i64) -> impl Fn(DVec3) -> DVec3 {
    let (low, high) = (scene.bounds.min, scene.bounds.max);
    let voxel = f64::from((high - low).max_element()) / (resolution - 3) as f64;
    move |world| (world - low.as_dvec3()) / voxel + 1.5
}

fn check(scene: &Scene, resolution: i64) {
    let grid = Grid::cube(resolution);
    let triangles = snapped(scene, &grid, place(scene, resolution), 0.1);
    Case { name: &scene.name, scene, grid: &grid, triangles: &triangles, control: 100 }.check();
}

#[test]
fn the_cornell_box() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-point.glb");
    check(&scene::load(&path).expect("the scene"), 32);
}

#[test]
fn bunny_and_dragon() {
    let Some(folder) = scenes() else { return };
    for name in ["bunny.glb", "dragon-100k.glb"] {
        let scene = scene::load(&folder.join(name)).expect("the scene");
        [64, 128].iter().for_each(|resolution| check(&scene, *resolution));
    }
}

/// A hall whose nodes are scaled. Holes of masked materials have no fragments; they are closed, so that all count.
#[test]
fn sponza() {
    let Some(folder) = scenes() else { return };
    let mut scene = scene::load(&folder.join("sponza-crytek.glb")).expect("the scene");
    let masked = scene.materials.iter().filter(|material| material.alpha_cutoff > 0.0).count();
    assert!(masked > 0, "something is masked");
    scene.materials.iter_mut().for_each(|material| material.alpha_cutoff = 0.0);
    [64, 128].iter().for_each(|resolution| check(&scene, *resolution));
}

/// What snapping does: the bunny's voxels from corners in 2^-28 of a voxel, not snapped to 2^-11.
#[test]
fn snapping_changes_few_voxels() {
    const SIDE: i64 = 1 << 28;
    let Some(folder) = scenes() else { return };
    let scene = scene::load(&folder.join("bunny.glb")).expect("the scene");
    let size = [128; 3];
    let place = place(&scene, 128);
    let fine = |world: DVec3| -> Point { (place(world) * SIDE as f64).floor().to_array().map(|x| x as i64) };
    let triangles: Vec<Triangle> =
        scene.triangles.iter().map(|t| world_corners(&scene, t).map(fine)).collect();
    for rule in Rule::BOTH {
        let mut exact = vec![0; 128 * 128 * 128];
        for triangle in &triangles {
            oracle::voxels(triangle, size, SIDE, rule, Ties::Count).for_each(|v| exact[number(v, size)] = 1);
        }
        let way = Way { method: METHODS[0], payload: "payload/bits", rule };
        let counted = counted(&scene, &Grid::cube(128), &way);
        let (changed, filled) = (oracle::differences(&counted, &exact), oracle::filled(&exact));
        println!("bunny at 128³, {rule:?}: snapping changes {changed} of {filled} voxels");
        assert!(changed > 0 && 1000 * changed < filled, "{changed} of {filled}");
    }
}
