// Module of the role `payload`: running averages of albedo, normal and emission in bytes, by compare and exchange, as
// R B.1 has them, with two corrections: results are rounded (cut, the mean of 100 fragments is 0.1 too dark), and the
// 255th fragment is the last (the count of 8 bits would begin anew).
//
// The result depends on the order of the threads: each step is rounded. lib/packed_words says where what lies; the
// fourth byte counts.
// Reads as lib/surface; writes per fragment 2 words (3), more where threads meet.

import lib/fill;
import lib/grid;
import lib/packed_words;
import lib/voxel_by_voxel;

var<storage, read_write> filled: array<atomic<u32>>;
var<storage, read_write> packed: array<atomic<u32>>;
@if(scene.emissive)
var<storage, read_write> packed_emission: array<atomic<u32>>;

const MOST_AVERAGED: u32 = 255u;
/// Each try that fails is one of another thread's that did not.
const MOST_TRIES: u32 = 4096u;

/// The average with one value more, bytes.
fn average_with(word: u32, value: vec3u) -> u32 {
    let before = unpacked_bytes(word);
    let count = before.w + 1u;
    let sum = before.xyz * before.w + value;
    return packed_bytes((sum + count / 2u) / count, count);
}

fn average_packed(at: u32, value: vec3u) {
    var known = atomicLoad(&packed[at]);
    for (var k = 0u; k < MOST_TRIES && (known >> 24u) < MOST_AVERAGED; k++) {
        let found = atomicCompareExchangeWeak(&packed[at], known, average_with(known, value));
        if found.exchanged {
            break;
        }
        known = found.old_value;
    }
}

@if(scene.emissive)
fn average_emission(at: u32, value: vec3u) {
    var known = atomicLoad(&packed_emission[at]);
    for (var k = 0u; k < MOST_TRIES && (known >> 24u) < MOST_AVERAGED; k++) {
        let found = atomicCompareExchangeWeak(&packed_emission[at], known, average_with(known, value));
        if found.exchanged {
            break;
        }
        known = found.old_value;
    }
}

fn add_piece(surface: Surface, voxel: vec3u, piece: Piece) {
    let fragment = fragment_of(surface, voxel, piece);
    if fragment.hole {
        return;
    }
    let number = voxel_number(voxel);
    mark_filled(number);
    average_packed(number * PACKED_WORDS + PACKED_ALBEDO, bytes_of(fragment.albedo));
    average_packed(number * PACKED_WORDS + PACKED_NORMAL, bytes_of(normal_to_unit(fragment.normal)));
    @if(scene.emissive) {
        average_emission(number, bytes_of(fragment.emission));
    }
}
