// For tests: the albedo of each voxel, and whether it is filled. Voxel (x, y, z) is pixel (x, y + z · the grid's size
// along y).
// Reads a voxel, writes a texel.

import lib/grid;
import role/voxels;

var surfels: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(surfels)) {
        let surfel = surfel_of(vec3u(id.x, id.y % values.grid_size.y, id.y / values.grid_size.y));
        textureStore(surfels, id.xy, vec4f(surfel.albedo, f32(surfel.filled)));
    }
}
