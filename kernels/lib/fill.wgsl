// Marks voxels as filled (lib/filled_words). The payload that imports this declares `filled`, array<atomic<u32>>.
//
// Adds to a word, and the first time of it to another. A look before, whether the bits are there, costs what it saves.

import lib/filled_words;

fn mark_word(word: u32, mask: u32) {
    if mask != 0u && atomicOr(&filled[summary_words(arrayLength(&filled)) + word], mask) == 0u {
        atomicOr(&filled[word_of(word)], mask_of(word));
    }
}

fn mark_filled(number: u32) {
    mark_word(word_of(number), mask_of(number));
}

/// Voxel `first` and those behind it, by the bits from the lowest.
fn mark_filled_from(first: u32, bits: u32) {
    let shift = first % 32u;
    mark_word(word_of(first), bits << shift);
    if shift > 0u {
        mark_word(word_of(first) + 1u, bits >> (32u - shift));
    }
}

/// Up to `length` voxels by number; returns how many: those in the first one's word.
fn mark_row(first: u32, length: u32) -> u32 {
    let begin = first % 32u;
    let count = min(32u - begin, length);
    mark_word(word_of(first), (0xffffffffu >> (32u - count)) << begin);
    return count;
}
