// Counts its threads, and the even ones.

struct Counters {
    evens: atomic<u32>,
    all: atomic<u32>,
}

var<storage, read_write> counters: Counters;
var<storage, read_write> sink: array<u32>;

@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    sink[id.x] = id.x;
    atomicAdd(&counters.all, 1u);
    if id.x % 2u == 0u {
        atomicAdd(&counters.evens, 1u);
    }
}
