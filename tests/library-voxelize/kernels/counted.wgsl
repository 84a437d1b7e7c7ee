// For tests: how often a voxelizer gave each voxel to the payload `payload/count`, in the places of `occupancy`.
// Reads a voxel, writes a texel.

import lib/grid;

var<storage, read> counts: array<u32>;
var occupancy: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(occupancy)) {
        let voxel = vec3u(id.x, id.y % values.grid_size.y, id.y / values.grid_size.y);
        textureStore(occupancy, id.xy, vec4f(f32(counts[voxel_number(voxel)]), 0.0, 0.0, 1.0));
    }
}
