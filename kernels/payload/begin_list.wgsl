// Begins a list of voxels (lib/voxel_list) anew. A single thread; writes 4 words.

import lib/voxel_list;

var<storage, read_write> list: VoxelList;
var<storage, read_write> groups: array<u32>;

@compute @workgroup_size(1)
fn main() {
    atomicStore(&list.count, 0u);
    groups[0] = 0u;
    groups[1] = 1u;
    groups[2] = 1u;
}
