// Clears what a buffer holds of the filled voxels: as many words for each voxel of the grid as it has room for. A thread
// for each word of the summary (lib/filled_words): reads it, and a word for each of its bits; writes those of each voxel.

import lib/dispatch;
import lib/filled_words;
import lib/grid;

var<storage, read> filled: array<u32>;
var<storage, read_write> words: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let at = linear_index(id, workgroups, 64u);
    let length = summary_words(arrayLength(&filled));
    if at >= length {
        return;
    }
    let of_a_voxel = arrayLength(&words) / (values.grid_size.x * values.grid_size.y * values.grid_size.z);
    var marked = filled[at];
    for (var k = 0u; k < 32u && marked != 0u; k++) {
        let word = 32u * at + take_bit(&marked);
        var bits = filled[length + word];
        for (var i = 0u; i < 32u && bits != 0u; i++) {
            let first = (32u * word + take_bit(&bits)) * of_a_voxel;
            for (var n = 0u; n < of_a_voxel; n++) {
                words[first + n] = 0u;
            }
        }
    }
}
