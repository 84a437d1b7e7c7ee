// Clears the sums of the voxels that moving triangles came into the time before.
//
// Reads a word for each voxel of the list, writes 10 (13). The stage is dispatched by `voxelize/listed`.

import lib/dispatch;
import lib/sum_words;
import lib/touched;

var<storage, read_write> touched: Touched;
var<storage, read_write> sums: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let place = linear_index(id, workgroups, 64u);
    if place < touched.stale {
        let first = touched.voxels[place] * SUM_WORDS;
        for (var i = 0u; i < SUM_WORDS; i++) {
            sums[first + i] = 0u;
        }
    }
}
