//! Encodes and runs a frame. Nothing is allocated here once the first frame has run, except by wgpu itself.

use super::fill::FillOp;
use super::stage::{MadeDraw, MadeRaster, MadeStage, MadeWork};
use super::timer::{Clock, CpuTimes, Tick, Times};
use super::{Frame, Op};
use crate::device::Gpu;
use crate::problem::Problem;
use crate::schedule::{Changed, FRAME, Schedule};
use crate::zone::zone;
use std::collections::BTreeSet;
use wgpu::{
    CommandEncoder, CommandEncoderDescriptor, ComputePass, ComputePassDescriptor, ComputePipeline, QuerySet,
    RenderPassDescriptor,
};

/// What changed since the frame before.
#[derive(Clone, Debug, PartialEq)]
pub enum Changes {
    /// Everything runs.
    All,
    /// What depends on none of these bits is kept.
    Only(BTreeSet<u32>),
}

pub(super) struct State {
    /// By step.
    pub done: Vec<bool>,
    /// Frames since the last reset of everything.
    pub frame: u64,
    fresh: bool,
}

impl State {
    pub fn new(schedule: &Schedule) -> Self {
        Self { done: Vec::with_capacity(schedule.steps.len()), frame: 0, fresh: true }
    }
}

impl Frame {
    /// Runs one frame and waits for it. `changes` counts from the second frame on.
    pub fn run(&mut self, gpu: &Gpu, changes: &Changes) -> Result<&Times, Problem> {
        let _frame = zone!("frame");
        self.uniforms.facts.put_frame(self.state.frame as u32);
        self.uniforms.update(gpu);
        let changed = match changes {
            Changes::Only(bits) if !self.state.fresh => Changed::Only(bits),
            _ => Changed::All,
        };
        self.schedule.runs(changed, &mut self.state.done);
        let ran = match self.timer.clock {
            Clock::Timestamps => self.run_whole(gpu, changes),
            Clock::Wall(_) => self.run_apart(gpu, changes),
        };
        ran.map_err(|problem| self.blame(gpu, problem))?;
        self.end_steps();
        Ok(&self.timer.times)
    }

    /// Puts everything that is kept from frame to frame back to its first value; the next frame is number 0.
    pub fn reset(&mut self) {
        self.state.frame = 0;
        self.state.fresh = true;
    }

    /// Whether something is kept from frame to frame, so that a later frame is not an earlier one again.
    pub fn goes_on(&self) -> bool {
        self.resets.iter().any(|reset| !reset.steady)
    }

    /// What the begins and ends in [`Times::spans`] count.
    pub fn tick(&self) -> Tick {
        self.timer.tick
    }

    /// Which steps the last frame did.
    pub fn done(&self) -> &[bool] {
        &self.state.done
    }

    fn parity(&self) -> usize {
        (self.state.frame % 2) as usize
    }

    fn encode_resets(&self, encoder: &mut CommandEncoder, changes: &Changes) {
        for reset in &self.resets {
            let due = match changes {
                Changes::Only(bits) => reset.causes.iter().any(|c| *c != FRAME && bits.contains(c)),
                Changes::All => false,
            };
            if self.state.fresh || due {
                reset.fills.iter().for_each(|fill| fill.encode(encoder));
            }
        }
    }

    /// Encodes one step in a pass of its own.
    fn encode_step(&self, encoder: &mut CommandEncoder, step: usize) {
        match &self.ops[step] {
            Op::Fill(fills) => self.encode_fills(encoder, fills, step),
            Op::Stage(task) => {
                if let Some(stage) = &self.stages[*task] {
                    clear_counters(encoder, stage);
                    encode_stage(encoder, stage, self.timer.pass(step), self.parity());
                }
            }
        }
    }

    fn encode_fills(&self, encoder: &mut CommandEncoder, fills: &[FillOp], step: usize) {
        self.timer.mark(encoder, step, 0);
        fills.iter().for_each(|fill| fill.encode(encoder));
        self.timer.mark(encoder, step, 1);
    }

