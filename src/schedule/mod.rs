//! The scheduler: from what stages touch to the order they run in, what is dropped, what is kept, and which
//! resources share memory. A pure function of [`Work`]; it knows no GPU and no kernel.

use std::collections::BTreeSet;

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
    /// Made outside the schedule; takes none of its memory.
    Given,
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
    /// Unique.
    pub path: String,
    pub touches: Vec<Touch>,
    /// What it depends on by itself, not through what it reads: bits of causes and of named values.
    pub depends: BTreeSet<u32>,
    /// `Some`: its condition fails, for this reason.
    pub off: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touch {
    pub cell: Cell,
    pub read: bool,
    pub write: bool,
}
