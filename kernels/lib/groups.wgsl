// Workgroups of an indirect dispatch, along x, y, z, that grow with what they are to go through; folded into y where x
// takes no more, as lib/dispatch unfolds them.

/// Zero at first.
var<storage, read_write> groups: array<atomic<u32>>;

/// The guaranteed number of workgroups in one dimension.
const MOST_GROUPS: u32 = 65535u;

/// There are to be workgroups 0 to `last`; each number must come once.
fn grow_groups(last: u32) {
    atomicMax(&groups[0], min(last + 1u, MOST_GROUPS));
    if last % MOST_GROUPS == 0u {
        atomicAdd(&groups[1], 1u);
    }
    if last == 0u {
        atomicStore(&groups[2], 1u);
    }
}