    /// Encodes all steps that are to be done. Compute stages that follow one another share a pass, where their times
    /// can be marked inside it: a pass costs the CPU more than a dispatch.
    fn encode_steps(&mut self, encoder: &mut CommandEncoder) {
        if !self.timer.joins {
            (0..self.ops.len())
                .filter(|step| self.state.done[*step])
                .for_each(|s| self.encode_step(encoder, s));
            return;
        }
        // Counters before everything, so that they end no pass.
        for (op, done) in self.ops.iter().zip(&self.state.done) {
            if let (Op::Stage(task), true) = (op, done)
                && let Some(stage) = &self.stages[*task]
            {
                clear_counters(encoder, stage);
            }
        }
        let mut open: Option<ComputePass<'static>> = None;
        let mut bound: Option<&ComputePipeline> = None;
        for step in (0..self.ops.len()).filter(|step| self.state.done[*step]) {
            match &self.ops[step] {
                Op::Fill(fills) if fills.is_empty() => {}
                Op::Fill(fills) => {
                    drop(open.take());
                    self.encode_fills(encoder, fills, step);
                }
                Op::Stage(task) => {
                    let Some(stage) = &self.stages[*task] else { continue };
                    if let MadeWork::Raster(_) = stage.work {
                        drop(open.take());
                        encode_stage(encoder, stage, self.timer.pass(step), self.parity());
                        continue;
                    }
                    self.timer.follows[step] = open.is_some();
                    if open.is_none() {
                        bound = None;
                    }
                    let pass = open.get_or_insert_with(|| {
                        let label = Some("compute");
                        encoder
                            .begin_compute_pass(&ComputePassDescriptor { label, timestamp_writes: None })
                            .forget_lifetime()
                    });
                    let marks = self.timer.pass(step);
                    if let (Some((set, first)), false) = (marks, self.timer.follows[step]) {
                        pass.write_timestamp(set, first);
                    }
                    let parity = (self.state.frame % 2) as usize;
                    encode_dispatch(pass, stage, parity, &mut bound);
                    if let Some((set, first)) = marks {
                        pass.write_timestamp(set, first + 1);
                    }
                }
            }
        }
    }

    /// Puts the stage's name to an error that the driver gave while a frame was encoded: the steps are encoded again,
    /// one by one.
    fn blame(&self, gpu: &Gpu, problem: Problem) -> Problem {
        for (step, op) in self.ops.iter().enumerate() {
            let mut encoder =
                gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("step") });
            self.encode_step(&mut encoder, step);
            drop(encoder.finish());
            if let (Err(found), Op::Stage(task)) = (gpu.check(), op) {
                let stage = &self.graph.stages[*task];
                let message = format!("stage `{}`: {}", stage.path, found.message);
                return Problem { message, ..found }.at(&stage.place, "this stage");
            }
        }
        problem
    }

    /// One encoder, one submission, timestamps.
    fn run_whole(&mut self, gpu: &Gpu, changes: &Changes) -> Result<(), Problem> {
        let begin = self.timer.now();
        let encoding = zone!("encode");
        let mut encoder =
            gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("frame") });
        self.encode_resets(&mut encoder, changes);
        self.encode_steps(&mut encoder);
        self.timer.resolve(&mut encoder);
        let commands = encoder.finish();
        drop(encoding);
        let submit = self.timer.now();
        let submitting = zone!("submit");
        gpu.queue.submit(std::iter::once(commands));
        drop(submitting);
        let submitted = self.timer.now();
        let _waiting = zone!("wait");
        let (ops, fills_marked) = (&self.ops, self.timer.fills);
        self.timer.collect(gpu, &self.state.done, |step| match &ops[step] {
            Op::Fill(fills) => fills_marked && !fills.is_empty(),
            Op::Stage(_) => true,
        })?;
        let times = &mut self.timer.times;
        times.cpu = CpuTimes { begin, submit, submitted, ..times.cpu };
        times.encode = (submitted - begin) as f64 / 1e6;
        Ok(())
    }

    /// Each step in a submission of its own, timed by the wall clock.
    fn run_apart(&mut self, gpu: &Gpu, changes: &Changes) -> Result<(), Problem> {
        let start = self.timer.now();
        let mut encoder =
            gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("resets") });
        self.encode_resets(&mut encoder, changes);
        gpu.queue.submit(std::iter::once(encoder.finish()));
        gpu.wait()?;
        let (mut all, mut encoding) = (0, 0);
        for step in 0..self.ops.len() {
            self.timer.put(step, None);
            if !self.state.done[step] {
                continue;
            }
            let begin = self.timer.now();
            self.submit_step(gpu, step);
            encoding += self.timer.now() - begin;
            gpu.wait()?;
            let end = self.timer.now();
            all += end - begin;
            self.timer.put(step, Some([begin, end]));
        }
        let done = self.timer.now();
        let times = &mut self.timer.times;
        times.cpu = CpuTimes { begin: start, submit: start, submitted: start, done };
        times.frame = Some(all as f64 / 1e6);
        times.encode = encoding as f64 / 1e6;
        Ok(())
    }

    /// Encodes and submits one step alone.
    pub(super) fn submit_step(&self, gpu: &Gpu, step: usize) {
        let mut encoder =
            gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("step") });
        self.encode_step(&mut encoder, step);
        gpu.queue.submit(std::iter::once(encoder.finish()));
    }

    /// Resets what is kept and prepares for steps submitted one by one.
    pub(super) fn begin_steps(&mut self, gpu: &Gpu) {
        self.uniforms.facts.put_frame(self.state.frame as u32);
        self.uniforms.update(gpu);
        self.schedule.runs(Changed::All, &mut self.state.done);
        let mut encoder =
            gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("resets") });
        self.encode_resets(&mut encoder, &Changes::All);
        gpu.queue.submit(std::iter::once(encoder.finish()));
    }

    /// Ends a frame whose steps were submitted one by one.
    pub(super) fn end_steps(&mut self) {
        self.state.frame += 1;
        self.state.fresh = false;
    }

    /// The history slot that the frame just run wrote.
    pub(super) fn written_slot(&self, resource: usize) -> usize {
        let slots = u64::from(self.graph.resources[resource].slots);
        (self.state.frame.wrapping_sub(1) % 2 % slots.max(1)) as usize
    }
}

