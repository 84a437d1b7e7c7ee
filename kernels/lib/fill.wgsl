// Marks voxels as filled (lib/filled_words): the still ones, or the moving ones in stages that voxelize what moves.
//
// Reads a word; the first time adds to it, and the first time of its word to another. Most are marked already: looking
// first costs less than adding.

import lib/filled_words;

@if(geometry.moving) var<storage, read_write> moving_filled: array<atomic<u32>>;
@else var<storage, read_write> filled: array<atomic<u32>>;

/// What the word was before.
fn or_word(at: u32, mask: u32) -> u32 {
    @if(geometry.moving) {
        let now = atomicLoad(&moving_filled[at]);
        if (now & mask) == mask {
            return now;
        }
        return atomicOr(&moving_filled[at], mask);
    } @else {
        let now = atomicLoad(&filled[at]);
        if (now & mask) == mask {
            return now;
        }
        return atomicOr(&filled[at], mask);
    }
}

fn length_of_filled() -> u32 {
    @if(geometry.moving) {
        return arrayLength(&moving_filled);
    } @else {
        return arrayLength(&filled);
    }
}

fn mark_filled(number: u32) {
    let word = word_of(number);
    if or_word(summary_words(length_of_filled()) + word, mask_of(number)) == 0u {
        or_word(word_of(word), mask_of(word));
    }
}
