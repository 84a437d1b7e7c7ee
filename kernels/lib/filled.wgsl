// The filled voxels among the 64 of a workgroup (4³), listed side by side: threads with work then stand next to each
// other and whole subgroups without any end at once. Surfaces fill about a tenth of the voxels around them.
//
// The order of the list depends on the threads; what is computed for a voxel does not.

const BLOCK: u32 = 4u;

var<workgroup> filled_voxels: array<u32, 64>;
var<workgroup> filled_total: atomic<u32>;

/// Lists the calling thread's voxel if it is `filled`, and says how many are listed. All threads of the workgroup must
/// come here.
fn list_filled(filled: bool, local: u32) -> u32 {
    if filled {
        filled_voxels[atomicAdd(&filled_total, 1u)] = local;
    }
    workgroupBarrier();
    return atomicLoad(&filled_total);
}

/// The voxel at this place of the list, for the workgroup `group`.
fn filled_voxel(place: u32, group: vec3u) -> vec3u {
    let local = filled_voxels[place];
    return group * BLOCK + vec3u(local, local / BLOCK, local / (BLOCK * BLOCK)) % BLOCK;
}
