// For tests, module of the role `payload`: counts the fragments of each voxel, of what is still and what moves together.
// Adds to a word per fragment.

import lib/grid;
import lib/piece;
import lib/rows;

struct Surface {
    triangle: u32,
}

const MOST_AT_ONCE: u32 = 1u;

var<storage, read_write> counts: array<atomic<u32>>;

fn surface_of(triangle: u32, corners: array<vec3f, 3>) -> Surface {
    return Surface(triangle);
}

fn add_fragment(surface: Surface, voxel: vec3u) {
    atomicAdd(&counts[voxel_number(voxel)], 1u);
}

fn add_piece(surface: Surface, voxel: vec3u, piece: Piece) {
    add_fragment(surface, voxel);
}

fn add_row(surface: Surface, voxel: vec3u, length: u32) -> u32 {
    add_fragment(surface, voxel);
    return 1u;
}
