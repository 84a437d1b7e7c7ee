// Clears the words of a list: all that a bit was set in. Reads and writes a word for each.

import lib/voxel_list;

var<storage, read_write> list: VoxelList;
var<storage, read_write> bits: array<u32>;

@compute @workgroup_size(LISTED_TOGETHER)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < min(atomicLoad(&list.count), arrayLength(&list.voxels)) {
        bits[list.voxels[id.x]] = 0u;
    }
}
