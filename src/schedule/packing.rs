//! Placing blocks of memory so that those alive at once don't overlap.
//!
//! In a heap this is dynamic storage allocation with all lifetimes known, which is NP-hard; first fit in a good order
//! comes close, and a short search improves on the order where it does not reach the bound.

use std::cmp::Reverse;

use super::Life;

#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    pub bytes: u64,
    /// 0 is taken as 1.
    pub alignment: u64,
    pub life: Life,
}

/// How many pairs of blocks the search may look at. Some milliseconds.
const BUDGET: usize = 400_000;

/// By block its offset, and the size of the heap. Deterministic; depends on nothing but the blocks.
pub(super) fn pack(blocks: &[Block]) -> (Vec<u64>, u64) {
    let steps = |block: &Block| u128::from(block.bytes) * (block.life.last - block.life.first + 1) as u128;
    let by_size = sorted(blocks, |block| (Reverse(u128::from(block.bytes)), block.life.first));
    let by_area = sorted(blocks, |block| (Reverse(steps(block)), block.life.first));
    let by_start = sorted(blocks, |block| (Reverse(0), block.life.first));

    let tries = [by_size, by_area, by_start].map(|order| (Packed::new(blocks, &order), order));
    let Some((mut best, mut order)) = tries.into_iter().min_by_key(|(packed, _)| packed.size) else {
        return (Vec::new(), 0);
    };
    let bound = most_alive(blocks);
    let mut random = Random(1);
    for _ in 0..BUDGET / (blocks.len() * blocks.len() + 1) {
        if best.size <= bound {
            break;
        }
        // A block at the top is to blame. Placed earlier, it comes lower.
        let at_top = |&&block: &&usize| best.offsets[block] + blocks[block].bytes == best.size;
        let tops = order.iter().filter(at_top).count();
        let mut other = order.clone();
        if let Some((at, &block)) =
            order.iter().enumerate().filter(|(_, block)| at_top(block)).nth(random.below(tops))
        {
            other.remove(at);
            other.insert(random.below(at + 1), block);
        }
        if random.below(2) == 0 {
            other.swap(random.below(blocks.len()), random.below(blocks.len()));
        }
        let packed = Packed::new(blocks, &other);
        if packed.size <= best.size {
            (best, order) = (packed, other);
        }
    }
    (best.offsets, best.size)
}

fn sorted<K: Ord>(blocks: &[Block], key: impl Fn(&Block) -> K) -> Vec<usize> {
    let mut order: Vec<usize> = (0..blocks.len()).collect();
    order.sort_by_key(|&block| key(&blocks[block])); // Stable: ties go by index.
    order
}

struct Packed {
    offsets: Vec<u64>,
    size: u64,
}

impl Packed {
    /// Places the blocks in this order, each at the lowest offset that is free for all its life.
    fn new(blocks: &[Block], order: &[usize]) -> Self {
        let mut offsets = vec![0; blocks.len()];
        let mut size = 0;
        // Sorted by offset.
        let mut placed: Vec<usize> = Vec::with_capacity(blocks.len());
        for &index in order {
            let block = &blocks[index];
            let alignment = block.alignment.max(1);
            let mut offset = 0;
            for &other in placed.iter().filter(|&&other| blocks[other].life.overlaps(&block.life)) {
                if offset + block.bytes <= offsets[other] {
                    break;
                }
                offset = offset.max((offsets[other] + blocks[other].bytes).next_multiple_of(alignment));
            }
            offsets[index] = offset;
            size = size.max(offset + block.bytes);
            placed.insert(placed.partition_point(|&other| offsets[other] <= offset), index);
        }
        Self { offsets, size }
    }
}

/// By block the number of its object. There are as many as blocks are ever alive at once, since lives are
/// intervals, and each takes the lowest number free when it begins.
pub(super) fn colour(blocks: &[Block]) -> Vec<u32> {
    let mut colours = vec![0; blocks.len()];
    // By object, the last step that needs it.
    let mut busy: Vec<usize> = Vec::new();
    for index in sorted(blocks, |block| block.life.first) {
        let life = blocks[index].life;
        let object = busy.iter().position(|&last| last < life.first).unwrap_or(busy.len());
        if object == busy.len() {
            busy.push(life.last);
        }
        busy[object] = life.last;
        colours[index] = object as u32;
    }
    colours
}

/// The bytes of the largest set of blocks alive at once.
pub(super) fn most_alive(blocks: &[Block]) -> u64 {
    // What is alive only grows where a block begins.
    let alive_at =
        |step: usize| blocks.iter().filter(move |block| (block.life.first..=block.life.last).contains(&step));
    let at_begin = blocks.iter().map(|block| alive_at(block.life.first).map(|other| other.bytes).sum());
    at_begin.max().unwrap_or(0)
}

/// SplitMix64: small, and the same everywhere.
struct Random(u64);

impl Random {
    /// A number below `end`; 0 if that is 0.
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % end.max(1) as u64) as usize
    }
}
