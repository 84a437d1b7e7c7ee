// Module of the role `payload`: voxels are filled or not, and no more. Costs as lib/fill.

import lib/fill;
import lib/grid;

var<storage, read_write> filled: array<atomic<u32>>;

/// Nothing more is known of a triangle.
struct Surface {
    triangle: u32,
}

fn surface_of(triangle: u32, corners: array<vec3f, 3>) -> Surface {
    return Surface(triangle);
}

fn add_fragment(surface: Surface, voxel: vec3u) {
    mark_filled(voxel_number(voxel));
}

/// Of `length` voxels along x, from `voxel` on, as many as one word has; returns how many.
fn add_row(surface: Surface, voxel: vec3u, length: u32) -> u32 {
    return mark_row(voxel_number(voxel), length);
}
