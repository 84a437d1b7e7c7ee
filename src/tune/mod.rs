//! Tuning: the value of a knob that makes a time or an error least, on one scene or on several.
//!
//! | file | what |
//! |---|---|
//! | [`range`](mod@range) | the numbers that a knob can have, on their scale |
//! | [`estimate`](mod@estimate) | a median with its interval |
//! | [`search`](mod@search) | where a noisy function is least |
//! | [`table`](mod@table) | all that was measured, and several scenes as one function |
//! | [`values`](mod@values) | from a knob to what is tried |
//! | [`time`](mod@time), [`error`](mod@error) | what is to be least |
//!
//! Of several scenes, the least sum of ratios to each scene's best counts. A time is that of a frame on the GPU in
//! which every stage runs, or the sum of some of its stages; an error is a run's relMSE as [`crate::compare`] measures
//! it, and those that are within the reference's own noise count as alike. What is found can be kept:
//! [`crate::tuned`].

pub mod error;
pub mod estimate;
pub mod range;
pub mod search;
pub mod table;
#[cfg(test)]
mod tests;
pub mod time;
pub mod values;

use crate::compare::{Plan, Subject};
use crate::expr::Value;
use crate::library::Library;
use crate::plan::PlannedKnob;
use crate::problem::{Problem, Problems, Result, Source};
use crate::record::{self, Adapter};
use crate::reference::Cache;
use crate::scene::{self, Scene};
use crate::{converge, device};
use error::Errors;
use estimate::Estimate;
use search::{Found, Objective, choose, choose_unordered, search};
use serde::Serialize;
use std::collections::BTreeMap;
use table::{Cell, Measuring, Quantity, Series, Table};
use time::Times;
use values::Values;

/// Changes whenever a field of [`Outcome`] changes its name, its place or its meaning.
pub const SCHEMA: u32 = 1;

/// What is to be found, and how.
#[derive(Clone, Debug)]
pub struct Tuning {
    /// Its one subject is the pipeline; scenes, size, reference and device are those of a comparison.
    pub plan: Plan,
    pub subject: Subject,
    /// By its path, or the end of it.
    pub knob: String,
    pub least: Least,
    /// Least and most number to be tried.
    pub within: Option<[f64; 2]>,
    /// How often each value is timed.
    pub repeats: u32,
    /// Of the order in which values take turns.
    pub seed: u64,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Least {
    /// Of a frame, or of the stages whose paths begin with this, in sum.
    Time { stage: Option<String> },
    /// relMSE of this output.
    Error { output: String },
}

/// What tuning is doing.
#[derive(Clone, Debug, PartialEq)]
pub enum Doing {
    Reference {
        scene: String,
        step: converge::Step,
    },
    /// So many steps of so many are done of measuring these values on a scene.
    Values {
        scene: String,
        values: Vec<String>,
        done: usize,
        of: usize,
    },
}

pub type Watch<'a> = &'a mut dyn FnMut(Doing);

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    pub schema: u32,
    pub pipeline: String,
    /// Role → part, all of them.
    pub parts: BTreeMap<String, String>,
    /// Knobs and parts that were set, as written.
    pub set: BTreeMap<String, String>,
    /// Its path.
    pub knob: String,
    pub unit: Option<String>,
    /// `time` or `error`.
    pub least: &'static str,
    /// `frame`, the beginning of the stages' paths, or the output.
    pub of: String,
    pub size: [u32; 2],
    pub scenes: Vec<String>,
    pub adapter: Adapter,
    /// Of times.
    pub clock: Option<&'static str>,
    pub clock_reason: Option<String>,
    /// By value: numbers rising, others as the knob lists them.
    pub tried: Vec<Tried>,
    pub default: serde_json::Value,
    pub chosen: serde_json::Value,
    /// The least and the most of the values beside the chosen one that are as good.
    pub alike: [serde_json::Value; 2],
}

/// One value.
#[derive(Clone, Debug, Serialize)]
pub struct Tried {
    pub value: serde_json::Value,
    /// Mean over scenes of the ratio to the scene's best.
    pub ratio: Estimate,
    pub scenes: Vec<Measured>,
}

/// One value on one scene: times in ms, errors as relMSE.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    pub scene: String,
    /// As on the machine in the state of the first batch: see [`table`](mod@table).
    #[serde(flatten)]
    pub estimate: Estimate,
    /// As measured.
    pub samples: Vec<f64>,
    /// Of the value that ran along as the yardstick, in the same rounds.
    pub yardstick: Option<Vec<f64>>,
}

/// What [`time`](mod@time) and [`error`](mod@error) are told.
struct Bench<'a> {
    tuning: &'a Tuning,
    /// The knob's path.
    knob: &'a str,
    values: &'a Values,
    library: &'a Library,
    scenes: &'a [Scene],
}

