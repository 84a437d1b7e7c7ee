//! The frame: a schedule made into GPU objects, and run.
//!
//! [`Frame::realise`] makes textures, buffers, pipelines and bind groups once; [`Frame::run`] encodes one frame from
//! them without allocating anything of its own.

pub mod calibrate;
mod convert;
mod fill;
mod group;
pub mod layout;
mod memory;
mod pipeline;
mod readback;
mod run;
mod scan;
mod stage;
#[cfg(test)]
mod tests;
mod timer;
mod uniforms;

pub use fill::Poison;
pub use readback::Image;
pub use run::Changes;
pub use scan::Finding;
pub use timer::{Clock, CpuTimes, Tick, Times};

use crate::device::Gpu;
use crate::graph::{self, Graph};
use crate::problem::Result;
use crate::scene::Scene;
use crate::schedule::{Schedule, Step};
use fill::FillOp;
use std::sync::Arc;

/// What is realised, and how.
pub struct Setup<'a> {
    pub gpu: &'a Gpu,
    pub scene: &'a Scene,
    /// Memory whose content is undefined is filled with this before each use.
    pub poison: Option<Poison>,
    pub clock: Clock,
}

pub struct Frame {
    pub graph: Arc<Graph>,
    pub schedule: Schedule,
    made: memory::Made,
    stages: Vec<Option<stage::MadeStage>>,
    ops: Vec<Op>,
    uniforms: uniforms::Uniforms,
    /// Fills that put Kept resources to their first value.
    resets: Vec<Reset>,
    timer: timer::Timer,
    state: run::State,
}

/// What a step of the schedule encodes; a fill may be empty, where a stage's load does it.
enum Op {
    Fill(Vec<FillOp>),
    Stage(usize),
}

struct Reset {
    causes: std::collections::BTreeSet<u32>,
    /// A later frame is an earlier one again, as far as this goes.
    steady: bool,
    fills: Vec<FillOp>,
}

impl Frame {
    /// Makes all GPU objects. Errors of the driver come with the stage's or resource's name.
    pub fn realise(graph: Arc<Graph>, schedule: Schedule, setup: &Setup<'_>) -> Result<Self> {
        let gpu = setup.gpu;
        let made = memory::make(&graph, &schedule, setup)?;
        let mut stages: Vec<Option<stage::MadeStage>> = Vec::new();
        stages.resize_with(graph.stages.len(), || None);
        let mut maker = stage::Maker::new(gpu, &graph, &schedule, &made);
        for step in &schedule.steps {
            if let Step::Run { task, .. } = step {
                stages[*task] = Some(maker.make(*task)?);
            }
        }
        let uniforms = maker.finish();
        let filler = fill::Filler::new(setup, &graph, &made);
        let mut ops = Vec::with_capacity(schedule.steps.len());
        for (index, step) in schedule.steps.iter().enumerate() {
            ops.push(match step {
                Step::Run { task, .. } => Op::Stage(*task),
                Step::Start { item, cells, .. } => {
                    let mut cells = cells.clone();
                    // The first stage that touches the cells can clear them as it loads them, if it draws into them.
                    let next = schedule.steps[index..].iter().find_map(|step| match step {
                        Step::Run { task, .. } => Some(*task),
                        Step::Start { .. } => None,
                    });
                    if let Some(stage) = next.and_then(|task| stages[task].as_mut())
                        && let Some(value) = filler.clear_value(*item)
                    {
                        cells.retain(|cell| !stage.clear(*item, *cell, value));
                    }
                    Op::Fill(filler.fills(*item, &cells)?)
                }
            });
        }
        let resets = filler.resets()?;
        let timer = timer::Timer::new(gpu, schedule.steps.len(), setup.clock.clone());
        let state = run::State::new(&schedule);
        gpu.wait()?;
        Ok(Self { graph, schedule, made, stages, ops, uniforms, resets, timer, state })
    }

    /// Brings the scene's buffer `name` up to date, if some stage binds it.
    pub fn update_scene(&self, gpu: &Gpu, scene: &Scene, name: &str) {
        let named = |planned: &crate::plan::PlannedResource| {
            planned.kind == crate::plan::ResourceKind::Scene && planned.path == name
        };
        let id = self.graph.plan.resources.iter().position(named);
        if let Some((buffer, offset, _)) = id.and_then(|id| self.made.buffer(id, 0))
            && let Some(bytes) = scene.bytes(name)
        {
            gpu.queue.write_buffer(buffer, *offset, &bytes);
        }
    }

    /// The table of facts that uniforms are filled from; write to it before [`Frame::run`].
    pub fn facts(&mut self) -> &mut graph::facts::FactTable {
        &mut self.uniforms.facts
    }
}
