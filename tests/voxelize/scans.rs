//! Scenes as they are: scans and halls, their corners snapped as the voxelizer says it does.

use crate::corners::snapped;
use crate::support::scenes;
use crate::voxelizer::{Case, Grid};
use glam::DVec3;
use std::path::Path;
use voxgi::scene::{self, Scene};

/// From the world to the voxels of `grid/cube`, not rounded.
pub fn place(scene: &Scene, resolution: i64) -> impl Fn(DVec3) -> DVec3 {
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
