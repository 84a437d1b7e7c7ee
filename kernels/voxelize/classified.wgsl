// Voxelizes the triangles of a list with one thread for each (R figure 4.14).
//
// Reads per triangle a word, 3 corners and what the payload wants; writes per fragment what the payload does.

import lib/columns;
import lib/dispatch;

struct Knobs {
    separability: u32,
}

var<uniform> knobs: Knobs;
var<storage, read> small: array<u32>;
var<storage, read> small_count: array<u32, 1>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let place = linear_index(id, workgroups, 64u);
    if place < small_count[0] {
        fill_all(placed_of(small[place]), knobs.separability);
    }
}
