// Marks voxels as filled, in order of their numbers. Costs as lib/mark.

import lib/mark;
import lib/rows;

fn mark_filled(number: u32) {
    mark_bit(number);
}

/// Voxel `first` and those behind it along x, by the bits from the lowest.
fn mark_along(first: vec3u, bits: u32) {
    let bit = bit_of(first);
    let shift = bit % 32u;
    mark_word(word_of(bit), bits << shift);
    if shift > 0u {
        mark_word(word_of(bit) + 1u, bits >> (32u - shift));
    }
}
