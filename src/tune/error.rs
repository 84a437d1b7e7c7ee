//! Errors of an output against the scene's reference, one run for each value of a knob.

use super::table::{Quantity, Series};
use super::{Bench, Doing, Least, Tuning, Watch, values};
use crate::compare::truth::{self, Truth};
use crate::expr::Value;
use crate::library::Library;
use crate::problem::{Problem, Result};
use crate::reference::Cache;
use crate::session::Prepared;
use std::collections::BTreeMap;

pub(super) struct Errors<'a> {
    bench: &'a Bench<'a>,
    output: &'a str,
    cache: &'a Cache,
    watch: Watch<'a>,
    /// By scene and name: which light a run simulates may depend on the knob.
    truths: BTreeMap<(usize, String), Truth>,
}

/// Whether pipeline and reference are such, and have the output, if an error is to be measured.
pub(super) fn check(tuning: &Tuning, library: &Library, prepared: &Prepared) -> Result<()> {
    let Least::Error { output } = &tuning.least else { return Ok(()) };
    truth::light(&tuning.plan, library, prepared)?;
    let plan = &prepared.graph.plan;
    if plan.outputs.iter().any(|(name, ..)| name == output) {
        return Ok(());
    }
    Err(Problem::input("unknown-output", format!("`{}` has no output `{output}`", plan.name))
        .suggest(output, plan.outputs.iter().map(|(name, ..)| name.as_str()))
        .into())
}

impl<'a> Errors<'a> {
    pub fn new(bench: &'a Bench<'a>, output: &'a str, cache: &'a Cache, watch: Watch<'a>) -> Self {
        Self { bench, output, cache, watch, truths: BTreeMap::new() }
    }

    /// The error; what is within the reference's noise is that.
    fn error(&mut self, scene: usize, value: &Value) -> Result<f64> {
        let Bench { tuning, library, scenes, .. } = self.bench;
        let (plan, shown) = (&tuning.plan, &scenes[scene]);
        let subject = self.bench.subject(value);
        let prepared = subject.prepare(plan, library, shown)?;
        let light = truth::light(plan, library, &prepared)?;
        let key = (scene, light.name.clone());
        if !self.truths.contains_key(&key) {
            let mut watch = |step| {
                (self.watch)(Doing::Reference { scene: shown.name.clone(), step });
                Ok(())
            };
            let (truth, _) = truth::get(plan, library, self.cache, shown, &light, &mut watch)?;
            self.truths.insert(key.clone(), truth);
        }
        let done = subject.run(plan, shown, prepared)?;
        let error = match done.pictures.get(self.output) {
            Some(picture) => self.truths[&key].error(self.output, picture, &plan.measure)?,
            None => None,
        };
        Ok(error.ok_or_else(|| {
            let message = format!("`{}` can't be held against the reference", self.output);
            Problem::input("no-error", message)
                .help("choose an output in floats that the reference has too, with `--output`, such as color")
        })?)
    }
}

impl Quantity for Errors<'_> {
    fn samples(&mut self, scene: usize, numbers: &[f64], _yardstick: Option<f64>) -> Result<Vec<Series>> {
        let bench = self.bench;
        let values: Vec<Value> = numbers.iter().map(|number| bench.values.at(*number)).collect();
        let mut series = Vec::new();
        for (done, value) in values.iter().enumerate() {
            let (scene_name, of) = (bench.scenes[scene].name.clone(), values.len());
            let texts = values.iter().map(values::text).collect();
            (self.watch)(Doing::Values { scene: scene_name, values: texts, done, of });
            let error = self.error(scene, value);
            series.push(Series { samples: vec![bench.with(value, error)?], yardstick: None });
        }
        Ok(series)
    }

    /// The same picture would come out.
    fn is_exact(&self) -> bool {
        true
    }
}
