// Whether a voxel is filled (lib/filled_words). Reads a word, two where something moves.

import lib/filled_words;
import lib/grid;

var<storage, read> filled: array<u32>;
/// The same of what moves.
@if(scene.moving)
var<storage, read> moving_filled: array<u32>;

/// The 32 voxels from number 32 · `word`.
fn filled_word(word: u32) -> u32 {
    let at = summary_words(arrayLength(&filled)) + word;
    @if(scene.moving) {
        return filled[at] | moving_filled[at];
    } @else {
        return filled[at];
    }
}

/// Whether any fragment lies in the voxel; none does outside the grid.
fn is_filled(voxel: vec3u) -> bool {
    if any(voxel >= values.grid_size) {
        return false;
    }
    let number = voxel_number(voxel);
    return (filled_word(word_of(number)) & mask_of(number)) != 0u;
}
