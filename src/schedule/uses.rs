//! The touches of a [`Work`], checked, merged, and by cell as well as by task. The other passes read only this.

use std::collections::BTreeMap;

use super::{Cell, Work};

/// How one task touches one cell, over all its touches of that cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Use {
    /// As listed.
    pub task: usize,
    /// Index into [`Uses::cells`].
    pub cell: usize,
    pub read: bool,
    pub write: bool,
}

#[derive(Clone, Debug)]
pub(super) struct Uses {
    /// Each cell that some task touches or an output is, sorted.
    pub cells: Vec<Cell>,
    /// By cell.
    pub is_output: Vec<bool>,
    /// By task, each in the order of cells.
    pub of_task: Vec<Vec<Use>>,
    /// By cell, each in the order of tasks.
    pub of_cell: Vec<Vec<Use>>,
}

impl Uses {
    /// # Errors
    /// If a touch or an output is no cell of `work`.
    pub fn of(work: &Work) -> Result<Self, String> {
        // A cell, then for each task that touches it whether it reads and writes; an output may have none.
        let mut by_cell: BTreeMap<Cell, BTreeMap<usize, (bool, bool)>> = BTreeMap::new();
        for (index, task) in work.tasks.iter().enumerate() {
            for touch in task.touches.iter().filter(|touch| touch.read || touch.write) {
                check(work, touch.cell, &task.path)?;
                let (read, write) = by_cell.entry(touch.cell).or_default().entry(index).or_default();
                *read |= touch.read;
                *write |= touch.write;
            }
        }
        for &output in &work.outputs {
            check(work, output, "an output")?;
            by_cell.entry(output).or_default();
        }

        let mut uses = Self {
            cells: by_cell.keys().copied().collect(),
            is_output: vec![false; by_cell.len()],
            of_task: vec![Vec::new(); work.tasks.len()],
            of_cell: Vec::with_capacity(by_cell.len()),
        };
        for (cell, tasks) in by_cell.into_values().enumerate() {
            let of_cell = tasks.into_iter().map(|(task, (read, write))| Use { task, cell, read, write });
            uses.of_cell.push(of_cell.collect());
            for each in &uses.of_cell[cell] {
                uses.of_task[each.task].push(*each);
            }
        }
        for output in &work.outputs {
            if let Ok(cell) = uses.cells.binary_search(output) {
                uses.is_output[cell] = true;
            }
        }
        Ok(uses)
    }

    /// As if only the tasks that run were there. Cells keep their indices, tasks too.
    pub fn only(mut self, runs: &[bool]) -> Self {
        for (of_task, &runs) in self.of_task.iter_mut().zip(runs) {
            if !runs {
                of_task.clear();
            }
        }
        for of_cell in &mut self.of_cell {
            of_cell.retain(|each| runs[each.task]);
        }
        self
    }

    /// The tasks that write a cell, in listed order.
    pub fn writers(&self, cell: usize) -> impl DoubleEndedIterator<Item = usize> {
        self.of_cell[cell].iter().filter(|each| each.write).map(|each| each.task)
    }
}

fn check(work: &Work, cell: Cell, who: &str) -> Result<(), String> {
    match work.items.get(cell.item) {
        Some(item) if cell.cell < item.cells => Ok(()),
        Some(item) => {
            Err(format!("{who} touches cell {} of `{}`, which has {}", cell.cell, item.name, item.cells))
        }
        None => Err(format!("{who} touches item {} of {}", cell.item, work.items.len())),
    }
}
