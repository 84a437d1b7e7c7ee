// Voxelizes with one thread for each triangle: it goes through all columns of its triangle (R 4.1.1).
//
// Reads per triangle 3 corners and what the payload wants; writes per fragment what the payload does. Nothing shares the
// work of a large triangle (R figure 4.6), but it grows with its columns, not with its voxels (lib/overlap).

import lib/columns;
import lib/dispatch;
import lib/geometry;

struct Knobs {
    separability: u32,
}

var<uniform> knobs: Knobs;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let triangle = linear_index(id, workgroups, 64u);
    if triangle < geometry.triangles {
        let placed = placed_of(geometry.first + triangle);
        if placed.meets {
            fill_all(placed, knobs.separability);
        }
    }
}
