//! How many bytes each step has to move: its footprint.
//!
//! Each subresource that a stage binds counts once as read if the stage reads it, and once as written if it writes it,
//! in full: the mips and layers that are bound, a buffer's whole range, of indirect arguments the arguments alone.
//! A target that the pass clears as it begins is not read. Uniforms and counters don't count: they are tiny.
//!
//! That is what caches without limit would leave of the traffic if each texel were touched. The real traffic is more
//! where data is read again after it fell out of the caches, and less where a stage touches only some of what it binds.

use crate::graph::{Graph, Shape, Usage, texel_bytes};
use crate::plan::Start;
use crate::scene::Scene;
use crate::schedule::{Cell, Schedule, Step};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Bytes of `dispatch_workgroups_indirect` and of `draw_indirect`.
const DISPATCH: u64 = 12;
const DRAW: u64 = 16;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Traffic {
    pub read_bytes: u64,
    pub written_bytes: u64,
}

impl Traffic {
    pub fn total(self) -> u64 {
        self.read_bytes.saturating_add(self.written_bytes)
    }

    pub fn and(self, other: Self) -> Self {
        Self {
            read_bytes: self.read_bytes.saturating_add(other.read_bytes),
            written_bytes: self.written_bytes.saturating_add(other.written_bytes),
        }
    }
}

/// By step of the schedule; `None` where a size is not known.
pub fn traffic(graph: &Graph, schedule: &Schedule, scene: &Scene) -> Vec<Option<Traffic>> {
    let mut cleared: BTreeSet<Cell> = BTreeSet::new();
    let steps = schedule.steps.iter().enumerate().map(|(index, step)| match step {
        Step::Start { item, cells, .. } => {
            let next = schedule.steps[index..].iter().find_map(|step| match step {
                Step::Run { task, .. } => Some(*task),
                Step::Start { .. } => None,
            });
            let targets = next.map(|task| drawn_into(graph, task)).unwrap_or_default();
            let mut written = Some(0);
            for cell in cells.iter().map(|cell| Cell { item: *item, cell: *cell }) {
                if targets.contains(&cell) {
                    cleared.insert(cell);
                } else if let Start::Fill(_) = graph.plan.resources[*item].start {
                    written = add(written, cell_bytes(graph, scene, cell));
                }
            }
            written.map(|written_bytes| Traffic { read_bytes: 0, written_bytes })
        }
        Step::Run { task, .. } => {
            let traffic = stage(graph, scene, *task, &cleared);
            cleared.clear();
            traffic
        }
    });
    steps.collect()
}

/// The cells that a stage draws into.
fn drawn_into(graph: &Graph, task: usize) -> BTreeSet<Cell> {
    let touches = graph.stages[task].linked.iter().flat_map(|linked| &linked.touches);
    let drawn = touches.filter(|touch| touch.write && matches!(touch.how, Usage::Color | Usage::Depth));
    let cells = drawn.flat_map(|touch| {
        let item = touch.reference.resource;
        graph.cells(&touch.reference).into_iter().map(move |cell| Cell { item, cell })
    });
    cells.collect()
}

fn stage(graph: &Graph, scene: &Scene, task: usize, cleared: &BTreeSet<Cell>) -> Option<Traffic> {
    let linked = graph.stages[task].linked.as_ref()?;
    let mut cells: BTreeMap<Cell, (bool, bool)> = BTreeMap::new();
    let mut arguments: BTreeSet<usize> = BTreeSet::new();
    for touch in &linked.touches {
        let item = touch.reference.resource;
        if touch.how == Usage::Indirect {
            arguments.insert(item);
            continue;
        }
        for cell in graph.cells(&touch.reference) {
            let cell = Cell { item, cell };
            let attached = matches!(touch.how, Usage::Color | Usage::Depth);
            let (read, write) = cells.entry(cell).or_default();
            *read |= touch.read && !(attached && cleared.contains(&cell));
            *write |= touch.write;
        }
    }
    let raster = matches!(linked.action, crate::graph::Action::Raster(_));
    let bound =
        |item: &usize| cells.range(Cell { item: *item, cell: 0 }..).next().is_some_and(|c| c.0.item == *item);
    let apart = arguments.iter().filter(|item| !bound(item)).count() as u64;
    let mut read = Some(apart * if raster { DRAW } else { DISPATCH });
    let mut written = Some(0);
    for (cell, (reads, writes)) in cells {
        let bytes = cell_bytes(graph, scene, cell);
        read = if reads { add(read, bytes) } else { read };
        written = if writes { add(written, bytes) } else { written };
    }
    Some(Traffic { read_bytes: read?, written_bytes: written? })
}

fn add(a: Option<u64>, b: Option<u64>) -> Option<u64> {
    Some(a?.saturating_add(b?))
}

/// Bytes of one mip of one layer, or of one slot of a buffer.
fn cell_bytes(graph: &Graph, scene: &Scene, cell: Cell) -> Option<u64> {
    let resource = graph.resources.get(cell.item)?;
    match &resource.shape {
        Shape::Texture(texture) => {
            let texels = texture.mip_size(cell.cell % resource.mips.max(1))?;
            texels.iter().try_fold(texel_bytes(texture.format), |all, n| all.checked_mul(u64::from(*n)))
        }
        Shape::Buffer(buffer) => buffer.bytes,
        Shape::Scene => Some(scene.bytes(&graph.plan.resources[cell.item].path)?.len() as u64),
        Shape::Unused => Some(0),
    }
}
