// A table of the voxels that hold sums, by their numbers: open addressing (Knuth 1973, 6.4), after voxel hashing (Nießner
// et al. 2013). The keys of all slots come first, then the sums of each (lib/sum_words). Who comes first takes the first
// free slot on the voxel's own walk through the table, and all others find it there: keys appear only while sums are
// added to, and vanish only while they are cleared. So a voxel has one slot, or, where all that its walk passes are taken,
// none: never a part of its sums.
//
// Which slot that is depends on the threads; what it holds does not. Walks begin side by side for eight voxels in a row,
// since surfaces fill neighbours, and get longer steps as they go (quadratic probing), up to MOST_PROBES.

import lib/random;
import lib/sum_words;

/// In place of a slot.
const NO_SLOT: u32 = 0xffffffffu;
const MOST_PROBES: u32 = 128u;

/// Keys: 0 was never taken; this was taken in an earlier frame, and is free again.
const FREED: u32 = 1u;
/// That of voxel 0; what is below is free.
const FIRST_KEY: u32 = 2u;

fn key_of(number: u32) -> u32 {
    return FIRST_KEY + number;
}

/// Slots of a table of `words`.
fn slots_in(words: u32) -> u32 {
    return words / (SUM_WORDS + 1u);
}

/// Where a slot's sums begin.
fn sums_of_slot(slot: u32, slots: u32) -> u32 {
    return slots + slot * SUM_WORDS;
}

/// Where a voxel's walk begins. The eight of a row are mixed too: of a wall across them all have the same place.
fn first_slot(number: u32, slots: u32) -> u32 {
    let row = hash(number / 8u);
    return 8u * product(row, slots / 8u).y + ((number ^ row) & 7u);
}

/// The slot that comes next, as step `k` from 0.
fn next_slot(slot: u32, k: u32, slots: u32) -> u32 {
    let next = slot + k + 1u;
    if next >= slots {
        return next % slots;
    }
    return next;
}
