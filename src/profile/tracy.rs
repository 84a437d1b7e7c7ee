//! A run for the Tracy profiler: a GPU context with zones for parts and stages, a mark for each frame, counters as plots.
//! The CPU's zones are where the frame is encoded (`zone!`).
//!
//! Tracy learns a stage's times when its frame has ended, so that zones appear then; where they lie is told by the
//! GPU's own timestamps. The two clocks are tied by the first frame, in the middle of what its bracket leaves open
//! ([`align`](super::align::align)).

use super::align::{Bracket, align};
use super::trace::names;
use crate::frame::{Frame, Times};
use std::collections::BTreeMap;
use tracy_client::{Client, GpuContext, GpuContextType, PlotName};

pub struct Tracks {
    client: Client,
    /// Made with the first frame of which a time is known.
    gpu: Option<GpuContext>,
    /// By step.
    names: Vec<String>,
    plots: BTreeMap<String, PlotName>,
    /// The next query; Tracy knows timestamps by such a number, and each is free again when its time is told.
    query: u16,
}

impl Tracks {
    pub fn start(frame: &Frame) -> Self {
        let names = names(&frame.graph, &frame.schedule.steps);
        Self { client: Client::start(), gpu: None, names, plots: BTreeMap::new(), query: 0 }
    }

    /// A frame has ended just now.
    pub fn frame(&mut self, frame: &Frame, times: &Times, counters: &[(String, u32)]) {
        self.client.frame_mark();
        if self.gpu.is_none() {
            self.gpu = context(&self.client, frame, times);
        }
        if let Some(gpu) = &self.gpu {
            let mut steps: Vec<(&str, [u64; 2])> = self
                .names
                .iter()
                .zip(&times.spans)
                .filter_map(|(name, span)| Some((name.as_str(), (*span)?)))
                .collect();
            steps.sort_by_key(|(_, span)| *span);
            for (name, [begin, end]) in steps {
                let [first, second] = [self.query, self.query.wrapping_add(1)];
                self.query = self.query.wrapping_add(2);
                gpu.begin_span_alloc(name, name, "pipeline", 0, first);
                gpu.end_span(second);
                gpu.upload_gpu_timestamp(first, begin.cast_signed());
                gpu.upload_gpu_timestamp(second, end.cast_signed());
            }
        }
        for (counter, count) in counters {
            let plot =
                self.plots.entry(counter.clone()).or_insert_with(|| PlotName::new_leak(counter.clone()));
            self.client.plot(*plot, f64::from(*count));
        }
    }
}

/// A context whose clock is tied to the CPU's by this frame, which has ended just now.
fn context(client: &Client, frame: &Frame, times: &Times) -> Option<GpuContext> {
    let tick = frame.tick();
    let spans = || times.spans.iter().flatten();
    let origin = spans().map(|span| span[0]).min()?;
    let last = spans().map(|span| span[1]).max()?;
    let ns = |ticks: u64| (ticks.saturating_sub(origin) as f64 * tick.nanoseconds) as i64;
    let [submit, done] = [times.cpu.submit, times.cpu.done].map(u64::cast_signed);
    let bracket = Bracket { submit, done, first: 0, last: ns(last) };
    let offset = align(&[bracket]).offsets.first().copied().unwrap_or_default();
    let now = ((done - offset) as f64 / tick.nanoseconds) as i64;
    let now = origin.cast_signed().saturating_add(now);
    let period = tick.nanoseconds as f32;
    let context = client.clone().new_gpu_context(Some("stages"), GpuContextType::Vulkan, now, period);
    context.ok()
}
