//! Which tasks run, and why the others don't.

use super::uses::Uses;
use super::{Cell, Start, Work};

pub(super) struct Decided {
    /// By task: an output needs it.
    pub live: Vec<bool>,
    /// By task: it is in the schedule. All that are live, and without dropping also others.
    pub runs: Vec<bool>,
    /// By task: why it does not run.
    pub dropped: Vec<Option<String>>,
}

pub(super) fn decide(work: &Work, uses: &Uses, drop: bool) -> Decided {
    let live = live(work, uses);
    let reads_live =
        |cell: usize| uses.is_output[cell] || uses.of_cell[cell].iter().any(|each| live[each.task]);

    let dropped: Vec<Option<String>> = (0..work.tasks.len())
        .map(|task| {
            if live[task] {
                return None;
            }
            let written = || uses.of_task[task].iter().filter(|each| each.write).map(|each| each.cell);
            let harmed = names(work, uses, written().filter(|&cell| reads_live(cell)));
            let unbound = work.tasks[task].off.is_some() && work.tasks[task].touches.is_empty();
            if !drop && harmed.is_empty() && !unbound {
                return None;
            }
            let mut reason = match &work.tasks[task].off {
                Some(reason) => reason.clone(),
                None => match names(work, uses, written()) {
                    names if names.is_empty() => "it writes nothing".to_owned(),
                    names => format!("nothing that an output needs reads what it writes ({names})"),
                },
            };
            if !drop && unbound {
                reason += ", and there is nothing that it could be bound to";
            } else if !drop {
                reason += &format!(", and running it all the same could change {harmed}");
            }
            Some(reason)
        })
        .collect();
    Decided { runs: dropped.iter().map(Option::is_none).collect(), live, dropped }
}

/// By task, whether an output needs it: backwards from the outputs through all that could have written what is read.
fn live(work: &Work, uses: &Uses) -> Vec<bool> {
    let mut live = vec![false; work.tasks.len()];
    let mut found = Vec::new();
    let mut find = |task: usize, found: &mut Vec<usize>| {
        if work.tasks[task].off.is_none() && !live[task] {
            live[task] = true;
            found.push(task);
        }
    };
    for cell in (0..uses.cells.len()).filter(|&cell| uses.is_output[cell]) {
        uses.writers(cell).for_each(|writer| find(writer, &mut found));
    }
    while let Some(task) = found.pop() {
        for read in uses.of_task[task].iter().filter(|each| each.read) {
            let goes_on = work.items[uses.cells[read.cell].item].start.goes_on();
            let feeds = uses.writers(read.cell).filter(|&writer| goes_on || writer < task);
            feeds.for_each(|writer| find(writer, &mut found));
        }
    }
    live
}

/// The items of these cells, each once, as "`a`, `b`".
fn names(work: &Work, uses: &Uses, cells: impl Iterator<Item = usize>) -> String {
    let mut items: Vec<usize> = cells.map(|cell| uses.cells[cell].item).collect();
    items.dedup(); // Cells are sorted by item.
    let names: Vec<String> = items.into_iter().map(|item| format!("`{}`", work.items[item].name)).collect();
    names.join(", ")
}

/// Covered cells that a live task reads, or an output shows, without a live task having written them before.
pub(super) fn unwritten(work: &Work, uses: &Uses, live: &[bool]) -> (Vec<(usize, Cell)>, Vec<Cell>) {
    let (mut reads, mut outputs) = (Vec::new(), Vec::new());
    for (index, &cell) in uses.cells.iter().enumerate() {
        if work.items[cell.item].start != Start::Covered {
            continue;
        }
        let first = uses.writers(index).find(|&writer| live[writer]);
        let early = uses.of_cell[index].iter().filter(|each| live[each.task] && each.read);
        let early = early.filter(|each| first.is_none_or(|first| each.task <= first));
        reads.extend(early.map(|each| (each.task, cell)));
        if uses.is_output[index] && first.is_none() {
            outputs.push(cell);
        }
    }
    reads.sort_unstable();
    (reads, outputs)
}
