// What payloads do that note of voxels only whether they are filled: the module that imports this brings the order of
// the bits (lib/rows, lib/slices) and lib/mark.

import lib/piece;

/// Voxels that `add_row` adds together.
const MOST_AT_ONCE: u32 = 32u;

/// Nothing more is known of a triangle.
struct Surface {
    triangle: u32,
}

fn surface_of(triangle: u32, corners: array<vec3f, 3>) -> Surface {
    return Surface(triangle);
}

fn add_piece(surface: Surface, voxel: vec3u, piece: Piece) {
    add_fragment(surface, voxel);
}

fn add_fragment(surface: Surface, voxel: vec3u) {
    mark_bit(bit_of(voxel));
}

/// Of `length` voxels along `BIT_AXIS`, from `voxel` on, as many as one word has; returns how many.
fn add_row(surface: Surface, voxel: vec3u, length: u32) -> u32 {
    return mark_row(bit_of(voxel), length);
}
