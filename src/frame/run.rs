//! Encodes and runs a frame. Nothing is allocated here once the first frame has run, except by wgpu itself.

use super::stage::{MadeDraw, MadeRaster, MadeStage, MadeWork};
use super::timer::{Clock, Timer, Times};
use super::{Frame, Op};
use crate::device::Gpu;
use crate::problem::Problem;
use crate::schedule::{Changed, FRAME, Schedule};
use std::collections::BTreeSet;
use std::time::Instant;
use wgpu::{CommandEncoder, CommandEncoderDescriptor, ComputePassDescriptor, RenderPassDescriptor};

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
        self.uniforms.facts.put_frame(self.state.frame as u32);
        self.uniforms.update(gpu);
        let changed = match changes {
            Changes::Only(bits) if !self.state.fresh => Changed::Only(bits),
            _ => Changed::All,
        };
        self.schedule.runs(changed, &mut self.state.done);
        match self.timer.clock {
            Clock::Timestamps => self.run_whole(gpu, changes)?,
            Clock::Wall(_) => self.run_apart(gpu, changes)?,
        }
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
        !self.resets.is_empty()
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

    fn encode_step(&self, encoder: &mut CommandEncoder, step: usize) {
        match &self.ops[step] {
            Op::Fill(fills) => {
                self.timer.mark(encoder, step, 0);
                fills.iter().for_each(|fill| fill.encode(encoder));
                self.timer.mark(encoder, step, 1);
            }
            Op::Stage(task) => {
                if let Some(stage) = &self.stages[*task] {
                    if let Some((counters, _)) = &stage.counters {
                        encoder.clear_buffer(counters, 0, None);
                    }
                    encode_stage(encoder, stage, &self.timer, step, self.parity());
                }
            }
        }
    }

    /// One encoder, one submission, timestamps.
    fn run_whole(&mut self, gpu: &Gpu, changes: &Changes) -> Result<(), Problem> {
        let begin = Instant::now();
        let mut encoder =
            gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("frame") });
        self.encode_resets(&mut encoder, changes);
        for step in 0..self.ops.len() {
            if self.state.done[step] {
                self.encode_step(&mut encoder, step);
            }
        }
        self.timer.resolve(&mut encoder);
        gpu.queue.submit(std::iter::once(encoder.finish()));
        let encode = begin.elapsed().as_secs_f64() * 1e3;
        let ops = &self.ops;
        self.timer.collect(gpu, &self.state.done, |step| matches!(ops[step], Op::Fill(_)))?;
        self.timer.times.encode = encode;
        Ok(())
    }

    /// Each step in a submission of its own, timed by the wall clock.
    fn run_apart(&mut self, gpu: &Gpu, changes: &Changes) -> Result<(), Problem> {
        let mut encoder =
            gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("resets") });
        self.encode_resets(&mut encoder, changes);
        gpu.queue.submit(std::iter::once(encoder.finish()));
        gpu.wait()?;
        let (mut all, mut encoding) = (0.0, 0.0);
        for step in 0..self.ops.len() {
            self.timer.times.steps[step] = None;
            if !self.state.done[step] {
                continue;
            }
            let begin = Instant::now();
            self.submit_step(gpu, step);
            encoding += begin.elapsed().as_secs_f64() * 1e3;
            gpu.wait()?;
            let time = begin.elapsed().as_secs_f64() * 1e3;
            all += time;
            self.timer.times.steps[step] = Some(time);
        }
        self.timer.times.frame = Some(all);
        self.timer.times.encode = encoding;
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

fn encode_stage(encoder: &mut CommandEncoder, stage: &MadeStage, timer: &Timer, step: usize, parity: usize) {
    let Some(group) = stage.groups.get(parity).or(stage.groups.first()) else { return };
    match &stage.work {
        MadeWork::Raster(raster) => encode_raster(encoder, stage, raster, group, timer.pass(step), parity),
        work => {
            let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
                label: Some(&stage.path),
                timestamp_writes: timer.pass(step).map(|(query_set, first)| {
                    wgpu::ComputePassTimestampWrites {
                        query_set,
                        beginning_of_pass_write_index: Some(first),
                        end_of_pass_write_index: Some(first + 1),
                    }
                }),
            });
            pass.set_bind_group(0, group, &[]);
            match work {
                MadeWork::Compute { pipeline, groups: [x, y, z] } => {
                    pass.set_pipeline(pipeline);
                    pass.dispatch_workgroups(*x, *y, *z);
                }
                MadeWork::ComputeIndirect { pipeline, buffer, offset } => {
                    pass.set_pipeline(pipeline);
                    pass.dispatch_workgroups_indirect(buffer, *offset);
                }
                MadeWork::Raster(_) => {}
            }
        }
    }
}

/// Color targets that every adapter allows.
const MOST_TARGETS: usize = 8;

fn encode_raster(
    encoder: &mut CommandEncoder,
    stage: &MadeStage,
    raster: &MadeRaster,
    group: &wgpu::BindGroup,
    timestamps: Option<(&wgpu::QuerySet, u32)>,
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
        timestamp_writes: timestamps.map(|(query_set, first)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        }),
        ..Default::default()
    });
    pass.set_pipeline(&raster.pipeline);
    pass.set_bind_group(0, group, &[]);
    match &raster.draw {
        MadeDraw::Vertices(count) => pass.draw(0..*count, 0..1),
        MadeDraw::Indirect(buffer, offset) => pass.draw_indirect(buffer, *offset),
    }
}
