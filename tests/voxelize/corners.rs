//! Corners as the voxelizer snaps them. WGSL leaves open how products, sums and divisions are rounded, so the driver is
//! asked; what it says is held against double precision.

use crate::oracle::{Triangle, VOXEL};
use crate::voxelizer::{Grid, run};
use glam::DVec3;
use voxgi::scene::{Scene, layout};
use voxgi::session::Request;

/// The corners of a triangle in the world, metres.
pub fn world_corners(scene: &Scene, t: &layout::Triangle) -> [DVec3; 3] {
    let [x, y, z, w] =
        scene.instances[t.instance as usize].to_world.map(|column| column.truncate().as_dvec3());
    [t.a, t.b, t.c].map(|corner| {
        let p = scene.vertices[corner as usize].position.as_dvec3();
        x * p.x + y * p.y + z * p.z + w
    })
}

/// The scene's triangles as they are snapped in a grid. `place`: from the world to the grid's voxels; every corner must be
/// the odd unit that is nearest to its place, or `sure` units farther: as far as single floats know that.
pub fn snapped(scene: &Scene, grid: &Grid, place: impl Fn(DVec3) -> DVec3, sure: f64) -> Vec<Triangle> {
    let sets = grid.knobs.iter().map(|(knob, value)| ((*knob).to_owned(), value.clone())).collect();
    let parts = vec![("grid".to_owned(), grid.part.to_owned())];
    let request = Request { pipeline: "corners".to_owned(), size: [8, 8], sets, parts, ..Request::default() };
    let image = run(&request, "corners", scene).expect("the corners");
    let words = image.bytes.chunks_exact(4).map(|w| i64::from(i32::from_le_bytes([w[0], w[1], w[2], w[3]])));
    let words: Vec<i64> = words.collect();
    let triangles: Vec<Triangle> = words
        .chunks_exact(12)
        .zip(&scene.triangles)
        .map(|(words, triangle)| {
            let corners = [0, 1, 2].map(|corner| [0, 1, 2].map(|axis| words[4 * corner + axis]));
            for (corner, world) in corners.iter().zip(world_corners(scene, triangle)) {
                let exact = place(world) * VOXEL as f64;
                let off = DVec3::from_array(corner.map(|unit| unit as f64)) - exact;
                let odd = corner.iter().all(|unit| unit % 2 != 0);
                assert!(odd && off.abs().max_element() < 1.0 + sure, "{exact} is snapped to {corner:?}");
            }
            corners
        })
        .collect();
    assert_eq!(triangles.len(), scene.triangles.len());
    triangles
}
