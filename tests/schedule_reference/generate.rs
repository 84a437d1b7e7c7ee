//! Random work.

use std::collections::BTreeSet;

use proptest::collection::{btree_set, vec};
use proptest::prelude::*;
use proptest::sample::Index;
use voxgi::schedule::{Cell, Item, Options, Pool, Start, Task, Touch, Work};

use super::{on, reads, writes};

/// Bits of `depends` are below this; 0 is the frame's.
pub const BITS: u32 = 6;

fn item() -> impl Strategy<Value = Item> {
    let start = prop_oneof![
        4 => Just(Start::Covered), 3 => Just(Start::Fill), 2 => Just(Start::Kept), 1 => Just(Start::Given)
    ];
    let sized = prop_oneof![
        5 => (0..2_u32, prop_oneof![Just(16_u64), Just(256)], 1..9999_u64).prop_map(|(heap, alignment, bytes)| {
            (Pool::Heap { heap, alignment }, bytes)
        }),
        3 => (0..3_u32).prop_map(|pool| (Pool::Alike(pool), 1000 * u64::from(pool + 1))),
        1 => (1..9999_u64).prop_map(|bytes| (Pool::Alone, bytes)),
    ];
    (1..4_u32, start, sized).prop_map(|(cells, start, (pool, bytes))| Item {
        name: String::new(),
        cells,
        bytes,
        start,
        pool,
    })
}

fn a_cell(items: &[Item], item: Index, cell: u32) -> Cell {
    let item = item.index(items.len());
    Cell { item, cell: cell % items[item].cells }
}

/// Path, touches (item, cell, kind), what it depends on, whether it is off.
type Drawn = (u16, Vec<(Index, u32, u8)>, BTreeSet<u32>, bool);

fn tasks() -> impl Strategy<Value = Vec<Drawn>> {
    let touches = vec((any::<Index>(), any::<u32>(), 0..5_u8), 0..6);
    // Most tasks depend on little, or all would always run again.
    let depends =
        prop_oneof![2 => Just(BTreeSet::new()), 1 => btree_set(1..BITS, 1..3), 1 => btree_set(0..BITS, 0..2)];
    vec((any::<u16>(), touches, depends, prop::bool::weighted(0.12)), 1..40)
}

/// Any work that the scheduler must take: cells are read unwritten, too.
pub fn rough_work() -> impl Strategy<Value = Work> {
    (vec(item(), 1..25), tasks(), vec((any::<Index>(), any::<u32>()), 0..4)).prop_map(
        |(mut items, tasks, outputs)| {
            for (index, item) in items.iter_mut().enumerate() {
                item.name = format!("item{index}");
            }
            let tasks = tasks.into_iter().enumerate().map(|(index, (path, touches, depends, off))| Task {
                // So that the order of paths is not that of the list.
                path: format!("{path:04x}.{index}"),
                touches: touches
                    .into_iter()
                    .map(|(item, cell, kind)| Touch {
                        cell: a_cell(&items, item, cell),
                        read: kind != 0 && kind != 1,
                        write: kind < 3,
                    })
                    .collect(),
                depends,
                off: off.then(|| "it is off".to_owned()),
            });
            Work {
                tasks: tasks.collect(),
                outputs: outputs.into_iter().map(|(item, cell)| a_cell(&items, item, cell)).collect(),
                items,
            }
        },
    )
}

/// Work in which every covered cell is written before it is read: the others are filled instead. Sizes are such that
/// alignment costs nothing.
pub fn work() -> impl Strategy<Value = Work> {
    rough_work().prop_map(|mut work| {
        let mut unwritten: BTreeSet<usize> = BTreeSet::new();
        let mut written: BTreeSet<Cell> = BTreeSet::new();
        for task in on(&work) {
            unwritten.extend(reads(&work, task).difference(&written).map(|cell| cell.item));
            written.extend(writes(&work, task));
        }
        unwritten.extend(work.outputs.iter().filter(|cell| !written.contains(cell)).map(|cell| cell.item));
        for item in work.items.iter_mut().filter(|item| matches!(item.pool, Pool::Heap { .. })) {
            item.bytes = item.bytes.next_multiple_of(256);
        }
        for item in unwritten {
            if work.items[item].start == Start::Covered {
                work.items[item].start = Start::Fill;
            }
        }
        work
    })
}