impl Bench<'_> {
    fn subject(&self, value: &Value) -> Subject {
        let mut subject = self.tuning.subject.clone();
        subject.sets.push((self.knob.to_owned(), values::text(value)));
        subject
    }

    /// Says in problems with a value which one it was.
    fn with<T>(&self, value: &Value, result: Result<T>) -> Result<T> {
        result.map_err(|problems| {
            let set = format!("with `{}={}`: ", self.knob, values::text(value));
            let told =
                problems.iter().cloned().map(|p| Problem { message: format!("{set}{}", p.message), ..p });
            Problems::check(told.collect()).err().unwrap_or(problems)
        })
    }
}

/// Finds the value. Nothing is measured before all that is asked for is known to be right.
pub fn tune(tuning: &Tuning, library: &Library, cache: &Cache, watch: Watch) -> Result<Outcome> {
    let plan = &tuning.plan;
    let mut scenes = Vec::new();
    let mut planned = None;
    for path in &plan.scenes {
        let mut scene = scene::load(path)?;
        scene.pose(plan.time);
        let prepared = tuning.subject.prepare(plan, library, &scene)?;
        time::check(tuning, &prepared.graph)?;
        error::check(tuning, library, &prepared)?;
        planned = Some(prepared.graph.plan.clone());
        scenes.push(scene);
    }
    let planned = planned.ok_or_else(|| Problem::input("no-scene", "there is no scene to tune on"))?;
    let asked = Source::new("--knob", tuning.knob.clone());
    let knob =
        planned.knob(&tuning.knob).map_err(|p| p.at(&asked.at(0..tuning.knob.len()), "asked for here"))?;
    if knob.set {
        let message = format!("`{}` is set, and to be found", knob.path);
        return Err(Problem::input("tuned-and-set", message).help("leave its `--set` away").into());
    }
    let values = Values::new(knob, tuning.within)?;
    let adapter = Adapter::new(&device::choose(plan.adapter.as_deref())?.get_info());
    let bench = Bench { tuning, knob: &knob.path, values: &values, library, scenes: &scenes };
    let (found, table, clock) = match &tuning.least {
        Least::Time { stage } => {
            let mut times = Times::new(&bench, stage.as_deref(), watch)?;
            let (found, table) = run(&mut times, &values, knob, scenes.len())?;
            (found, table, Some(record::clock(&times.clock)))
        }
        Least::Error { output } => {
            let mut errors = Errors::new(&bench, output, cache, watch);
            let (found, table) = run(&mut errors, &values, knob, scenes.len())?;
            (found, table, None)
        }
    };
    let tried = table.known().into_iter().map(|known| Tried {
        value: record::value(&values.at(known.number)),
        ratio: known.estimate,
        scenes: measured(&scenes, table.cells(known.number)),
    });
    let json = |number: f64| record::value(&values.at(number));
    Ok(Outcome {
        schema: SCHEMA,
        pipeline: planned.name.clone(),
        parts: planned.parts.clone(),
        set: tuning.subject.coordinates(),
        knob: knob.path.clone(),
        unit: knob.knob.unit.clone(),
        least: tuning.least.name(),
        of: tuning.least.of().to_owned(),
        size: plan.size,
        scenes: scenes.iter().map(|scene| scene.name.clone()).collect(),
        adapter,
        clock: clock.as_ref().map(|(name, _)| *name),
        clock_reason: clock.and_then(|(_, reason)| reason),
        tried: tried.collect(),
        default: record::value(&knob.value),
        chosen: json(found.number),
        alike: found.flat.map(json),
    })
}

fn run(
    quantity: &mut dyn Quantity,
    values: &Values,
    knob: &PlannedKnob,
    scenes: usize,
) -> Result<(Found, Table)> {
    let mut measuring = Measuring::new(quantity, scenes);
    let found = match values {
        Values::Range(range) => {
            let default = match knob.value {
                Value::Number(number) => number,
                _ => f64::NAN,
            };
            search(range, &[default], &mut measuring)?
        }
        Values::List { values, ordered } => {
            let all: Vec<f64> = (0..values.len()).map(|index| index as f64).collect();
            measuring.measure(&all)?;
            match ordered {
                true => choose(&mut measuring, |index| index)?,
                false => choose_unordered(&mut measuring)?,
            }
        }
    };
    Ok((found, measuring.table))
}

fn measured(scenes: &[Scene], cells: &[Cell]) -> Vec<Measured> {
    let of = |(scene, cell): (&Scene, &Cell)| {
        let Series { samples, yardstick } = cell.series.clone();
        let yardstick = yardstick.map(|(_, samples)| samples);
        let estimate = Estimate::of(&cell.samples)?;
        Some(Measured { scene: scene.name.clone(), estimate, samples, yardstick })
    };
    scenes.iter().zip(cells).filter_map(of).collect()
}

impl Least {
    pub fn name(&self) -> &'static str {
        match self {
            Self::Time { .. } => "time",
            Self::Error { .. } => "error",
        }
    }

    /// See [`Outcome::of`].
    pub fn of(&self) -> &str {
        match self {
            Self::Time { stage } => stage.as_deref().unwrap_or("frame"),
            Self::Error { output } => output,
        }
    }
}
