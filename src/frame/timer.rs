//! Timestamps: one pair for each step of the schedule.

use crate::device::Gpu;
use crate::problem::Problem;
use std::time::Instant;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Features, QuerySet};

/// Steps that one query set has room for: sets hold 4096 timestamps at most.
const STEPS_PER_SET: usize = 2048;

/// How stages are timed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Clock {
    /// By the GPU's timestamps.
    Timestamps,
    /// By submitting each stage alone and waiting for it, for this reason.
    Wall(String),
}

impl Clock {
    pub fn name(&self) -> &'static str {
        match self {
            Clock::Timestamps => "gpu timestamps",
            Clock::Wall(_) => "wall clock",
        }
    }
}

/// Times of one frame in ms, by step of the schedule. `None`: not run in this frame, or not known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times {
    pub steps: Vec<Option<f64>>,
    /// From the first step's begin to the last one's end.
    pub frame: Option<f64>,
    /// CPU time to encode and submit.
    pub encode: f64,
    /// Begin and end of each step whose time is known, in ticks of its clock: see [`Tick`].
    pub spans: Vec<Option<[u64; 2]>>,
    pub cpu: CpuTimes,
}

/// What the CPU did for a frame and when, in ns since the frame was realised. By the wall clock, stages are encoded,
/// submitted and waited for one by one: all of that then lies between `submitted` and `done`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CpuTimes {
    /// Encoding begins.
    pub begin: u64,
    /// All is encoded, and goes to the queue.
    pub submit: u64,
    /// The queue has it.
    pub submitted: u64,
    /// The GPU is known to have ended.
    pub done: u64,
}

/// What the numbers in [`Times::spans`] count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    pub nanoseconds: f64,
    /// They count from the moment from which [`CpuTimes`] does; otherwise from one that is the GPU's own.
    pub of_cpu: bool,
}

pub struct Timer {
    pub clock: Clock,
    sets: Vec<QuerySet>,
    resolved: Option<Buffer>,
    read: Option<Buffer>,
    pub tick: Tick,
    epoch: Instant,
    /// Fills are timed from outside passes, where the adapter can.
    pub fills: bool,
    /// Whether one compute pass can hold several steps: their times are then marked inside of it.
    pub joins: bool,
    /// By step: it follows the step before in one pass, and begins where that one ends.
    pub follows: Vec<bool>,
    pub times: Times,
}

impl Timer {
    pub fn new(gpu: &Gpu, steps: usize, clock: Clock) -> Self {
        let on = clock == Clock::Timestamps;
        let sets = if on { steps.div_ceil(STEPS_PER_SET) } else { 0 };
        let sets = (0..sets)
            .map(|i| {
                let count = (steps - i * STEPS_PER_SET).min(STEPS_PER_SET);
                gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("timestamps"),
                    ty: wgpu::QueryType::Timestamp,
                    count: 2 * count as u32,
                })
            })
            .collect();
        let buffer = |usage| {
            (on && steps > 0).then(|| {
                gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("timestamps"),
                    size: 16 * steps as u64,
                    usage,
                    mapped_at_creation: false,
                })
            })
        };
        Self {
            resolved: buffer(BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            read: buffer(BufferUsages::COPY_DST | BufferUsages::MAP_READ),
            sets,
            tick: Tick {
                nanoseconds: if on { f64::from(gpu.queue.get_timestamp_period()) } else { 1.0 },
                of_cpu: !on,
            },
            epoch: Instant::now(),
            fills: on && gpu.has(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS),
            joins: on && gpu.has(Features::TIMESTAMP_QUERY_INSIDE_PASSES),
            follows: vec![false; steps],
            times: Times { steps: vec![None; steps], spans: vec![None; steps], ..Times::default() },
            clock,
        }
    }

    /// Nanoseconds since the timer was made.
    pub fn now(&self) -> u64 {
        u64::try_from(self.epoch.elapsed().as_nanos()).unwrap_or(u64::MAX)
    }

    /// Ticks in milliseconds.
    fn ms(&self, ticks: u64) -> f64 {
        ticks as f64 * self.tick.nanoseconds / 1e6
    }

    /// Puts down when a step began and ended.
    pub fn put(&mut self, step: usize, span: Option<[u64; 2]>) {
        self.times.spans[step] = span;
        self.times.steps[step] = span.map(|[begin, end]| self.ms(end - begin));
    }

    /// The query set and first query of a step's pass.
    pub fn pass(&self, step: usize) -> Option<(&QuerySet, u32)> {
        let set = self.sets.get(step / STEPS_PER_SET)?;
        Some((set, 2 * (step % STEPS_PER_SET) as u32))
    }

    /// Marks the begin (0) or end (1) of a step outside of passes.
    pub fn mark(&self, encoder: &mut CommandEncoder, step: usize, end: u32) {
        if self.fills
            && let Some((set, first)) = self.pass(step)
        {
            encoder.write_timestamp(set, first + end);
        }
    }

    /// Encodes the way of the timestamps to where the CPU can read them.
    pub fn resolve(&self, encoder: &mut CommandEncoder) {
        let (Some(resolved), Some(read)) = (&self.resolved, &self.read) else { return };
        for (i, set) in self.sets.iter().enumerate() {
            let count = (self.times.steps.len() - i * STEPS_PER_SET).min(STEPS_PER_SET) as u32;
            encoder.resolve_query_set(set, 0..2 * count, resolved, (16 * i * STEPS_PER_SET) as u64);
        }
        encoder.copy_buffer_to_buffer(resolved, 0, read, 0, resolved.size());
    }

    /// Reads the times of a frame that has ended. `done[step]`: the step ran; `marked(step)`: it has its marks then.
    pub fn collect(
        &mut self,
        gpu: &Gpu,
        done: &[bool],
        marked: impl Fn(usize) -> bool,
    ) -> Result<(), Problem> {
        let Some(read) = &self.read else { return Ok(()) };
        read.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        gpu.wait()?;
        self.times.cpu.done = self.now();
        let (mut first, mut last) = (u64::MAX, 0);
        {
            let bytes = read
                .slice(..)
                .get_mapped_range()
                .map_err(|e| crate::device::fault(&format!("reading timestamps: {e}")))?;
            let tick = |i: usize| {
                let at = 8 * i;
                bytes.get(at..at + 8).and_then(|b| b.try_into().ok()).map(u64::from_le_bytes)
            };
            let mut before = None;
            for (step, span) in self.times.spans.iter_mut().enumerate() {
                *span = None;
                if !done.get(step).copied().unwrap_or(false) || !marked(step) {
                    continue;
                }
                let begin = if self.follows[step] { before } else { tick(2 * step) };
                let end = tick(2 * step + 1);
                before = end;
                if let (Some(begin), Some(end)) = (begin, end)
                    && begin > 0
                    && end >= begin
                {
                    *span = Some([begin, end]);
                    (first, last) = (first.min(begin), last.max(end));
                }
            }
        }
        read.unmap();
        for step in 0..self.times.spans.len() {
            self.put(step, self.times.spans[step]);
        }
        self.times.frame = (last > first).then(|| self.ms(last - first));
        Ok(())
    }
}
