//! Placing blocks of memory so that those alive at once don't overlap.
//!
//! In a heap this is dynamic storage allocation with all lifetimes known, which is NP-hard. First fit in a good order
//! comes close; where it does not reach the bound, a short search looks for a better order.

use std::cmp::Reverse;

use super::Life;

#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    pub bytes: u64,
    /// 0 is taken as 1.
    pub alignment: u64,
    pub life: Life,
}

/// How many orders the search may try, and how many pairs of blocks it may look at in all: some milliseconds.
const TRIES: usize = 500;
const PAIRS: usize = 4_000_000;

/// By block its offset, and the size of the heap. Deterministic; depends on nothing but the blocks.
pub(super) fn pack(blocks: &[Block]) -> (Vec<u64>, u64) {
    let steps = |block: &Block| (block.life.last - block.life.first + 1) as u128;
    let mut best = Packed::new(blocks, sorted(blocks, |block| (Reverse(block.bytes), block.life.first)));
    for order in [
        sorted(blocks, |block| (Reverse(u128::from(block.bytes) * steps(block)), block.life.first)),
        sorted(blocks, |block| block.life.first),
    ] {
        best = best.or_smaller(Packed::new(blocks, order));
    }

    let bound = most_alive(blocks);
    let mut random = Random(1);
    for _ in 0..TRIES.min(PAIRS / (blocks.len() * blocks.len() + 1)) {
        // The last hundredth is not worth the time.
        if best.size <= bound + bound / 100 {
            break;
        }
        // A block at the top is to blame. Placed earlier, it comes lower.
        let is_at_top =
            |&at: &usize| best.offsets[best.order[at]] + blocks[best.order[at]].bytes == best.size;
        let at_top: Vec<usize> = (0..blocks.len()).filter(is_at_top).collect();
        let at = at_top[random.below(at_top.len())];
        let mut order = best.order.clone();
        order[random.below(at + 1)..=at].rotate_right(1);
        if random.below(2) == 0 {
            order.swap(random.below(blocks.len()), random.below(blocks.len()));
        }
        best = best.or_smaller(Packed::new(blocks, order));
    }
    (best.offsets, best.size)
}

fn sorted<K: Ord>(blocks: &[Block], key: impl Fn(&Block) -> K) -> Vec<usize> {
    let mut order: Vec<usize> = (0..blocks.len()).collect();
    order.sort_by_key(|&block| key(&blocks[block])); // Stable: ties go by index.
    order
}

struct Packed {
    /// In which the blocks were placed.
    order: Vec<usize>,
    /// By block.
    offsets: Vec<u64>,
    size: u64,
}

impl Packed {
    /// Places the blocks in this order, each at the lowest offset that is free for all its life.
    fn new(blocks: &[Block], order: Vec<usize>) -> Self {
        let mut offsets = vec![0; blocks.len()];
        let mut size = 0;
        // Sorted by offset.
        let mut placed: Vec<usize> = Vec::with_capacity(blocks.len());
        for &index in &order {
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
        Self { order, offsets, size }
    }

    /// Of equals the other, so that a search does not stand still.
    fn or_smaller(self, other: Self) -> Self {
        if other.size <= self.size { other } else { self }
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
    /// A number below `end`, which is not 0.
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % end as u64) as usize
    }
}
