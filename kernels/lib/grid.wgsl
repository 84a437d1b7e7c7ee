// The voxel grid: a box of cubes. How it lies in the world is up to the role `grid`, whose module has `values`,
// `to_grid`, `from_grid` and `direction_to_grid`. What is in voxels is along the grid's axes; all else, normals and
// directions of light among it, is along the world's.

import role/grid;

/// Number of a voxel in a dense buffer: x fastest.
fn voxel_number(voxel: vec3u) -> u32 {
    return (voxel.z * values.grid_size.y + voxel.y) * values.grid_size.x + voxel.x;
}
