// Three times each element's index, and one. Workgroups of a single thread, so that there are many.

import lib/dispatch;

var<storage, read_write> numbers: array<u32>;

@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let i = linear_index(id, groups, 1u);
    if i < arrayLength(&numbers) {
        numbers[i] = 3u * i + 1u;
    }
}
