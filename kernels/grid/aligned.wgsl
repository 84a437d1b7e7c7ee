// Module of the role `grid`: a box of cubes along the axes of the world.

struct GridValues {
    /// Corner with the smallest coordinates, metres.
    grid_min: vec3f,
    /// Edge of a voxel, metres.
    voxel_size: f32,
    /// Voxels along each axis.
    grid_size: vec3u,
    /// Largest side of the scene, in voxels.
    scene_side: f32,
}

var<uniform> values: GridValues;

/// World to voxels: voxel i covers [i, i + 1).
fn to_grid(position: vec3f) -> vec3f {
    return (position - values.grid_min) / values.voxel_size;
}

fn from_grid(position: vec3f) -> vec3f {
    return values.grid_min + position * values.voxel_size;
}

/// A direction of the world along the grid's axes; its length stays.
fn direction_to_grid(direction: vec3f) -> vec3f {
    return direction;
}
