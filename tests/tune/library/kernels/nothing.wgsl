// Starts the numbers of the first threads.

var<storage, read_write> result: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    result[id.x] = id.x;
}
