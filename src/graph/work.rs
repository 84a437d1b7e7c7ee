//! The graph as the scheduler sees it.

use super::{Graph, Shape, Usage};
use crate::plan::{self, Condition};
use crate::problem::Problem;
use crate::schedule::{Cell, FRAME, Item, Pool, Schedule, Start, Task, Touch, Work};
use rustc_hash::FxHashMap;

/// Byte ranges of one buffer start at multiples of this: the guaranteed `min_storage_buffer_offset_alignment`.
pub const ALIGNMENT: u64 = 256;

/// Items are the resources, by their id; tasks are the stages, in listed order.
pub fn work(graph: &Graph) -> Work {
    let mut alike = FxHashMap::default();
    let arguments = arguments(graph);
    let items =
        graph.plan.resources.iter().zip(&graph.resources).enumerate().map(|(id, (planned, resource))| Item {
            name: planned.path.clone(),
            cells: resource.mips * resource.layers * resource.slots,
            bytes: resource.bytes.unwrap_or(0),
            start: match &planned.start {
                plan::Start::Fill(_) => Start::Fill,
                plan::Start::Covered => Start::Covered,
                plan::Start::Kept { steady: true, .. } => Start::Steady,
                plan::Start::Kept { .. } => Start::Kept,
                plan::Start::Given => Start::Given,
            },
            pool: match &resource.shape {
                Shape::Texture(texture) => {
                    // Usage flags can be joined, so they keep nothing apart.
                    let mut key = texture.clone();
                    key.usage = wgpu_types::TextureUsages::empty();
                    let next = alike.len() as u32;
                    Pool::Alike(*alike.entry(key).or_insert(next))
                }
                // A vertex stage can't declare a buffer writable, and arguments can't be so declared in the stage that
                // takes them; both must be objects of their own.
                Shape::Buffer(buffer) if !buffer.vertex && !arguments.contains(&id) => {
                    Pool::Heap { heap: 0, alignment: ALIGNMENT }
                }
                _ => Pool::Alone,
            },
        });
    Work {
        items: items.collect(),
        tasks: graph.stages.iter().map(|stage| task(graph, stage)).collect(),
        outputs: graph
            .plan
            .outputs
            .iter()
            .flat_map(|(_, r, _)| graph.cells(r).into_iter().map(|cell| Cell { item: r.resource, cell }))
            .collect(),
    }
}

fn arguments(graph: &Graph) -> std::collections::BTreeSet<usize> {
    let linked = graph.stages.iter().filter_map(|s| s.linked.as_ref());
    let touches = linked.flat_map(|l| &l.touches).filter(|t| t.how == Usage::Indirect);
    touches.map(|t| t.reference.resource).collect()
}

fn task(graph: &Graph, stage: &super::Stage) -> Task {
    let mut task = Task {
        path: stage.path.clone(),
        touches: Vec::new(),
        depends: Default::default(),
        off: stage.off.clone(),
    };
    if let Some(linked) = &stage.linked {
        task.depends = linked.depends.clone();
        for touch in &linked.touches {
            // The two slots of a history change places in each frame, so both must be written and read in each.
            if graph.resources[touch.reference.resource].slots > 1 {
                task.depends.insert(FRAME);
            }
            for cell in graph.cells(&touch.reference) {
                let cell = Cell { item: touch.reference.resource, cell };
                task.touches.push(Touch { cell, read: touch.read, write: touch.write });
            }
        }
    }
    task
}

/// Live stages that read what no stage wrote, and outputs that none writes.
pub fn unwritten(graph: &Graph, schedule: &Schedule) -> Vec<Problem> {
    let mut problems: Vec<Problem> = Vec::new();
    for (task, cell) in &schedule.unwritten {
        let (stage, planned) = (&graph.stages[*task], &graph.plan.resources[cell.item]);
        let dropped: Vec<&str> = graph
            .stages
            .iter()
            .filter(|s| s.off.is_some())
            .filter(|s| {
                let touches = s.linked.iter().flat_map(|l| &l.touches);
                touches.into_iter().any(|t| t.write && t.reference.resource == cell.item)
            })
            .map(|s| s.path.as_str())
            .collect();
        let help = if dropped.is_empty() {
            "let a stage before it write all of it, or give it a start value: `start: Fill(0)`".to_owned()
        } else {
            format!(
                "what would write it is off ({}); put the reading behind the same condition (`@if` in the kernel), or say `start: Fill(0)`",
                dropped.join(", ")
            )
        };
        let problem = Problem::input(
            "read-before-written",
            format!("stage `{}` reads `{}` before anything has written it", stage.path, planned.path),
        )
        .at(&stage.place, "reads it")
        .at(&planned.place, "is `Covered`: undefined until written")
        .help(help);
        if !problems.iter().any(|p| p.labels == problem.labels) {
            problems.push(problem);
        }
    }
    for cell in &schedule.unwritten_outputs {
        let of = |(_, r, _): &&(String, plan::Reference, crate::problem::Place)| r.resource == cell.item;
        if let Some((name, _, place)) = graph.plan.outputs.iter().find(of) {
            let problem =
                Problem::input("unwritten-output", format!("no stage that runs writes the output `{name}`"))
                    .at(place, "named here")
                    .at(&graph.plan.resources[cell.item].place, "is `Covered`: undefined until written")
                    .help("let a stage write it, or give it a start value: `start: Fill(0)`");
            if !problems.contains(&problem) {
                problems.push(problem);
            }
        }
    }
    problems
}

/// The condition of a stage as `check` shows it when there is no scene.
pub fn undecided(graph: &Graph, stage: usize) -> Option<&str> {
    match &graph.plan.stages[stage].condition {
        Condition::Unknown(expression) => Some(expression),
        _ => None,
    }
}

/// All causes: what may change between frames if nothing is said.
pub fn all_causes() -> std::collections::BTreeSet<u32> {
    super::facts::CAUSES.map(super::facts::bit).into()
}
