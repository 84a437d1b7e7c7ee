// Clears the bits of all filled voxels, and the summary. A thread for each word of the summary: reads it, writes a word
// for each of its bits.

import lib/dispatch;
import lib/filled_words;

var<storage, read_write> filled: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let at = linear_index(id, workgroups, 64u);
    let length = summary_words(arrayLength(&filled));
    if at < length {
        var words = filled[at];
        for (var k = 0u; k < 32u && words != 0u; k++) {
            filled[length + 32u * at + take_bit(&words)] = 0u;
        }
        filled[at] = 0u;
    }
}
