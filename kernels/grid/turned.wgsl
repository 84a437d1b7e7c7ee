// Module of the role `grid`: a box of cubes along axes of its own.
//
// Source: T (the paper on voxel-based global illumination of 2011), 3.1: position and orientation are arbitrary.
// Nine products for each position more than grid/aligned; with the axes of the world none of them is rounded, and all
// is as there. WGSL lets a driver fuse products and sums, in one kernel and not in another: where one does, a corner can
// be snapped to the next unit, and voxelizers that differ nowhere else differ there.

struct GridValues {
    /// The corner that voxel (0, 0, 0) begins at, metres.
    grid_min: vec3f,
    /// Edge of a voxel, metres.
    voxel_size: f32,
    /// Voxels along each axis.
    grid_size: vec3u,
    /// Largest side of the scene, in voxels.
    scene_side: f32,
    /// The grid's axes in the world: unit length, at right angles, x × y = z.
    axis_x: vec3f,
    axis_y: vec3f,
    axis_z: vec3f,
}

var<uniform> values: GridValues;

/// World to voxels: voxel i covers [i, i + 1) along the grid's axes.
fn to_grid(position: vec3f) -> vec3f {
    return direction_to_grid(position - values.grid_min) / values.voxel_size;
}

fn from_grid(position: vec3f) -> vec3f {
    let along = position * values.voxel_size;
    return values.grid_min + (along.x * values.axis_x + along.y * values.axis_y + along.z * values.axis_z);
}

/// A direction of the world along the grid's axes; its length stays.
fn direction_to_grid(direction: vec3f) -> vec3f {
    return vec3f(dot(values.axis_x, direction), dot(values.axis_y, direction), dot(values.axis_z, direction));
}
