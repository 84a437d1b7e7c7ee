// Whether a voxel is filled (lib/filled_words). The module that imports this says in `bit_of(voxel)` in which order bits
// are kept. Reads a word, two where something moves.

import lib/filled_words;
import lib/grid;

var<storage, read> filled: array<u32>;
/// The same of what moves.
@if(scene.moving)
var<storage, read> moving_filled: array<u32>;

/// Word `at` of what is still and what moves together.
fn filled_at(at: u32) -> u32 {
    @if(scene.moving) {
        return filled[at] | moving_filled[at];
    } @else {
        return filled[at];
    }
}

/// The 32 voxels from bit 32 · `word`.
fn filled_word(word: u32) -> u32 {
    return filled_at(summary_words(arrayLength(&filled)) + word);
}

/// Whether any fragment lies in the voxel; none does outside the grid.
fn is_filled(voxel: vec3u) -> bool {
    if any(voxel >= values.grid_size) {
        return false;
    }
    let bit = bit_of(voxel);
    return (filled_word(word_of(bit)) & mask_of(bit)) != 0u;
}