fn clear_counters(encoder: &mut CommandEncoder, stage: &MadeStage) {
    if let Some((counters, _)) = &stage.counters {
        encoder.clear_buffer(counters, 0, None);
    }
}

/// Encodes a stage in a pass of its own.
fn encode_stage(
    encoder: &mut CommandEncoder,
    stage: &MadeStage,
    marks: Option<(&QuerySet, u32)>,
    parity: usize,
) {
    if let MadeWork::Raster(raster) = &stage.work {
        return encode_raster(encoder, stage, raster, marks, parity);
    }
    let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
        label: Some(&stage.path),
        timestamp_writes: marks.map(|(query_set, first)| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        }),
    });
    encode_dispatch(&mut pass, stage, parity, &mut None);
}

/// `bound`: the pass's pipeline, which is not set again.
fn encode_dispatch<'a>(
    pass: &mut ComputePass<'_>,
    stage: &'a MadeStage,
    parity: usize,
    bound: &mut Option<&'a ComputePipeline>,
) {
    let (MadeWork::Compute { pipeline, .. } | MadeWork::ComputeIndirect { pipeline, .. }) = &stage.work
    else {
        return;
    };
    if *bound != Some(pipeline) {
        pass.set_pipeline(pipeline);
        *bound = Some(pipeline);
    }
    pass.set_bind_group(0, stage.group(parity), &[]);
    match &stage.work {
        MadeWork::Compute { groups: [x, y, z], .. } => pass.dispatch_workgroups(*x, *y, *z),
        MadeWork::ComputeIndirect { buffer, offset, .. } => {
            pass.dispatch_workgroups_indirect(buffer, *offset)
        }
        MadeWork::Raster(_) => {}
    }
}

/// Color targets that every adapter allows.
const MOST_TARGETS: usize = 8;

fn encode_raster(
    encoder: &mut CommandEncoder,
    stage: &MadeStage,
    raster: &MadeRaster,
    marks: Option<(&QuerySet, u32)>,
    parity: usize,
) {
    let mut colors = [const { None }; MOST_TARGETS];
    for (slot, color) in colors.iter_mut().zip(&raster.colors) {
        *slot = color.as_ref().and_then(|c| c.color(parity));
    }
    let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some(&stage.path),
        color_attachments: &colors[..raster.colors.len().min(MOST_TARGETS)],
        depth_stencil_attachment: raster.depth.as_ref().and_then(|d| d.depth(parity)),
        timestamp_writes: marks.map(|(query_set, first)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        }),
        ..Default::default()
    });
    pass.set_pipeline(&raster.pipeline);
    pass.set_bind_group(0, stage.group(parity), &[]);
    match &raster.draw {
        MadeDraw::Vertices(range) => pass.draw(range.clone(), 0..1),
        MadeDraw::Indirect(buffer, offset) => pass.draw_indirect(buffer, *offset),
    }
}
