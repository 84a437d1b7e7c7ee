// Marks voxels as filled (lib/filled_words). The payload that imports this declares `filled`, array<atomic<u32>>.
//
// Reads a word; the first time adds to it, and the first time of its word to another. Most are marked already: looking
// first costs less than adding.

import lib/filled_words;

/// What the word was before.
fn or_word(at: u32, mask: u32) -> u32 {
    let now = atomicLoad(&filled[at]);
    if (now & mask) == mask {
        return now;
    }
    return atomicOr(&filled[at], mask);
}

fn mark_word(word: u32, mask: u32) {
    if mask != 0u && or_word(summary_words(arrayLength(&filled)) + word, mask) == 0u {
        or_word(word_of(word), mask_of(word));
    }
}

fn mark_bit(bit: u32) {
    mark_word(word_of(bit), mask_of(bit));
}
