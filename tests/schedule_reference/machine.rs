//! A machine that does what a schedule says, with memory in which items that share it destroy one another.

use std::collections::BTreeMap;

use voxgi::schedule::{Cell, Changed, Placement, Schedule, Step, Work};

use super::frames::{Kernels, Texels, World, start};
use super::{goes_on, hash};

/// Whether two items have some memory in common.
pub fn share(work: &Work, schedule: &Schedule, a: usize, b: usize) -> bool {
    match (schedule.places[a].placement, schedule.places[b].placement) {
        (Placement::Heap { heap: x, offset: at_x }, Placement::Heap { heap: y, offset: at_y }) => {
            x == y && at_x.max(at_y) < (at_x + work.items[a].bytes).min(at_y + work.items[b].bytes)
        }
        (Placement::Object { pool: x, object: i }, Placement::Object { pool: y, object: j }) => {
            (x, i) == (y, j)
        }
        _ => false,
    }
}

struct Machine<'a> {
    work: &'a Work,
    schedule: &'a Schedule,
    held: BTreeMap<Cell, Texels>,
}

impl Machine<'_> {
    fn read(&self, cell: Cell) -> Texels {
        assert_ne!(self.schedule.places[cell.item].placement, Placement::Unmade, "{cell:?} has no memory");
        self.held[&cell]
    }

    /// Writing an item leaves garbage in all that it shares memory with.
    fn write(&mut self, cell: Cell, texels: Texels) {
        for (other, held) in &mut self.held {
            if other.item != cell.item && share(self.work, self.schedule, other.item, cell.item) {
                *held = [hash(("garbage", cell, texels)); 4];
            }
        }
        self.held.insert(cell, texels);
    }
}

/// The outputs at the end of each frame.
pub fn outputs(
    work: &Work,
    schedule: &Schedule,
    worlds: &[World],
    changes: &[Changed],
    poison: u64,
) -> Vec<Vec<Texels>> {
    let kernels = Kernels::new(work);
    let mut machine = Machine { work, schedule, held: BTreeMap::new() };
    for item in 0..work.items.len() {
        for cell in (0..work.items[item].cells).map(|cell| Cell { item, cell }) {
            let reset = if goes_on(work, cell) { start(work, cell, poison) } else { [hash("at first"); 4] };
            machine.held.insert(cell, reset);
        }
    }
    let mut frames = Vec::new();
    let mut done = Vec::new();
    for (world, &changed) in worlds.iter().zip(changes) {
        schedule.runs(changed, &mut done);
        for (step, _) in schedule.steps.iter().zip(&done).filter(|(_, done)| **done) {
            match step {
                Step::Start { item, cells, .. } => {
                    for cell in cells.iter().map(|&cell| Cell { item: *item, cell }) {
                        machine.write(cell, start(work, cell, poison));
                    }
                }
                Step::Run { task, .. } => {
                    for (cell, texels) in kernels.run(*task, world, |cell| machine.read(cell)) {
                        machine.write(cell, texels);
                    }
                }
            }
        }
        frames.push(work.outputs.iter().map(|&cell| machine.read(cell)).collect());
    }
    frames
}
