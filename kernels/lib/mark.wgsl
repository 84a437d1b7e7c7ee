// Marks voxels as filled (lib/filled_words). The payload that imports this declares `filled`, array<atomic<u32>>.
//
// Adds to a word, and the first time of it to another. A look before, whether the bits are there, costs what it saves.

import lib/filled_words;

fn mark_word(word: u32, mask: u32) {
    if mask != 0u && atomicOr(&filled[summary_words(arrayLength(&filled)) + word], mask) == 0u {
        atomicOr(&filled[word_of(word)], mask_of(word));
    }
}

fn mark_bit(bit: u32) {
    mark_word(word_of(bit), mask_of(bit));
}

/// Up to `length` bits from the first on; returns how many: those in the first word.
fn mark_row(first: u32, length: u32) -> u32 {
    let begin = first % 32u;
    let count = min(32u - begin, length);
    mark_word(word_of(first), (0xffffffffu >> (32u - count)) << begin);
    return count;
}
