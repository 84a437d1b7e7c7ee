//! Scenes as they are: scans and halls, their corners snapped as the voxelizer says it does.

use crate::oracle::{self, Point, Rule, Ties, Triangle, VOXEL, number};
use crate::support::scenes;
use crate::voxelizer::{Case, Grid, METHODS, Way, counted, run};
use glam::DVec3;
use std::path::Path;
use voxgi::scene::{self, Scene, layout};
use voxgi::session::Request;

/// The scene's corners in units of `grid/cube`, not rounded.
fn places(scene: &Scene, resolution: i64) -> impl Fn(&layout::Triangle) -> [DVec3; 3] {
    let (low, high) = (scene.bounds.min, scene.bounds.max);
    let voxel = f64::from((high - low).max_element()) / (resolution - 3) as f64;
    move |t| {
        let [x, y, z, w] =
            scene.instances[t.instance as usize].to_world.map(|column| column.truncate().as_dvec3());
        [t.a, t.b, t.c].map(|corner| {
            let p = scene.vertices[corner as usize].position.as_dvec3();
            let world = x * p.x + y * p.y + z * p.z + w;
            ((world - low.as_dvec3()) / voxel + 1.5) * VOXEL as f64
        })
    }
}

/// The scene's triangles as they are snapped. WGSL leaves open how products and divisions are rounded, so the driver is
/// asked; every corner must be the odd unit that is nearest to its place, as far as single floats know that.
fn snapped(scene: &Scene, resolution: i64) -> Vec<Triangle> {
    const SURE: f64 = 0.1;
    let sets = vec![("resolution".to_owned(), resolution.to_string())];
    let request = Request { pipeline: "corners".to_owned(), size: [8, 8], sets, ..Request::default() };
    let image = run(&request, "corners", scene).expect("the corners");
    let words = image.bytes.chunks_exact(4).map(|w| i64::from(i32::from_le_bytes([w[0], w[1], w[2], w[3]])));
    let words: Vec<i64> = words.collect();
    let places = places(scene, resolution);
    let triangles: Vec<Triangle> = words
        .chunks_exact(12)
        .zip(&scene.triangles)
        .map(|(words, triangle)| {
            let corners = [0, 1, 2].map(|corner| [0, 1, 2].map(|axis| words[4 * corner + axis]));
            for (corner, place) in corners.iter().zip(places(triangle)) {
                let off = DVec3::from_array(corner.map(|unit| unit as f64)) - place;
                let odd = corner.iter().all(|unit| unit % 2 != 0);
                assert!(odd && off.abs().max_element() < 1.0 + SURE, "{place} is snapped to {corner:?}");
            }
            corners
        })
        .collect();
    assert_eq!(triangles.len(), scene.triangles.len());
    triangles
}

fn check(scene: &Scene, resolution: i64) {
    let triangles = snapped(scene, resolution);
    let grid = Grid::cube(resolution);
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
    let places = places(&scene, 128);
    let fine =
        |place: DVec3| -> Point { (place * (SIDE / VOXEL) as f64).floor().to_array().map(|x| x as i64) };
    let triangles: Vec<Triangle> = scene.triangles.iter().map(|t| places(t).map(fine)).collect();
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
