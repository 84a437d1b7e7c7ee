//! Traces, read back by a checker of the format: names, nesting, times.

use proptest::prelude::*;
use serde_json::Value;
use std::collections::BTreeMap;
use voxgi::frame::{CpuTimes, Tick, Times};
use voxgi::profile::trace::{About, build};

/// A slice as read: track, names from the outermost to its own, begin and end in ns.
#[derive(Clone, Debug, PartialEq)]
pub struct Read {
    pub track: String,
    pub names: Vec<String>,
    pub begin: i64,
    pub end: i64,
}

/// The slices of a trace and the number of its counter samples.
///
/// Refused: an event without what its kind needs; an end that is not that of the innermost open slice; a time before
/// that of the event before on the same track; a slice left open; a track or process without a name.
pub fn read(trace: &Value) -> Result<(Vec<Read>, usize), String> {
    let events = trace["traceEvents"].as_array().ok_or("no events")?;
    let mut tracks: BTreeMap<(u64, u64), String> = BTreeMap::new();
    let mut processes = 0;
    for event in events.iter().filter(|event| event["ph"] == "M") {
        let name = event["args"]["name"].as_str().ok_or(format!("{event} names nothing"))?.to_owned();
        let key = (event["pid"].as_u64().ok_or("pid")?, event["tid"].as_u64().ok_or("tid")?);
        match event["name"].as_str() {
            Some("process_name") => processes += 1,
            Some("thread_name") => drop(tracks.insert(key, name)),
            other => return Err(format!("{other:?}")),
        }
    }
    if processes != 1 {
        return Err(format!("{processes} processes"));
    }
    let mut open: BTreeMap<(u64, u64), Vec<(String, i64)>> = BTreeMap::new();
    let mut last: BTreeMap<(u64, u64), f64> = BTreeMap::new();
    let (mut slices, mut counts) = (Vec::new(), 0);
    for event in events.iter().filter(|event| event["ph"] != "M") {
        let key = (event["pid"].as_u64().ok_or("pid")?, event["tid"].as_u64().ok_or("tid")?);
        let ts = event["ts"].as_f64().ok_or(format!("{event} has no time"))?;
        let name = event["name"].as_str().ok_or(format!("{event} has no name"))?.to_owned();
        if event["ph"] == "C" {
            counts += usize::from(event["args"]["count"].is_u64());
            continue;
        }
        if ts < last.insert(key, ts).unwrap_or(f64::NEG_INFINITY) {
            return Err(format!("{event} goes back in time"));
        }
        let ns = (ts * 1e3).round() as i64;
        let stack = open.entry(key).or_default();
        match event["ph"].as_str() {
            Some("B") => stack.push((name, ns)),
            Some("E") => {
                let names = stack.iter().map(|(name, _)| name.clone()).collect();
                let (began, begin) = stack.pop().ok_or(format!("{event} ends nothing"))?;
                if began != name {
                    return Err(format!("{event} ends {began}"));
                }
                let track = tracks.get(&key).ok_or(format!("{event} is on no named track"))?.clone();
                slices.push(Read { track, names, begin, end: ns });
            }
            other => return Err(format!("{other:?}")),
        }
    }
    match open.values().flatten().next() {
        Some(left) => Err(format!("{left:?} never ends")),
        None => Ok((slices, counts)),
    }
}

const ABOUT: About<'_> =
    About { adapter: "adapter", driver: "driver", pipeline: "p", scene: "s", clock: "gpu timestamps" };

const NAMES: [&str; 6] = ["a/one", "a/two", "fill/x", "b/c/three", "b/c/four", "five"];

/// Frames whose steps begin a while after the one before began: before or after it ended.
fn frames() -> impl Strategy<Value = Vec<Times>> {
    let step = (0..200_000u64, 0..300_000u64, prop::bool::weighted(0.9));
    let frame = prop::collection::vec(step, NAMES.len());
    prop::collection::vec(frame, 1..6).prop_map(|frames| {
        let mut now = 5_000;
        let mut all = Vec::new();
        for steps in frames {
            let begin = now;
            let mut at = now + 3000;
            let mut end = at;
            let spans = steps.iter().map(|(gap, length, known)| {
                at += gap;
                end = end.max(at + length);
                known.then_some([at + GPU_ORIGIN, at + length + GPU_ORIGIN])
            });
            let spans = spans.collect();
            now = end + 1000;
            let cpu = CpuTimes { begin, submit: begin + 1000, submitted: begin + 2000, done: now };
            all.push(Times { spans, cpu, ..Times::default() });
            now += 500;
        }
        all
    })
}

