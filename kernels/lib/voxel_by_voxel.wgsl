// For payloads that keep attributes of each fragment (one triangle in one voxel). The payload that imports this declares `add_piece`.

import lib/piece;
import lib/surface;

/// Voxels that `add_row` adds together.
const MOST_AT_ONCE: u32 = 1u;

/// All of a triangle that lies in a voxel.
fn add_fragment(surface: Surface, voxel: vec3u) {
    add_piece(surface, voxel, piece_of(surface.corners, vec3f(voxel)));
}

/// Of `length` voxels along `BIT_AXIS`, from `voxel` on, the first; returns how many that is.
fn add_row(surface: Surface, voxel: vec3u, length: u32) -> u32 {
    add_fragment(surface, voxel);
    return 1u;
}
