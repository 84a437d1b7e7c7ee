// Module of the role `payload`: voxels are filled or not, and no more. Costs as lib/mark.

import lib/fill;
import lib/no_attributes;

var<storage, read_write> filled: array<atomic<u32>>;

/// Of `length` voxels along x, from `voxel` on, as many as one word has; returns how many.
fn add_row(surface: Surface, voxel: vec3u, length: u32) -> u32 {
    return mark_row(bit_of(voxel), length);
}
