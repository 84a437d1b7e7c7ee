//! A run as a trace in the Trace Event Format, which Perfetto and Chrome's viewer open.
//!
//! One process, named after the adapter. Its tracks:
//! * `GPU`: a slice for each frame; in it the parts of the pipeline, as far as their stages follow one another; in
//!   those the stages. Where work overlaps, what does not fit goes to `GPU 2` and so on, so that slices always nest.
//! * `CPU`: encoding, submission and waiting, in a slice for each frame.
//! * a counter track for each counter of a stage.
//!
//! Times are µs since encoding of the first frame that counts. Those of the GPU are put on the CPU's clock as
//! [`align`](super::align::align) says; how far off they can be stands in `otherData`.

mod slices;

use super::align::{Alignment, Bracket, align};
use super::run::Ran;
use crate::frame::{Frame, Tick, Times};
use crate::graph::Graph;
use crate::schedule::Step;
use serde::Serialize;
use serde_json::{Map, Value, json};
use slices::{Lane, Slice, lanes, nested};

#[derive(Serialize)]
pub struct Trace {
    #[serde(rename = "displayTimeUnit")]
    unit: &'static str,
    #[serde(rename = "otherData")]
    about: Map<String, Value>,
    #[serde(rename = "traceEvents")]
    pub events: Vec<Event>,
}

#[derive(Serialize)]
pub struct Event {
    pub name: String,
    pub ph: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ts: Option<f64>,
    pub pid: u32,
    pub tid: u32,
    #[serde(skip_serializing_if = "Map::is_empty")]
    pub args: Map<String, Value>,
}

/// What names the trace.
pub struct About<'a> {
    pub adapter: &'a str,
    pub driver: &'a str,
    pub pipeline: &'a str,
    pub scene: &'a str,
    pub clock: &'a str,
}

const PROCESS: u32 = 1;
const CPU: u32 = 1;
/// The first of the GPU's tracks.
const GPU: u32 = 2;

pub fn trace(frame: &Frame, ran: &Ran, about: &About<'_>) -> Trace {
    let names = names(&frame.graph, &frame.schedule.steps);
    build(&names, &ran.samples.frames, &ran.counters, frame.tick(), about)
}

/// By step, what its slice is called: a stage's path, or what is filled below `fill/`.
pub(super) fn names(graph: &Graph, steps: &[Step]) -> Vec<String> {
    let name = |step: &Step| match step {
        Step::Run { task, .. } => graph.stages[*task].path.clone(),
        Step::Start { item, .. } => format!("fill/{}", graph.plan.resources[*item].path),
    };
    steps.iter().map(name).collect()
}

/// The trace of `frames`, whose steps have these `names`; `counters` by frame, or none.
pub fn build(
    names: &[String],
    frames: &[Times],
    counters: &[Vec<(String, u32)>],
    tick: Tick,
    about: &About<'_>,
) -> Trace {
    let start = frames.first().map_or(0, |times| times.cpu.begin);
    let cpu = |ns: u64| ns.cast_signed().wrapping_sub(start.cast_signed());
    let (spans, alignment) = on_cpu(frames, tick, start);
    let mut events = vec![meta("process_name", CPU, about.adapter), meta("thread_name", CPU, "CPU")];
    let mut gpu: Vec<Lane> = Vec::new();
    for (index, (times, spans)) in frames.iter().zip(&spans).enumerate() {
        let name = format!("frame {index}");
        let cpu_times = times.cpu;
        let mut inner = vec![
            ("encode", cpu_times.begin, cpu_times.submit),
            ("submit", cpu_times.submit, cpu_times.submitted),
            ("wait", cpu_times.submitted, cpu_times.done),
        ];
        inner.retain(|(_, begin, end)| begin < end);
        let inner = inner.into_iter().map(|(name, begin, end)| Slice::new(name, cpu(begin), cpu(end)));
        let whole = Slice::new(&name, cpu(cpu_times.begin), cpu(cpu_times.done));
        events.extend(begin_and_end(CPU, &nested(Some(whole), inner.collect())));
        let steps = names
            .iter()
            .zip(spans)
            .filter_map(|(name, span)| span.map(|[begin, end]| Slice::new(name, begin, end)));
        lanes(&name, steps.collect(), &mut gpu);
        for (counter, count) in counters.get(index).into_iter().flatten() {
            let args = Map::from_iter([("count".to_owned(), json!(count))]);
            let ts = Some(micros(cpu(cpu_times.done)));
            events.push(Event { name: counter.clone(), ph: "C", ts, pid: PROCESS, tid: 0, args });
        }
    }
    for (index, lane) in gpu.iter().enumerate() {
        let tid = GPU + index as u32;
        let name = if index == 0 { "GPU".to_owned() } else { format!("GPU {}", index + 1) };
        events.push(meta("thread_name", tid, &name));
        events.extend(begin_and_end(tid, &lane.slices));
    }
    Trace { unit: "ms", about: data(about, &alignment), events }
}

