// Clears the sums of the voxels of a list: all that were filled.
//
// Reads a word for each voxel of the list, writes 10 (13).

import lib/sum_words;
import lib/voxel_list;

var<storage, read_write> list: VoxelList;
var<storage, read_write> sums: array<u32>;

@compute @workgroup_size(LISTED_TOGETHER)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < min(atomicLoad(&list.count), arrayLength(&list.voxels)) {
        let first = list.voxels[id.x] * SUM_WORDS;
        for (var i = 0u; i < SUM_WORDS; i++) {
            sums[first + i] = 0u;
        }
    }
}
