// Closes the list of touched voxels: it is now what is to be cleared next time, by as many workgroups as that takes.
//
// A single thread; reads 1 word, writes 5.

import lib/touched;

/// Threads of a workgroup of `voxelize/clear`.
const CLEARED_TOGETHER: u32 = 64u;
/// The guaranteed number of workgroups in one dimension.
const MOST_GROUPS: u32 = 65535u;

var<storage, read_write> touched: Touched;
/// Workgroups along x, y, z.
var<storage, read_write> clearing: array<u32>;

@compute @workgroup_size(1)
fn main() {
    let count = min(atomicLoad(&touched.listed), arrayLength(&touched.voxels));
    let groups = (count + CLEARED_TOGETHER - 1u) / CLEARED_TOGETHER;
    let rows = max((groups + MOST_GROUPS - 1u) / MOST_GROUPS, 1u);
    touched.stale = count;
    atomicStore(&touched.listed, 0u);
    clearing[0] = (groups + rows - 1u) / rows;
    clearing[1] = rows;
    clearing[2] = 1u;
}
