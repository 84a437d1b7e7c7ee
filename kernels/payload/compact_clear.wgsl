// Frees the slots of all filled voxels (lib/slots), and clears their sums. A thread for each word of the summary
// (lib/filled_words): reads it, a word for each of its bits, and one or two keys of each voxel; writes 44 B of that (56).
//
// Freed keys keep walks that pass them going, so that every voxel is found, in whatever order they are freed; when that
// is done, they are as good as those never taken.

import lib/dispatch;
import lib/filled_words;
import lib/slots;

var<storage, read> filled: array<u32>;
var<storage, read_write> sums: array<atomic<u32>>;

fn free_slot(number: u32, slots: u32) {
    var slot = first_slot(number, slots);
    for (var k = 0u; k < MOST_PROBES; k++) {
        if atomicLoad(&sums[slot]) == key_of(number) {
            atomicStore(&sums[slot], FREED);
            let first = sums_of_slot(slot, slots);
            for (var n = 0u; n < SUM_WORDS; n++) {
                atomicStore(&sums[first + n], 0u);
            }
            return;
        }
        slot = next_slot(slot, k, slots);
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let at = linear_index(id, workgroups, 64u);
    let length = summary_words(arrayLength(&filled));
    if at >= length {
        return;
    }
    let slots = slots_in(arrayLength(&sums));
    var marked = filled[at];
    for (var k = 0u; k < 32u && marked != 0u; k++) {
        let word = 32u * at + take_bit(&marked);
        var bits = filled[length + word];
        for (var i = 0u; i < 32u && bits != 0u; i++) {
            free_slot(32u * word + take_bit(&bits), slots);
        }
    }
}
