//! What frames mean: an interpreter that runs tasks one after another in listed order.
//!
//! A cell is a few texels. What a task writes is a hash of all that it sees, into texels that depend on what it sees,
//! so that a write leaves part of what was there, and two equal writes leave the same as one.

use std::collections::{BTreeMap, BTreeSet};

use voxgi::schedule::{Cell, FRAME, Start, Work};

use super::{hash, on, reads, writes};

pub type Texels = [u64; 4];

/// What bits of `depends` stand for, in one frame.
#[derive(Clone, Default)]
pub struct World(BTreeMap<u32, u64>);

impl World {
    /// One for each frame: the first, and one after each change.
    pub fn of(changes: &[BTreeSet<u32>]) -> Vec<World> {
        let mut worlds = vec![World::default()];
        for (frame, changed) in changes.iter().enumerate() {
            let mut next = worlds[frame].clone();
            for &bit in changed.iter().chain([&FRAME]) {
                *next.0.entry(bit).or_default() += 1;
            }
            worlds.push(next);
        }
        worlds
    }
}

/// What cells hold when they start; covered cells hold the poison.
pub fn start(work: &Work, cell: Cell, poison: u64) -> Texels {
    match work.items[cell.item].start {
        Start::Covered => [poison; 4],
        _ => std::array::from_fn(|texel| hash(("start", cell, texel))),
    }
}

/// What tasks do, as functions.
pub struct Kernels<'a> {
    work: &'a Work,
    /// The task that writes each texel of a covered cell: the first to write it.
    covers: BTreeSet<(usize, Cell)>,
}

impl<'a> Kernels<'a> {
    pub fn new(work: &'a Work) -> Self {
        let mut covered = BTreeSet::new();
        let mut covers = BTreeSet::new();
        for task in on(work) {
            let first = writes(work, task).into_iter().filter(|&cell| covered.insert(cell));
            covers.extend(
                first.filter(|c| work.items[c.item].start == Start::Covered).map(|cell| (task, cell)),
            );
        }
        Self { work, covers }
    }

    /// What `task` leaves in the cells it writes, given what was in those it touches.
    pub fn run(&self, task: usize, world: &World, held: impl Fn(Cell) -> Texels) -> Vec<(Cell, Texels)> {
        let depends: Vec<_> =
            self.work.tasks[task].depends.iter().map(|bit| (bit, world.0.get(bit))).collect();
        let seen: Vec<_> = reads(self.work, task).into_iter().map(|cell| (cell, held(cell))).collect();
        let sees = hash((&self.work.tasks[task].path, depends, seen));
        let write = |cell: Cell| {
            let mut texels = held(cell);
            for (index, texel) in texels.iter_mut().enumerate() {
                if self.covers.contains(&(task, cell)) || hash((sees, cell, index, "written?")) % 2 == 0 {
                    *texel = hash((sees, cell, index));
                }
            }
            (cell, texels)
        };
        writes(self.work, task).into_iter().map(write).collect()
    }
}

/// The outputs at the end of each frame.
pub fn outputs(work: &Work, worlds: &[World], poison: u64) -> Vec<Vec<Texels>> {
    let kernels = Kernels::new(work);
    let all: Vec<Cell> = (0..work.items.len())
        .flat_map(|item| (0..work.items[item].cells).map(move |cell| Cell { item, cell }))
        .collect();
    let mut held: BTreeMap<Cell, Texels> = BTreeMap::new();
    let mut frames = Vec::new();
    for world in worlds {
        for &cell in &all {
            if frames.is_empty() || !super::goes_on(work, cell) {
                held.insert(cell, start(work, cell, poison));
            }
        }
        for task in on(work) {
            held.extend(kernels.run(task, world, |cell| held[&cell]));
        }
        frames.push(work.outputs.iter().map(|cell| held[cell]).collect());
    }
    frames
}
