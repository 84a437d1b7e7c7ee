// Module behind `role/voxels` of the payload `sums`: a voxel's sums are found by its number (lib/sum_read).
//
// Reads 4 B for an empty voxel, 40 B for a filled one; where something moves, twice as many.

import lib/sum_read;

var<storage, read> sums: array<u32>;
/// The same of what moves.
@if(scene.moving)
var<storage, read> moving_sums: array<u32>;

/// Word 0 of a voxel's sums, in both buffers.
alias Place = u32;

fn place_of(number: u32) -> Place {
    return number * SUM_WORDS;
}

fn sum_at(place: Place, word: u32) -> u32 {
    @if(scene.moving) {
        return sums[place + word] + moving_sums[place + word];
    } @else {
        return sums[place + word];
    }
}
