// Places in the grid as whole numbers of units, so that what triangles fill can be decided exactly: odd ones, so that
// none lies on a face of a voxel or in its middle.

import lib/math;

/// Units of a voxel's side.
const UNITS: i32 = 4096;
/// Corners farther out than this are moved there, in voxels: products must fit.
const OUTMOST: f32 = 131072.0;

/// The unit that a place along an axis of the grid, in voxels, is snapped to.
fn snapped(p: vec3f) -> vec3i {
    let pairs = floor(clamp(p, vec3f(-OUTMOST), vec3f(OUTMOST)) * f32(UNITS / 2));
    let voxel = floor(pairs / f32(UNITS / 2));
    return UNITS * nearest_integers(voxel) + 2 * nearest_integers(pairs - voxel * f32(UNITS / 2)) + 1;
}

/// The voxel along each axis that holds a unit.
fn voxel_of(p: vec3i) -> vec3i {
    // Rounds down; the shift of negative numbers does.
    return p >> vec3u(12u);
}
