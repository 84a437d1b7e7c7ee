//! From an order of tasks to steps: where cells get their start, and from when to when items live.

use std::collections::{BTreeMap, BTreeSet};

use super::reruns::Reruns;
use super::uses::Uses;
use super::{Life, Start, Step, Work};

/// The steps, and for each task the index of its step (0 for those that don't run).
///
/// Cells get their start directly before the first task that touches them, and at the end if they are an output that
/// nothing touches. Cells of one item that start at one place in the same frames are one step.
pub(super) fn steps(work: &Work, uses: &Uses, order: &[usize], reruns: &Reruns) -> (Vec<Step>, Vec<usize>) {
    let mut steps = Vec::new();
    let mut step_of = vec![0; work.tasks.len()];
    let mut started = vec![false; uses.cells.len()];
    let mut start = |cells: &mut dyn Iterator<Item = usize>, steps: &mut Vec<Step>| {
        let mut starts: BTreeMap<(usize, &BTreeSet<u32>), Vec<u32>> = BTreeMap::new();
        for index in cells {
            let cell = uses.cells[index];
            let starts_here = matches!(work.items[cell.item].start, Start::Fill | Start::Covered);
            if starts_here && !std::mem::replace(&mut started[index], true) {
                starts.entry((cell.item, &reruns.cells[index])).or_default().push(cell.cell);
            }
        }
        steps.extend(starts.into_iter().map(|((item, reruns), cells)| Step::Start {
            item,
            cells,
            reruns: reruns.clone(),
        }));
    };
    for &task in order {
        start(&mut uses.of_task[task].iter().map(|each| each.cell), &mut steps);
        step_of[task] = steps.len();
        steps.push(Step::Run { task, reruns: reruns.tasks[task].clone() });
    }
    start(&mut (0..uses.cells.len()).filter(|&cell| uses.is_output[cell]), &mut steps);
    (steps, step_of)
}

/// By item, from the first to the last step that touches one of its cells; to the end for outputs.
pub(super) fn lives(work: &Work, uses: &Uses, steps: &[Step]) -> Vec<Option<Life>> {
    let mut lives: Vec<Option<Life>> = vec![None; work.items.len()];
    let mut touch = |item: usize, step: usize| {
        lives[item].get_or_insert(Life { first: step, last: step }).last = step;
    };
    for (index, step) in steps.iter().enumerate() {
        match step {
            Step::Start { item, .. } => touch(*item, index),
            Step::Run { task, .. } => {
                uses.of_task[*task].iter().for_each(|each| touch(uses.cells[each.cell].item, index));
            }
        }
    }
    for (cell, _) in uses.cells.iter().zip(&uses.is_output).filter(|(_, is_output)| **is_output) {
        touch(cell.item, steps.len());
    }
    lives
}