/// The GPU's clock counts from far away.
const GPU_ORIGIN: u64 = u64::MAX / 3;

proptest! {
    #[test]
    fn every_step_is_there_once_and_all_nests(frames in frames()) {
        let names = NAMES.map(str::to_owned);
        let tick = Tick { nanoseconds: 1.0, of_cpu: false };
        let counters = vec![vec![("a/one.count".to_owned(), 3)]; frames.len()];
        let trace = build(&names, &frames, &counters, tick, &ABOUT);
        let trace = serde_json::from_str(&serde_json::to_string(&trace).expect("text")).expect("JSON");
        let (slices, counts) = read(&trace).map_err(TestCaseError::fail)?;
        prop_assert_eq!(counts, frames.len());
        // By frame and path, lengths in ns: as they went in.
        let mut found: Vec<(String, i64)> = Vec::new();
        let mut outer = Vec::new();
        for slice in slices.iter().filter(|slice| slice.track.starts_with("GPU")) {
            let path = slice.names[1..].join("/");
            if names.contains(&path) {
                found.push((format!("{}:{path}", slice.names[0]), slice.end - slice.begin));
            } else {
                outer.push(path);
            }
        }
        let mut expected: Vec<(String, i64)> = Vec::new();
        for (index, times) in frames.iter().enumerate() {
            let known = names.iter().zip(&times.spans).filter_map(|(name, span)| Some((name, (*span)?)));
            expected.extend(known.map(|(name, [a, b])| (format!("frame {index}:{name}"), (b - a) as i64)));
        }
        found.sort();
        expected.sort();
        prop_assert_eq!(found, expected);
        prop_assert!(outer.iter().all(|path| ["", "a", "b", "b/c", "fill"].contains(&path.as_str())));
        // Work lies between its submission and the end of the wait for it, but for how far off the clocks may be.
        let within = (trace["otherData"]["gpu_within_us"].as_f64().expect("a number") * 1e3).ceil() as i64 + 1;
        for slice in slices.iter().filter(|s| s.track.starts_with("GPU") && s.names.len() > 1) {
            let index: usize = slice.names[0]["frame ".len()..].parse().expect("a number");
            let cpu = frames[index].cpu;
            let start = frames[0].cpu.begin;
            prop_assert!(slice.begin >= (cpu.submit - start) as i64 - within);
            prop_assert!(slice.end <= (cpu.done - start) as i64 + within);
        }
    }
}

/// By the wall clock steps are on the CPU's own clock, and nothing is to be aligned.
#[test]
fn wall_times_are_where_they_were() {
    let cpu = CpuTimes { begin: 100, submit: 100, submitted: 100, done: 900 };
    let times = Times { spans: vec![Some([200, 300]), None], cpu, ..Times::default() };
    let names = ["x".to_owned(), "y".to_owned()];
    let tick = Tick { nanoseconds: 1.0, of_cpu: true };
    let trace = serde_json::to_value(build(&names, &[times], &[], tick, &ABOUT)).expect("JSON");
    let (slices, _) = read(&trace).expect("a trace");
    let of = |name: &str| slices.iter().find(|s| s.names.last().is_some_and(|n| n == name)).expect("a slice");
    assert_eq!((of("x").begin, of("x").end), (100, 200));
    assert_eq!((of("wait").begin, of("wait").end), (0, 800));
    assert_eq!(trace["otherData"]["gpu_within_us"], 0.0);
}

/// The control: the checker refuses what is wrong.
#[test]
fn the_checker_refuses_broken_traces() {
    let times = Times {
        spans: vec![Some([200, 300]), Some([250, 350])],
        cpu: CpuTimes { begin: 0, submit: 50, submitted: 60, done: 900 },
        ..Times::default()
    };
    let tick = Tick { nanoseconds: 1.0, of_cpu: false };
    let names = ["p/x".to_owned(), "p/y".to_owned()];
    let good = serde_json::to_value(build(&names, &[times], &[], tick, &ABOUT)).expect("JSON");
    let (slices, _) = read(&good).expect("a trace");
    assert!(slices.iter().any(|slice| slice.track == "GPU, overlap 1"), "what overlaps is apart: {slices:?}");
    let count = good["traceEvents"].as_array().expect("events").len();
    for index in 0..count {
        let mut broken = good.clone();
        broken["traceEvents"].as_array_mut().expect("events").remove(index);
        assert!(read(&broken).is_err(), "without event {index}");
        let mut broken = good.clone();
        if broken["traceEvents"][index]["ph"] == "E" {
            broken["traceEvents"][index]["ts"] = (-1.0).into();
            assert!(read(&broken).is_err(), "event {index} at -1");
        }
    }
}
