//! The order in which the tasks run.

use petgraph::graph::{DiGraph, NodeIndex};

use super::uses::Uses;
use super::{Start, Work};

/// The tasks that run, in a canonical order: among those that may come next, the one after which least bytes are
/// alive, then the one with the least path. Retained items count for nothing, since they are always alive.
pub(super) fn order(work: &Work, uses: &Uses, runs: &[bool], retained: &[bool]) -> Vec<usize> {
    let after = after(uses);
    let mut waits: Vec<usize> = vec![0; runs.len()];
    for edge in after.raw_edges() {
        waits[edge.target().index()] += 1;
    }
    let mut alive = Alive::new(work, uses, retained);
    let mut ready: Vec<usize> = (0..runs.len()).filter(|&task| runs[task] && waits[task] == 0).collect();
    let mut order = Vec::new();
    while let Some((at, _)) =
        ready.iter().enumerate().min_by_key(|&(_, &task)| (alive.change(task), &work.tasks[task].path, task))
    {
        let task = ready.swap_remove(at);
        alive.run(task);
        order.push(task);
        for next in after.neighbors(NodeIndex::new(task)) {
            waits[next.index()] -= 1;
            if waits[next.index()] == 0 {
                ready.push(next.index());
            }
        }
    }
    order
}

/// From each task to those that must come after it: on each cell, from each write to the reads up to the next
/// write (read after write), from these to that write (write after read), and from write to write. The other pairs
/// that conflict follow from these.
fn after(uses: &Uses) -> DiGraph<(), ()> {
    let mut after: DiGraph<(), ()> = DiGraph::new();
    let nodes: Vec<NodeIndex> = uses.of_task.iter().map(|_| after.add_node(())).collect();
    for of_cell in &uses.of_cell {
        let mut write = None;
        let mut reads = Vec::new();
        for each in of_cell {
            let node = nodes[each.task];
            if let Some(write) = write {
                after.add_edge(write, node, ());
            }
            if each.write {
                for read in reads.drain(..) {
                    after.add_edge(read, node, ());
                }
                write = Some(node);
            } else {
                reads.push(node);
            }
        }
    }
    after
}

/// Which items are alive while the order grows.
struct Alive {
    /// By task, the items it touches whose bytes count.
    items: Vec<Vec<usize>>,
    bytes: Vec<i128>,
    begun: Vec<bool>,
    /// By item: how many tasks are still to touch it; one more for an output.
    left: Vec<usize>,
}

impl Alive {
    fn new(work: &Work, uses: &Uses, retained: &[bool]) -> Self {
        let mut left = vec![0; work.items.len()];
        for (cell, _) in uses.is_output.iter().enumerate().filter(|(_, is_output)| **is_output) {
            left[uses.cells[cell].item] = 1;
        }
        let counts = |item: &usize| work.items[*item].start != Start::Given && !retained[*item];
        let items: Vec<Vec<usize>> = uses
            .of_task
            .iter()
            .map(|of_task| {
                let mut items: Vec<usize> = of_task.iter().map(|each| uses.cells[each.cell].item).collect();
                items.dedup(); // Cells are sorted by item.
                items.retain(counts);
                items
            })
            .collect();
        items.iter().flatten().for_each(|&item| left[item] += 1);
        let bytes = work.items.iter().map(|item| i128::from(item.bytes)).collect();
        Self { items, bytes, begun: vec![false; work.items.len()], left }
    }

    /// By how many bytes running `task` next would make what is alive afterwards more.
    fn change(&self, task: usize) -> i128 {
        let made = self.items[task].iter().filter(|&&item| !self.begun[item]).map(|&item| self.bytes[item]);
        let freed =
            self.items[task].iter().filter(|&&item| self.left[item] == 1).map(|&item| self.bytes[item]);
        made.sum::<i128>() - freed.sum::<i128>()
    }

    fn run(&mut self, task: usize) {
        for &item in &self.items[task] {
            self.begun[item] = true;
            self.left[item] -= 1;
        }
    }
}
