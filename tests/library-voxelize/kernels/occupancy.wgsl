// For tests: which voxels are filled, 1 or 0. Voxel (x, y, z) is pixel (x, y + z · the grid's size along y).
// Reads a voxel, writes a texel.

import lib/grid;
import role/voxels;

var occupancy: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(occupancy)) {
        let voxel = vec3u(id.x, id.y % values.grid_size.y, id.y / values.grid_size.y);
        textureStore(occupancy, id.xy, vec4f(f32(u32(is_filled(voxel))), 0.0, 0.0, 1.0));
    }
}
