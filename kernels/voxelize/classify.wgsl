// Sorts triangles into small and large ones before any is voxelized (R figure 4.14). Those outside the grid go nowhere.
//
// Reads per triangle 3 corners; writes a word, and adds to one.

import lib/cutoff;
import lib/dispatch;
import lib/draw_large;
import lib/geometry;
import lib/groups;

/// Numbers of triangles; there is room for all.
var<storage, read_write> small: array<u32>;
var<storage, read_write> small_count: array<atomic<u32>, 1>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let triangle = linear_index(id, workgroups, 64u);
    if triangle < geometry.triangles {
        let placed = placed_of(geometry.first + triangle);
        if placed.meets && is_large(placed) {
            draw_large(placed.triangle);
        } else if placed.meets {
            let place = atomicAdd(&small_count[0], 1u);
            small[place] = placed.triangle;
            if place % 64u == 0u {
                grow_groups(place / 64u);
            }
        }
    }
}
