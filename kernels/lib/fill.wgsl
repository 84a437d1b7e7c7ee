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

/// Up to `length` voxels by number; returns how many: those in the first one's word.
fn mark_row(first: u32, length: u32) -> u32 {
    let begin = first % 32u;
    let count = min(32u - begin, length);
    mark_word(word_of(first), (0xffffffffu >> (32u - count)) << begin);
    return count;
}
