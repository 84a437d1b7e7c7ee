//! Scenes as they are, their corners snapped as the voxelizer says it does.

use crate::oracle::{self, Point, Rule, Ties, Triangle, VOXEL, number};
use crate::support::scenes;
use crate::voxelizer::{Case, Grid, METHODS, Way, counted};
use glam::Vec3;
use std::path::Path;
use voxgi::scene::layout::Instance;
use voxgi::scene::{self, Scene};

/// Where `grid/cube` lies and how large its voxels are, as single floats.
fn placed(scene: &Scene, resolution: i64) -> ([f32; 3], f32) {
    let (low, high) = (scene.bounds.min, scene.bounds.max);
    let voxel = f64::from((high - low).max_element()) / (resolution - 3) as f64;
    (low.to_array().map(|low| (f64::from(low) - 1.5 * voxel) as f32), voxel as f32)
}

/// A point of the world in units, as the voxelizer rounds it.
fn units(point: Vec3, (low, voxel): ([f32; 3], f32)) -> Point {
    [0, 1, 2].map(|axis| 2 * ((point[axis] - low[axis]) / voxel * (VOXEL / 2) as f32).floor() as i64)
}

fn unmoved(instance: &Instance) -> bool {
    instance.to_world.map(|column| column.truncate()) == [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO]
}

fn check(path: &Path, resolution: i64) {
    let scene = scene::load(path).expect("the scene");
    assert!(scene.instances.iter().all(unmoved), "the oracle moves nothing");
    let placed = placed(&scene, resolution);
    let corner = |vertex: u32| units(scene.vertices[vertex as usize].position, placed);
    let triangles: Vec<Triangle> = scene.triangles.iter().map(|t| [t.a, t.b, t.c].map(corner)).collect();
    let name = path.display().to_string();
    Case { name: &name, scene: &scene, grid: &Grid::cube(resolution), triangles: &triangles, control: 100 }
        .check();
}

#[test]
fn the_cornell_box() {
    check(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-point.glb"), 32);
}

#[test]
fn bunny_and_dragon() {
    let Some(folder) = scenes() else { return };
    for (scene, resolution) in
        [("bunny.glb", 64), ("bunny.glb", 128), ("dragon-100k.glb", 64), ("dragon-100k.glb", 128)]
    {
        check(&folder.join(scene), resolution);
    }
}

/// What snapping does: the bunny's voxels from corners in 2^-28 of a voxel, not snapped to 2^-11.
#[test]
fn snapping_changes_few_voxels() {
    const SIDE: i64 = 1 << 28;
    let Some(folder) = scenes() else { return };
    let scene = scene::load(&folder.join("bunny.glb")).expect("the scene");
    let size = [128; 3];
    let voxel = f64::from((scene.bounds.max - scene.bounds.min).max_element()) / 125.0;
    let fine = |vertex: u32| -> Point {
        let from_low =
            (scene.vertices[vertex as usize].position.as_dvec3() - scene.bounds.min.as_dvec3()) / voxel;
        (from_low + 1.5).to_array().map(|place| (place * SIDE as f64).floor() as i64)
    };
    let triangles: Vec<Triangle> = scene.triangles.iter().map(|t| [t.a, t.b, t.c].map(fine)).collect();
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
