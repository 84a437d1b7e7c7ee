//! What the scheduler answers.

use std::collections::{BTreeMap, BTreeSet};

use super::{Cell, FRAME};

/// The order of a frame, and where its items live.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// By task, as listed.
    pub fates: Vec<Fate>,
    /// In the order they run.
    pub steps: Vec<Step>,
    /// By item.
    pub places: Vec<Place>,
    pub memory: Memory,
    /// Live tasks (as listed) that read a covered cell which no running task wrote before: the caller's error to make.
    pub unwritten: Vec<(usize, Cell)>,
    /// Outputs that are covered cells and which no running task writes.
    pub unwritten_outputs: Vec<Cell>,
}

/// What became of a task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It runs, as this step of [`Schedule::steps`]; in which frames, its `reruns` say.
    Run { step: usize },
    /// It never runs, for this reason: a clause for people, without a full stop.
    Dropped(String),
}

/// One thing to do in a frame. `reruns` are the bits that make it be done again once it was done in the first frame;
/// [`FRAME`] alone, if it is done in each frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Give these cells of an item their start: fill them, or (where they are covered) leave or poison them.
    Start { item: usize, cells: Vec<u32>, reruns: BTreeSet<u32> },
    /// Run a task.
    Run { task: usize, reruns: BTreeSet<u32> },
}

impl Step {
    pub fn reruns(&self) -> &BTreeSet<u32> {
        match self {
            Self::Start { reruns, .. } | Self::Run { reruns, .. } => reruns,
        }
    }
}

/// What changed since the frame before.
#[derive(Clone, Copy, Debug)]
pub enum Changed<'a> {
    /// There is no frame before, or what goes on from frame to frame was reset.
    All,
    /// These bits of [`Options::varying`](super::Options::varying). [`FRAME`] is always one of them.
    Only(&'a BTreeSet<u32>),
}

impl Schedule {
    /// Whether this step is done in a frame before which that changed.
    pub fn is_done(&self, step: usize, changed: Changed) -> bool {
        self.steps.get(step).is_some_and(|step| match changed {
            Changed::All => true,
            Changed::Only(bits) => step.reruns().iter().any(|bit| *bit == FRAME || bits.contains(bit)),
        })
    }

    /// Writes into `done` which of [`Self::steps`] are done. Allocates nothing once `done` has the room.
    pub fn runs(&self, changed: Changed, done: &mut Vec<bool>) {
        done.clear();
        done.extend((0..self.steps.len()).map(|step| self.is_done(step, changed)));
    }
}

/// Where an item lives, and when.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    pub bytes: u64,
    pub placement: Placement,
    /// `None` if no step touches the item and no output is in it.
    pub life: Option<Life>,
    /// Whether its content must survive from frame to frame.
    pub retained: bool,
}

/// From the first to the last step that touches an item, both included. An output lives until after the last step:
/// `last` is then the number of steps. What is retained lives on; these steps are for display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Life {
    pub first: usize,
    pub last: usize,
}

impl Life {
    /// Whether some step needs both.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.first <= other.last && other.first <= self.last
    }
}

/// What memory an item has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// From `offset` bytes on in a heap, which others share.
    Heap { heap: u32, offset: u64 },
    /// An object of those that are alike, numbered from 0 in each pool, which others share.
    Object { pool: u32, object: u32 },
    /// Memory of its own.
    Alone,
    /// None: nothing that runs touches it.
    Unmade,
    /// None of the schedule's: it is made outside.
    Given,
}

/// How many bytes the items take. Given and unmade items take none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// What all items that are not retained take together: the heaps, the objects of all pools, and those alone.
    pub peak_bytes: u64,
    /// What the same items would take, each with memory of its own.
    pub without_reuse_bytes: u64,
    /// What the retained items take, which is apart from `peak_bytes`.
    pub kept_bytes: u64,
    /// No sharing takes fewer: for each heap and pool, the bytes of the largest set of items alive at once; all
    /// of them added, and those alone.
    pub lower_bound_bytes: u64,
    /// The size of each heap, by its number.
    pub heaps: BTreeMap<u32, u64>,
    /// How many objects each pool of alike ones has, by its number.
    pub objects: BTreeMap<u32, usize>,
}
