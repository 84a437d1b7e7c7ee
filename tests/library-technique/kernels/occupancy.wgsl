// For tests: the number of fragments in each voxel, word 0 of its sums. Voxel (x, y, z) is pixel
// (x, y + z · resolution).
// Reads 4 B, writes a texel.

import lib/sum_words;

var<storage, read> sums: array<u32>;
var occupancy: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(occupancy);
    if any(id.xy >= size) {
        return;
    }
    let voxel = id.y * size.x + id.x;
    textureStore(occupancy, id.xy, vec4f(f32(sums[voxel * SUM_WORDS]), 0.0, 0.0, 1.0));
}
