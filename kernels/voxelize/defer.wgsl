// Voxelizes small triangles, with a thread for each, and lists the large ones (R figure 4.15).
//
// Reads per triangle 3 corners and what the payload wants; writes per fragment what the payload does, and per large
// triangle a word.

import lib/cutoff;
import lib/dispatch;
import lib/draw_large;
import lib/geometry;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let triangle = linear_index(id, workgroups, 64u);
    if triangle < geometry.triangles {
        let placed = placed_of(geometry.first + triangle);
        if placed.meets && is_large(placed) {
            draw_large(placed.triangle);
        } else if placed.meets {
            fill_all(placed, knobs.separability);
        }
    }
}
