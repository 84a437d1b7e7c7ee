//! In which frames a task runs again.
//!
//! After the first frame a task runs when one of its bits changed: those of [`Task::depends`](super::Task::depends)
//! that may vary, and all that reach it through cells. A cell is written *as a whole*: from its start on by all of its
//! writers, or by none of them. So for each cell that running tasks touch:
//!
//! 1. The cell depends on all that its writers depend on, and each of its writers on all that the cell does.
//! 2. A task that reads what is written depends on all that the cell does: that is, if a writer is listed
//!    before it, or if there is any and the content goes on from frame to frame.
//! 3. A task that reads the cell before its last write (or writes it too) sees what is gone once the frame ends. It can
//!    run again only when the cell is written again, so the cell depends on all that it does.
//! 4. If the content goes on from frame to frame, what such a task sees is the state that earlier frames left,
//!    which differs from frame to frame: it depends on [`FRAME`]. Not so if the item is promised to be
//!    [`Steady`](super::Start::Steady), and all that the task writes too: then neither changes by running again.
//!
//! Reads after the last write need no more than rule 2, even if the content goes on: writing the same again onto what
//! was written by the same tasks leaves the same, since a task that only writes does not see what was there.
//!
//! These are edges of a graph of tasks and cells, where a node depends on all that it reaches. A cell's start is done
//! again whenever the cell is; what has no writers, in the first frame only.

use std::collections::BTreeSet;

use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use super::uses::Uses;
use super::{Cell, FRAME, Options, Start, Work};

/// The bits that make a task or a cell be done again; [`FRAME`] alone if it is among them.
pub(super) struct Reruns {
    /// By task; empty for those that don't run.
    pub tasks: Vec<BTreeSet<u32>>,
    /// By cell of [`Uses::cells`].
    pub cells: Vec<BTreeSet<u32>>,
}

/// `uses`: of the tasks that run.
pub(super) fn reruns(work: &Work, uses: &Uses, options: &Options) -> Reruns {
    let all = work.tasks.len() + uses.cells.len();
    if !options.keep {
        let each_frame = BTreeSet::from([FRAME]);
        return Reruns {
            tasks: vec![each_frame.clone(); work.tasks.len()],
            cells: vec![each_frame; uses.cells.len()],
        };
    }
    let mut bits: Vec<BTreeSet<u32>> = Vec::with_capacity(all);
    for task in &work.tasks {
        let varies = |bit: &&u32| **bit == FRAME || options.varying.contains(bit);
        bits.push(task.depends.iter().filter(varies).copied().collect());
    }
    bits.resize_with(all, BTreeSet::new);

    // What only steady items hold of a task's results is as it was when the task runs again; anything else it writes
    // shows what it found this time.
    let steady = |cell: usize| work.items[uses.cells[cell].item].start == Start::Steady;
    let settled: Vec<bool> = (0..work.tasks.len())
        .map(|task| uses.of_task[task].iter().all(|each| !each.write || steady(each.cell)))
        .collect();

    let mut depends: DiGraph<(), ()> = DiGraph::with_capacity(all, all);
    let nodes: Vec<NodeIndex> = (0..all).map(|_| depends.add_node(())).collect();
    for (cell, &Cell { item, .. }) in uses.cells.iter().enumerate() {
        let (Some(first), Some(last)) = (uses.writers(cell).next(), uses.writers(cell).next_back()) else {
            continue;
        };
        let goes_on = work.items[item].start.goes_on();
        let node = nodes[work.tasks.len() + cell];
        for each in &uses.of_cell[cell] {
            let early = each.read && each.task <= last;
            if each.write || early {
                depends.add_edge(node, nodes[each.task], ());
            }
            if each.write || first < each.task || goes_on {
                depends.add_edge(nodes[each.task], node, ());
            }
            if early && goes_on && !(work.items[item].start == Start::Steady && settled[each.task]) {
                bits[each.task].insert(FRAME);
            }
        }
    }

    // What a component depends on comes before it, and all in a component depend on the same.
    for component in kosaraju_scc(&depends) {
        let mut joined = BTreeSet::new();
        for &node in &component {
            joined.extend(&bits[node.index()]);
            depends.neighbors(node).for_each(|on| joined.extend(&bits[on.index()]));
        }
        if joined.contains(&FRAME) {
            joined = BTreeSet::from([FRAME]);
        }
        for node in component {
            bits[node.index()].clone_from(&joined);
        }
    }
    let cells = bits.split_off(work.tasks.len());
    Reruns { tasks: bits, cells }
}
