// Module of the role `payload`: the sums of `payload/sums`, kept for filled voxels only, in a table (lib/slots).
//
// Voxels that find no room are marked as filled, and that is all that is known of them; their fragments are counted.
// Reads as lib/surface, and one or two keys; writes per fragment 10 atomic words (13), and a voxel's key once.

import lib/fill;
import lib/grid;
import lib/slots;
import lib/sum_add;
import lib/voxel_by_voxel;

var<storage, read_write> filled: array<atomic<u32>>;
var<storage, read_write> sums: array<atomic<u32>>;

struct Counters {
    fragments_without_room: atomic<u32>,
}

var<storage, read_write> counters: Counters;

/// More than there are probes: a weak exchange may fail without a cause.
const MOST_TRIES: u32 = 1024u;

/// The voxel's slot, which is taken now if it was not before; or NO_SLOT.
fn take_slot(number: u32, slots: u32) -> u32 {
    let key = key_of(number);
    var slot = first_slot(number, slots);
    var k = 0u;
    for (var i = 0u; i < MOST_TRIES && k < MOST_PROBES; i++) {
        var found = atomicLoad(&sums[slot]);
        if found < FIRST_KEY {
            let exchange = atomicCompareExchangeWeak(&sums[slot], found, key);
            found = select(exchange.old_value, key, exchange.exchanged);
        }
        if found == key {
            return slot;
        }
        // An exchange can fail though the slot is still free: then again.
        if found >= FIRST_KEY {
            slot = next_slot(slot, k, slots);
            k++;
        }
    }
    return NO_SLOT;
}

fn add_piece(surface: Surface, voxel: vec3u, piece: Piece) {
    let fragment = fragment_of(surface, voxel, piece);
    if fragment.hole {
        return;
    }
    let number = voxel_number(voxel);
    let slots = slots_in(arrayLength(&sums));
    let slot = take_slot(number, slots);
    if slot == NO_SLOT {
        mark_filled(number);
        atomicAdd(&counters.fragments_without_room, 1u);
    } else if add_to_sums(sums_of_slot(slot, slots), fragment, piece.area) == 0u {
        mark_filled(number);
    }
}
