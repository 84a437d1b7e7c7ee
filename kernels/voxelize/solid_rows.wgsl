// Fills what lies inside: along a row of voxels, all from an odd crossing (voxelize/solid_crossings) to the next.
//
// A thread for each row reads its words; writes what the payload does for each that has an inside.

import lib/dispatch;
import lib/grid;
import role/payload;

var<storage, read> crossings: array<u32>;

/// Each bit becomes the parity of itself and all lower ones.
fn parities(crossed: u32) -> u32 {
    var bits = crossed;
    bits ^= bits << 1u;
    bits ^= bits << 2u;
    bits ^= bits << 4u;
    bits ^= bits << 8u;
    return bits ^ (bits << 16u);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let row = linear_index(id, workgroups, 64u);
    let size = values.grid_size;
    if row >= size.y * size.z {
        return;
    }
    let words = (size.x + 31u) / 32u;
    var inside = 0u;
    for (var k = 0u; k < words; k++) {
        var bits = parities(crossings[row * words + k]) ^ inside;
        inside = select(0u, 0xffffffffu, (bits >> 31u) != 0u);
        let left = size.x - 32u * k;
        if left < 32u {
            bits &= (1u << left) - 1u;
        }
        mark_along(vec3u(32u * k, row % size.y, row / size.y), bits);
    }
}