/// Work as most pipelines have it: each task writes a few new items and reads some of the latest ones.
pub fn pipeline() -> impl Strategy<Value = Work> {
    let task = (vec(item(), 1..3), vec((1..12_usize, any::<u32>()), 0..4), any::<u16>());
    vec(task, 1..40).prop_map(|tasks| {
        let mut work = Work::default();
        for (index, (made, read, path)) in tasks.into_iter().enumerate() {
            let before = work.items.len();
            let mut touches = Vec::new();
            for (back, cell) in read {
                if let Some(item) = before.checked_sub(back) {
                    let cell = Cell { item, cell: cell % work.items[item].cells };
                    touches.push(Touch { cell, read: true, write: false });
                }
            }
            for mut item in made {
                item.bytes = item.bytes.next_multiple_of(256);
                item.name = format!("item{}", work.items.len());
                item.start = Start::Covered;
                touches.extend((0..item.cells).map(|cell| Touch {
                    cell: Cell { item: work.items.len(), cell },
                    read: false,
                    write: true,
                }));
                work.items.push(item);
            }
            work.tasks.push(Task {
                path: format!("{path:04x}.{index}"),
                touches,
                depends: BTreeSet::new(),
                off: None,
            });
        }
        work.outputs.push(Cell { item: work.items.len() - 1, cell: 0 });
        work
    })
}

/// Work that makes it hard to share well: one heap, items of many sizes, read long after they were written.
pub fn crowded() -> impl Strategy<Value = Work> {
    vec((1..1000_u64, vec(1..40_usize, 0..3)), 20..120).prop_map(|tasks| {
        let mut work = Work::default();
        for (index, (units, back)) in tasks.into_iter().enumerate() {
            let touch =
                |item: usize, write: bool| Touch { cell: Cell { item, cell: 0 }, read: !write, write };
            let reads = back.into_iter().chain([1]).filter_map(|back| index.checked_sub(back));
            work.tasks.push(Task {
                path: format!("{index:04}"),
                touches: reads.map(|item| touch(item, false)).chain([touch(index, true)]).collect(),
                depends: BTreeSet::new(),
                off: None,
            });
            let pool = Pool::Heap { heap: 0, alignment: 256 };
            let name = format!("item{index}");
            work.items.push(Item { name, cells: 1, bytes: units * 256, start: Start::Covered, pool });
        }
        work.outputs.push(Cell { item: work.items.len() - 1, cell: 0 });
        work
    })
}

pub fn options() -> impl Strategy<Value = Options> {
    (any::<bool>(), any::<bool>(), any::<bool>(), btree_set(0..BITS, 0..4))
        .prop_map(|(reuse, drop, keep, varying)| Options { reuse, drop, keep, varying })
}

/// What changed before each frame but the first; only some of it may.
pub fn changes() -> impl Strategy<Value = Vec<BTreeSet<u32>>> {
    vec(btree_set(1..BITS, 0..3), 3)
}

/// Numbers that nobody would write on purpose, cells that are not there.
pub fn wild_work() -> impl Strategy<Value = Work> {
    let number = prop_oneof![Just(0), Just(1), Just(u64::MAX), any::<u64>(), 0..99_u64];
    let wild = (number.clone(), number, any::<u32>(), any::<u32>(), any::<bool>());
    (rough_work(), vec((any::<Index>(), wild), 0..4), prop::option::of((any::<usize>(), any::<u32>())))
        .prop_map(|(mut work, changes, output)| {
            for (index, (bytes, alignment, heap, cells, is_heap)) in changes {
                let index = index.index(work.items.len());
                let item = &mut work.items[index];
                item.bytes = bytes;
                item.cells = cells;
                if is_heap {
                    item.pool = Pool::Heap { heap, alignment };
                }
            }
            work.outputs.extend(output.map(|(item, cell)| Cell { item, cell }));
            work
        })
}

/// The same work with its tasks listed in another order, in which tasks whose order matters keep it. Also where each
/// task was listed before.
pub fn shuffled(work: &Work, choices: &[Index]) -> (Work, Vec<usize>) {
    let mut left: Vec<usize> = (0..work.tasks.len()).collect();
    let mut listed = Vec::new();
    for choice in choices.iter().cycle() {
        let free: Vec<usize> = left
            .iter()
            .copied()
            .filter(|&task| left.iter().all(|&before| before >= task || !super::conflict(work, before, task)))
            .collect();
        if free.is_empty() {
            break;
        }
        let task = free[choice.index(free.len())];
        left.retain(|&other| other != task);
        listed.push(task);
    }
    let tasks = listed.iter().map(|&task| work.tasks[task].clone()).collect();
    (Work { tasks, ..work.clone() }, listed)
}
