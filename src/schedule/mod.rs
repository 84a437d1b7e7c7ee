//! The scheduler: from what stages touch to the order they run in, what is dropped, what is kept, and which
//! resources share memory. A pure function of [`Work`]; it knows no GPU and no kernel.
//!
//! # What it promises
//! The outputs of a frame are as if all tasks that are not off ran one after another in listed order, from the state
//! the frames before left. Each rule below keeps that promise; a slow interpreter in `tests/` holds them to it.
//! Nothing is known of how much of a cell a write covers, so every write is taken to leave a part as it was.
//!
//! * **Live** is a task that is not off and writes a cell that an output is, or that a live task reads later (for a
//!   cell that goes on from frame to frame: reads at all). What is not live is dropped, with a reason. With
//!   `drop: false` it runs too, unless it writes a cell that a live task touches or an output is.
//! * **Order**: of two tasks that touch a cell, one of them writing, the one listed first runs first. Within that, the
//!   order is the one that makes least memory alive, then that of the paths: the listing of independent tasks does
//!   not show in it.
//! * **Start**: before the first task that touches a cell which is filled or covered, a step says so ([`Step::Start`]).
//! * **Reruns**: a task runs again in a frame if something changed that it depends on, by itself or through the
//!   cells it reads or writes. The module `reruns` has the rule. A cell that is written in other frames
//!   than it is read must survive until then: its item is *retained*.
//! * **Memory**: items that are not retained, and of which no step needs both, share memory. See [`Memory`].

mod fates;
mod memory;
mod order;
mod packing;
mod reruns;
mod result;
mod steps;
#[cfg(test)]
mod tests;
mod uses;

use std::collections::BTreeSet;

pub use result::{Changed, Fate, Life, Memory, Place, Placement, Schedule, Step};
use uses::Uses;

/// The bit of [`Task::depends`] that stands for the number of the frame: it changes in each.
pub const FRAME: u32 = 0;

/// What the scheduler may do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Let items share memory.
    pub reuse: bool,
    /// Leave out what no output needs.
    pub drop: bool,
    /// Keep what did not change since the frame before. Costs memory: see [`Memory::kept_bytes`].
    pub keep: bool,
    /// The bits of [`Task::depends`] that may change between frames; the others never change after the first frame.
    /// [`FRAME`] is always one of them.
    pub varying: BTreeSet<u32>,
}

/// Schedules `work`: see the [module](self) for the rules.
///
/// # Errors
/// With a sentence for the developer if `work` itself is wrong: a cell that is not there, or sizes that add up to more
/// than 2⁶⁴ bytes.
pub fn schedule(work: &Work, options: &Options) -> Result<Schedule, String> {
    let uses = Uses::of(work)?;
    memory::check_sizes(work)?;
    let decided = fates::decide(work, &uses, options.drop);
    let (unwritten, unwritten_outputs) = fates::unwritten(work, &uses, &decided.live);

    let uses = uses.only(&decided.runs);
    let reruns = reruns::reruns(work, &uses, options);
    let retained = memory::retained(work, &uses, &reruns);
    let order = order::order(work, &uses, &decided.runs, &retained);
    let (steps, step_of) = steps::steps(work, &uses, &order, &reruns);
    let lives = steps::lives(work, &uses, &steps);
    let (places, memory) = memory::place(work, &lives, &retained, options.reuse);

    let fates = decided.dropped.into_iter().zip(&step_of).map(|(dropped, &step)| match dropped {
        Some(reason) => Fate::Dropped(reason),
        None => Fate::Run { step },
    });
    Ok(Schedule { fates: fates.collect(), steps, places, memory, unwritten, unwritten_outputs })
}

/// All that the scheduler knows of a graph.
#[derive(Clone, Debug, Default)]
pub struct Work {
    pub items: Vec<Item>,
    /// In listed order: the result must be as if they ran one after another like this.
    pub tasks: Vec<Task>,
    /// What must be there when the frame ends.
    pub outputs: Vec<Cell>,
}

/// A resource.
#[derive(Clone, Debug)]
pub struct Item {
    pub name: String,
    /// Subresources (mips × layers); 1 for a buffer.
    pub cells: u32,
    /// Of all its cells together.
    pub bytes: u64,
    pub start: Start,
    pub pool: Pool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Filled with a value before it is first touched in a frame.
    Fill,
    /// Undefined until written.
    Covered,
    /// Content goes on from frame to frame.
    Kept,
    /// As `Kept`; and the tasks that write it, run again without a change, leave it as it was.
    Steady,
    /// Made outside the schedule; takes none of its memory. Its content goes on from frame to frame, too.
    Given,
}

impl Start {
    /// Whether a frame finds what the frame before left.
    fn goes_on(self) -> bool {
        matches!(self, Self::Kept | Self::Steady | Self::Given)
    }
}

/// With what a resource can share memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pool {
    /// A range of bytes in the heap of this number, at multiples of `alignment`.
    Heap { heap: u32, alignment: u64 },
    /// Whole objects that are alike in everything: size, format, usage.
    Alike(u32),
    /// Never shared.
    Alone,
}

/// A subresource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    pub item: usize,
    pub cell: u32,
}

/// A stage.
#[derive(Clone, Debug)]
pub struct Task {
    /// Unique; decides the order where nothing else does.
    pub path: String,
    pub touches: Vec<Touch>,
    /// What it depends on by itself, not through what it reads: bits of causes and of named values.
    pub depends: BTreeSet<u32>,
    /// `Some`: its condition fails, for this reason. One that touches nothing can't be run even without dropping.
    pub off: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touch {
    pub cell: Cell,
    pub read: bool,
    pub write: bool,
}
