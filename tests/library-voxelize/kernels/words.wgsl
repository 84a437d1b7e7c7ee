// For tests: every word of the sums, of what is still and what moves together. Word i of voxel (x, y, z) is pixel
// (SUM_WORDS · x + i, y + z · the grid's size along y).
// Reads a word, two where something moves; writes a texel.

import lib/grid;
import lib/sum_words;
import role/voxels;

var words: texture_storage_2d<r32uint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(words)) {
        let voxel = vec3u(id.x / SUM_WORDS, id.y % values.grid_size.y, id.y / values.grid_size.y);
        let word = sum_at(place_of(voxel_number(voxel)), id.x % SUM_WORDS);
        textureStore(words, id.xy, vec4u(word, 0u, 0u, 0u));
    }
}
