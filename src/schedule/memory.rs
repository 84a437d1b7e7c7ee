//! Which items are retained, and what memory each gets.

use std::collections::BTreeMap;

use super::packing::{self, Block};
use super::reruns::Reruns;
use super::uses::Uses;
use super::{FRAME, Life, Memory, Place, Placement, Pool, Start, Work};

/// # Errors
/// If offsets could go beyond 2⁶⁴ bytes. The passes after this add sizes without looking.
pub(super) fn check_sizes(work: &Work) -> Result<(), String> {
    let all = work.items.iter().try_fold(0_u64, |sum, item| {
        let alignment = if let Pool::Heap { alignment, .. } = item.pool { alignment } else { 0 };
        sum.checked_add(item.bytes)?.checked_add(alignment)
    });
    all.map(|_| ()).ok_or_else(|| "the sizes of all items add up to more than 2^64 bytes".to_owned())
}

/// By item, whether its content must survive from frame to frame: what is kept by itself, and each item with a cell
/// that is not done again, start and all, in each frame in which a task or the caller reads it.
pub(super) fn retained(work: &Work, uses: &Uses, reruns: &Reruns) -> Vec<bool> {
    let kept = |item: &super::Item| matches!(item.start, Start::Kept | Start::Steady);
    let mut retained: Vec<bool> = work.items.iter().map(kept).collect();
    for (index, cell) in uses.cells.iter().enumerate() {
        let bits = &reruns.cells[index];
        let outlives = uses.of_cell[index].iter().any(|each| reruns.tasks[each.task] != *bits);
        let shown = uses.is_output[index] && !bits.contains(&FRAME);
        retained[cell.item] |= (outlives || shown) && work.items[cell.item].start != Start::Given;
    }
    retained
}

/// By item its place, and what all take.
pub(super) fn place(
    work: &Work,
    lives: &[Option<Life>],
    retained: &[bool],
    reuse: bool,
) -> (Vec<Place>, Memory) {
    let mut places: Vec<Place> = Vec::with_capacity(work.items.len());
    let mut memory = Memory::default();
    let mut heaps: BTreeMap<u32, Vec<(usize, Block)>> = BTreeMap::new();
    let mut pools: BTreeMap<u32, Vec<(usize, Block)>> = BTreeMap::new();
    for (index, item) in work.items.iter().enumerate() {
        let placement = match (item.start, lives[index]) {
            (Start::Given, _) => Placement::Given,
            (_, None) => Placement::Unmade,
            (_, Some(life)) => {
                let block = |alignment| Block { bytes: item.bytes, alignment, life };
                match item.pool {
                    _ if retained[index] => memory.kept_bytes += item.bytes,
                    Pool::Heap { heap, alignment } if reuse => {
                        heaps.entry(heap).or_default().push((index, block(alignment)));
                    }
                    Pool::Alike(pool) if reuse => pools.entry(pool).or_default().push((index, block(1))),
                    _ => {
                        memory.peak_bytes += item.bytes;
                        memory.lower_bound_bytes += item.bytes;
                    }
                }
                if !retained[index] {
                    memory.without_reuse_bytes += item.bytes;
                }
                Placement::Alone
            }
        };
        places.push(Place { bytes: item.bytes, placement, life: lives[index], retained: retained[index] });
    }

    for (heap, members) in heaps {
        let (items, blocks): (Vec<usize>, Vec<Block>) = members.into_iter().unzip();
        let (offsets, size) = packing::pack(&blocks);
        for (item, offset) in items.into_iter().zip(offsets) {
            places[item].placement = Placement::Heap { heap, offset };
        }
        memory.heaps.insert(heap, size);
        memory.peak_bytes += size;
        memory.lower_bound_bytes += packing::most_alive(&blocks);
    }
    for (pool, members) in pools {
        let (items, blocks): (Vec<usize>, Vec<Block>) = members.into_iter().unzip();
        // What shares an object has one size, but nothing here relies on it.
        let mut objects: BTreeMap<u32, u64> = BTreeMap::new();
        for (item, object) in items.into_iter().zip(packing::colour(&blocks)) {
            places[item].placement = Placement::Object { pool, object };
            let bytes = objects.entry(object).or_default();
            *bytes = places[item].bytes.max(*bytes);
        }
        memory.objects.insert(pool, objects.len());
        memory.peak_bytes += objects.values().sum::<u64>();
        memory.lower_bound_bytes += packing::most_alive(&blocks);
    }
    (places, memory)
}
