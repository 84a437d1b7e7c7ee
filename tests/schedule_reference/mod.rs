//! What the scheduler's promises mean, written as plainly as possible and slowly, to hold the scheduler to them. Shares
//! no code with it, only the types of its input and its answer.

pub mod frames;
pub mod generate;
pub mod machine;
pub mod rules;

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use voxgi::schedule::{Cell, Fate, Schedule, Start, Step, Work};

pub fn hash(of: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    hasher.finish()
}

/// The cells that a task reads (`true`, _) or writes (_, `true`), each once.
pub fn cells(work: &Work, task: usize, read: bool, write: bool) -> BTreeSet<Cell> {
    let touches = work.tasks[task].touches.iter();
    touches.filter(|t| (read && t.read) || (write && t.write)).map(|t| t.cell).collect()
}

pub fn touches(work: &Work, task: usize) -> BTreeSet<Cell> {
    cells(work, task, true, true)
}

pub fn reads(work: &Work, task: usize) -> BTreeSet<Cell> {
    cells(work, task, true, false)
}

pub fn writes(work: &Work, task: usize) -> BTreeSet<Cell> {
    cells(work, task, false, true)
}

/// Whether the order of two tasks matters.
pub fn conflict(work: &Work, a: usize, b: usize) -> bool {
    !writes(work, a).is_disjoint(&touches(work, b)) || !writes(work, b).is_disjoint(&touches(work, a))
}

pub fn goes_on(work: &Work, cell: Cell) -> bool {
    matches!(work.items[cell.item].start, Start::Kept | Start::Given)
}

pub fn on(work: &Work) -> Vec<usize> {
    (0..work.tasks.len()).filter(|&task| work.tasks[task].off.is_none()).collect()
}

pub fn running(schedule: &Schedule) -> Vec<usize> {
    (0..schedule.fates.len()).filter(|&task| matches!(schedule.fates[task], Fate::Run { .. })).collect()
}

/// The tasks in the order of the steps.
pub fn order(schedule: &Schedule) -> Vec<usize> {
    let task = |step: &Step| if let Step::Run { task, .. } = step { Some(*task) } else { None };
    schedule.steps.iter().filter_map(task).collect()
}

/// The cells that a step touches.
pub fn step_cells(work: &Work, step: &Step) -> BTreeSet<Cell> {
    match step {
        Step::Start { item, cells, .. } => cells.iter().map(|&cell| Cell { item: *item, cell }).collect(),
        Step::Run { task, .. } => touches(work, *task),
    }
}
