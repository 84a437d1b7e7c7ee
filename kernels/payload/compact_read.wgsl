// Module behind `role/voxels` of the payload `compact`: a voxel's sums are found by its key (lib/slots, lib/sum_read). A
// filled voxel that found no room has no fragments and no surfel; that it is filled is known.
//
// Reads of a filled voxel 40 B and one or two keys; where something moves, twice as many.

import lib/slots;
import lib/sum_read;

var<storage, read> sums: array<u32>;
/// The same of what moves.
@if(scene.moving)
var<storage, read> moving_sums: array<u32>;

/// Where a voxel's sums begin, or NO_SLOT.
struct Place {
    still: u32,
    @if(scene.moving) moving: u32,
}

fn still_sums_of(number: u32) -> u32 {
    let slots = slots_in(arrayLength(&sums));
    var slot = first_slot(number, slots);
    for (var k = 0u; k < MOST_PROBES; k++) {
        let key = sums[slot];
        if key == key_of(number) {
            return sums_of_slot(slot, slots);
        }
        if key < FIRST_KEY {
            break;
        }
        slot = next_slot(slot, k, slots);
    }
    return NO_SLOT;
}

@if(scene.moving)
fn moving_sums_of(number: u32) -> u32 {
    let slots = slots_in(arrayLength(&moving_sums));
    var slot = first_slot(number, slots);
    for (var k = 0u; k < MOST_PROBES; k++) {
        let key = moving_sums[slot];
        if key == key_of(number) {
            return sums_of_slot(slot, slots);
        }
        if key < FIRST_KEY {
            break;
        }
        slot = next_slot(slot, k, slots);
    }
    return NO_SLOT;
}

fn place_of(number: u32) -> Place {
    @if(scene.moving) {
        return Place(still_sums_of(number), moving_sums_of(number));
    } @else {
        return Place(still_sums_of(number));
    }
}

fn still_sum_at(place: Place, word: u32) -> u32 {
    if place.still == NO_SLOT {
        return 0u;
    }
    return sums[place.still + word];
}

@if(scene.moving)
fn moving_sum_at(place: Place, word: u32) -> u32 {
    if place.moving == NO_SLOT {
        return 0u;
    }
    return moving_sums[place.moving + word];
}

fn sum_at(place: Place, word: u32) -> u32 {
    @if(scene.moving) {
        return still_sum_at(place, word) + moving_sum_at(place, word);
    } @else {
        return still_sum_at(place, word);
    }
}
