// Module behind `role/voxels` of the payload `bits`. Reads a word, two where something moves.

import lib/grid;

var<storage, read> bits: array<u32>;
/// The same of what moves.
@if(scene.moving)
var<storage, read> moving_bits: array<u32>;

fn bit_word(at: u32) -> u32 {
    @if(scene.moving) {
        return bits[at] | moving_bits[at];
    } @else {
        return bits[at];
    }
}

/// Whether any fragment lies in the voxel; none does outside the grid.
fn is_filled(voxel: vec3u) -> bool {
    return fragment_count(voxel) > 0u;
}

/// 1 if any lies there: they are not counted.
fn fragment_count(voxel: vec3u) -> u32 {
    if any(voxel >= values.grid_size) {
        return 0u;
    }
    let number = voxel_number(voxel);
    return (bit_word(number / 32u) >> (number % 32u)) & 1u;
}
