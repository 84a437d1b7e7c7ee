// For tests: how often each voxel is in the list of filled ones. A thread for each place of the list.
// Reads two words, adds to one.

import lib/dispatch;
import lib/grid;
import lib/listed;

var<storage, read_write> times: array<atomic<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let place = linear_index(id, workgroups, 64u);
    if place < listed_voxels() {
        atomicAdd(&times[voxel_number(listed_voxel(place))], 1u);
    }
}
