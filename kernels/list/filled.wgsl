// Lists the filled voxels, each once, by number, and grows with the list an indirect dispatch of 64 threads a workgroup,
// and a draw of a cube for each (R 4.1.4). Which come first depends on the threads; what goes through the list must not.
// Voxels that the list has no room for are counted, and left out.
//
// A thread for each word of the summary (lib/filled_words) reads it and a word for each of its bits; writes a word for
// each voxel, and adds to the count once.

import lib/dispatch;
import lib/groups;
import role/voxels;

var<storage, read_write> voxel_list: array<u32>;
/// Of all filled voxels, listed or not.
var<storage, read_write> voxel_count: array<atomic<u32>, 1>;
/// Vertices, instances, and the first of each.
var<storage, read_write> voxel_draw: array<atomic<u32>>;

/// Two triangles for each side.
const VERTICES_OF_A_CUBE: u32 = 36u;

struct Counters {
    filled_voxels: atomic<u32>,
    unlisted_voxels: atomic<u32>,
}

var<storage, read_write> counters: Counters;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let at = linear_index(id, workgroups, 64u);
    if at >= summary_words(arrayLength(&filled)) {
        return;
    }
    var marked = filled_at(at);
    var count = 0u;
    for (var k = 0u; k < 32u && marked != 0u; k++) {
        count += countOneBits(filled_word(32u * at + take_bit(&marked)));
    }
    if count == 0u {
        return;
    }
    var place = atomicAdd(&voxel_count[0], count);
    atomicAdd(&counters.filled_voxels, count);
    // Where those that find room end.
    let end = min(place + count, arrayLength(&voxel_list));
    if end < place + count {
        atomicAdd(&counters.unlisted_voxels, place + count - max(place, end));
    }
    if end <= place {
        return;
    }
    atomicAdd(&voxel_draw[0], VERTICES_OF_A_CUBE * (end - place));
    atomicStore(&voxel_draw[1], 1u);
    // The workgroups whose first voxel is one of these.
    for (var first = (place + 63u) / 64u * 64u; first < end; first += 64u) {
        grow_groups(first / 64u);
    }
    marked = filled_at(at);
    for (var k = 0u; k < 32u && marked != 0u; k++) {
        let word = 32u * at + take_bit(&marked);
        var bits = filled_word(word);
        for (var i = 0u; i < 32u && bits != 0u && place < end; i++) {
            voxel_list[place] = number_of(32u * word + take_bit(&bits));
            place++;
        }
    }
}
