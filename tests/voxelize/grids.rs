//! Grids of all sizes and shapes.

use crate::lattice::Lattice;
use crate::oracle::VOXEL;
use crate::random::{Region, hardened};
use crate::voxelizer::check;
use fastrand::Rng;

/// Not only powers of two.
const RESOLUTIONS: [i64; 7] = [1, 2, 3, 5, 17, 33, 100];

/// Triangles of all sizes on this lattice, half of them hard; the finest grids get fewer.
fn voxelize(name: &str, lattice: &Lattice, resolution: i64) {
    let region = Region::scene(lattice);
    let mut rng = Rng::with_seed(resolution.unsigned_abs());
    let whole = resolution * VOXEL;
    let mut some = |number, reach: i64, step| region.triangles(&mut rng, number, reach, step);
    let mut triangles = [some(200, 2 * VOXEL, 1), some(60, whole / 3, VOXEL / 16)].concat();
    triangles.extend(hardened([some(200, 3 * VOXEL, 1), some(20, whole / 2, 1)].concat(), 2));
    triangles.extend(some(6, whole / 2, 1));
    // A few voxels are filled whatever the rule.
    let control = if resolution < 6 { 0 } else { 5 * resolution as usize };
    check(&format!("{name}, {resolution}"), lattice, &triangles, control);
}

#[test]
fn cubes_of_any_resolution() {
    for resolution in RESOLUTIONS {
        voxelize("a cube", &Lattice::cube(resolution), resolution);
    }
}

#[test]
fn boxes_of_any_resolution() {
    for (i, resolution) in RESOLUTIONS.into_iter().enumerate() {
        let mut parts = [1.0, 0.5, 0.3125];
        parts.rotate_right(i % 3);
        voxelize("a box", &Lattice::oblong(resolution, parts), resolution);
    }
}