fn data(about: &About<'_>, alignment: &Alignment) -> Map<String, Value> {
    Map::from_iter([
        ("adapter".to_owned(), json!(about.adapter)),
        ("driver".to_owned(), json!(about.driver)),
        ("pipeline".to_owned(), json!(about.pipeline)),
        ("scene".to_owned(), json!(about.scene)),
        ("clock".to_owned(), json!(about.clock)),
        ("gpu_within_us".to_owned(), json!(alignment.within as f64 / 1e3)),
        ("gpu_clock_steady".to_owned(), json!(alignment.steady)),
    ])
}

/// By frame and step, begin and end in ns since `start` on the CPU's clock.
fn on_cpu(frames: &[Times], tick: Tick, start: u64) -> (Vec<Vec<Option<[i64; 2]>>>, Alignment) {
    let known = |times: &Times| times.spans.iter().flatten().copied().collect::<Vec<[u64; 2]>>();
    let first = |times: &Times| known(times).iter().map(|span| span[0]).min();
    // Ticks may count from anywhere: differences from the first keep their precision.
    let origin = if tick.of_cpu { start } else { frames.iter().find_map(first).unwrap_or(0) };
    let ns = |ticks: u64| (ticks.wrapping_sub(origin).cast_signed() as f64 * tick.nanoseconds) as i64;
    let signed = |at: u64| at.cast_signed().wrapping_sub(start.cast_signed());
    let alignment = if tick.of_cpu {
        Alignment { offsets: vec![0; frames.len()], within: 0, steady: true }
    } else {
        let (submit, done) = (|t: &Times| signed(t.cpu.submit), |t: &Times| signed(t.cpu.done));
        let brackets: Vec<Bracket> = frames
            .iter()
            .map(|times| {
                let spans = known(times);
                let begin = spans.iter().map(|span| ns(span[0])).min();
                let end = spans.iter().map(|span| ns(span[1])).max();
                // A frame of which nothing is known bounds nothing.
                let (first, last) = begin.zip(end).unwrap_or((i64::MAX / 4, i64::MIN / 4));
                Bracket { submit: submit(times), done: done(times), first, last }
            })
            .collect();
        align(&brackets)
    };
    let spans = frames.iter().zip(&alignment.offsets).map(|(times, offset)| {
        let put = |ticks: u64| ns(ticks).saturating_add(*offset);
        times.spans.iter().map(|span| span.map(|[begin, end]| [put(begin), put(end)])).collect()
    });
    (spans.collect(), alignment)
}

/// Slices in order as pairs of events; a slice ends before what begins at the same time.
fn begin_and_end(tid: u32, slices: &[Slice]) -> Vec<Event> {
    let event = |name: &str, ph, at| {
        let (name, ts) = (name.to_owned(), Some(micros(at)));
        Event { name, ph, ts, pid: PROCESS, tid, args: Map::new() }
    };
    let mut events = Vec::with_capacity(2 * slices.len());
    let mut open: Vec<&Slice> = Vec::new();
    for slice in slices {
        while let Some(ended) = open.pop_if(|top| top.depth >= slice.depth) {
            events.push(event(&ended.name, "E", ended.end));
        }
        events.push(event(&slice.name, "B", slice.begin));
        open.push(slice);
    }
    events.extend(open.iter().rev().map(|ended| event(&ended.name, "E", ended.end)));
    events
}

fn meta(what: &str, tid: u32, name: &str) -> Event {
    let args = Map::from_iter([("name".to_owned(), json!(name))]);
    Event { name: what.to_owned(), ph: "M", ts: None, pid: PROCESS, tid, args }
}

fn micros(ns: i64) -> f64 {
    ns as f64 / 1e3
}
