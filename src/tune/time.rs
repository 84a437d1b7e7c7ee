//! Times of frames, or of some of their stages, with values of a knob taking turns.

use super::table::{Quantity, Series};
use super::{Bench, Doing, Least, Tuning, Watch, values};
use crate::device::Gpu;
use crate::expr::Value;
use crate::frame::{self, Changes, Clock, Frame, calibrate};
use crate::graph::Graph;
use crate::problem::{Problem, Problems, Result};
use crate::schedule::Fate;
use crate::session::Prepared;

/// Memory that the frames of values that take turns may have together; at least one has.
const AT_ONCE: u64 = 1 << 30;
/// Frames of each value that don't count: the first, in which drivers compile, and one more.
const WARM_UP: usize = 2;

pub(super) struct Times<'a> {
    bench: &'a Bench<'a>,
    stage: Option<&'a str>,
    watch: Watch<'a>,
    gpu: Gpu,
    pub clock: Clock,
    random: fastrand::Rng,
}

/// Whether there are stages of the name, if stages are to be timed.
pub(super) fn check(tuning: &Tuning, graph: &Graph) -> Result<()> {
    let Least::Time { stage: Some(prefix) } = &tuning.least else { return Ok(()) };
    if graph.stages.iter().any(|stage| stage.path.starts_with(prefix)) {
        return Ok(());
    }
    let paths: Vec<&str> = graph.stages.iter().map(|stage| stage.path.as_str()).collect();
    let message = format!("`{}` has no stage whose path begins with `{prefix}`", graph.plan.name);
    Err(Problem::input("unknown-stage", message).help(format!("there are: {}", paths.join(", "))).into())
}

impl<'a> Times<'a> {
    pub fn new(bench: &'a Bench<'a>, stage: Option<&'a str>, watch: Watch<'a>) -> Result<Self> {
        let plan = &bench.tuning.plan;
        let gpu = Gpu::open(plan.adapter.as_deref(), &plan.limits)?;
        let clock = match plan.wall_clock {
            true => Clock::Wall("asked for by --wall-clock".to_owned()),
            false => calibrate::choose(&gpu)?,
        };
        let random = fastrand::Rng::with_seed(bench.tuning.seed);
        Ok(Self { bench, stage, watch, gpu, clock, random })
    }

    fn tell(&mut self, scene: usize, values: &[Value], done: usize, of: usize) {
        let scene = self.bench.scenes[scene].name.clone();
        (self.watch)(Doing::Values { scene, values: values.iter().map(values::text).collect(), done, of });
    }

    /// Of each value in the order given: all are run once in each round, in another order each time.
    fn in_turns(&mut self, scene: usize, turns: Vec<(Value, Prepared)>) -> Result<Vec<Vec<f64>>> {
        let values: Vec<Value> = turns.iter().map(|(value, _)| value.clone()).collect();
        let rounds = self.bench.tuning.repeats as usize;
        let of = values.len() * (WARM_UP + rounds);
        let (mut frames, mut done) = (Vec::new(), 0);
        for (value, prepared) in turns {
            let frame = prepared.realise(&self.gpu, &self.bench.scenes[scene], self.clock.clone(), None);
            let mut frame = self.bench.with(&value, frame)?;
            for _ in 0..WARM_UP {
                self.tell(scene, &values, done, of);
                let ran = frame.run(&self.gpu, &Changes::All).map(drop).map_err(Problems::from);
                self.bench.with(&value, ran)?;
                done += 1;
            }
            if frame.goes_on() {
                frame.reset();
            }
            frames.push(frame);
        }
        let mut samples = vec![Vec::with_capacity(rounds); values.len()];
        let mut order: Vec<usize> = (0..values.len()).collect();
        for _ in 0..rounds {
            self.random.shuffle(&mut order);
            for index in &order {
                self.tell(scene, &values, done, of);
                let times = frames[*index].run(&self.gpu, &Changes::All)?.clone();
                let time = self.time(&frames[*index], &times);
                samples[*index].push(self.bench.with(&values[*index], time)?);
                done += 1;
            }
        }
        Ok(samples)
    }

    /// What counts of a frame's times.
    fn time(&self, frame: &Frame, times: &frame::Times) -> Result<f64> {
        let Some(prefix) = self.stage else { return Ok(times.frame.ok_or_else(unknown)?) };
        let named = frame.graph.stages.iter().zip(&frame.schedule.fates);
        let ran =
            named.filter(|(stage, _)| stage.path.starts_with(prefix)).filter_map(|(_, fate)| match fate {
                Fate::Run { step } => Some(times.steps.get(*step).copied().flatten()),
                Fate::Dropped(_) => None,
            });
        let times: Vec<f64> = ran.collect::<Option<_>>().ok_or_else(unknown)?;
        if times.is_empty() {
            let message = format!("no stage runs whose path begins with `{prefix}`");
            return Err(Problem::input("nothing-timed", message)
                .help("all of them are dropped: `voxgi check --scene` says why; choose others with `--stage`")
                .into());
        }
        Ok(times.iter().sum())
    }
}

fn unknown() -> Problem {
    Problem::failure("no-time", "the time of a frame is not known")
        .help("`--wall-clock` times by the CPU's clock")
}

impl Quantity for Times<'_> {
    /// Values whose frames don't fit into memory together are measured in groups. Without a yardstick, that of the
    /// second group and those after it is the first number.
    fn samples(&mut self, scene: usize, numbers: &[f64], yardstick: Option<f64>) -> Result<Vec<Series>> {
        let bench = self.bench;
        let prepared = |number: f64| {
            let value = bench.values.at(number);
            let subject = bench.subject(&value);
            bench.with(&value, subject.prepare(&bench.tuning.plan, bench.library, &bench.scenes[scene]))
        };
        let mut series: Vec<Series> = Vec::new();
        let mut rest = numbers;
        while !rest.is_empty() {
            let by = yardstick.or(numbers.first().copied().filter(|_| !series.is_empty()));
            let (mut turns, mut bytes) = (Vec::new(), 0);
            for number in by.iter().chain(rest) {
                let prepared = prepared(*number)?;
                bytes += prepared.schedule.memory.peak_bytes + prepared.schedule.memory.kept_bytes;
                if bytes > AT_ONCE && turns.len() > usize::from(by.is_some()) {
                    break;
                }
                turns.push((bench.values.at(*number), prepared));
            }
            rest = &rest[turns.len() - usize::from(by.is_some())..];
            let mut group = self.in_turns(scene, turns)?.into_iter();
            let yardstick = by.and_then(|number| Some((number, group.next()?)));
            series.extend(group.map(|samples| Series { samples, yardstick: yardstick.clone() }));
        }
        Ok(series)
    }

    fn is_exact(&self) -> bool {
        false
    }
}
