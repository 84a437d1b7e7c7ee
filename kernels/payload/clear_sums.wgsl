// Clears the sums of all filled voxels. A thread for each word of the summary: reads it, a word for each of its bits, and
// writes 10 (13) for each bit of those.

import lib/dispatch;
import lib/filled_words;
import lib/sum_words;

var<storage, read> filled: array<u32>;
var<storage, read_write> sums: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let at = linear_index(id, workgroups, 64u);
    let length = summary_words(arrayLength(&filled));
    if at >= length {
        return;
    }
    var words = filled[at];
    for (var k = 0u; k < 32u && words != 0u; k++) {
        let word = 32u * at + take_bit(&words);
        var bits = filled[length + word];
        for (var i = 0u; i < 32u && bits != 0u; i++) {
            let first = (32u * word + take_bit(&bits)) * SUM_WORDS;
            for (var n = 0u; n < SUM_WORDS; n++) {
                sums[first + n] = 0u;
            }
        }
    }
}
