//! `--tuned`: the values that `voxgi tune` kept.

use crate::compare::Subject;
use crate::device;
use crate::library::Library;
use crate::plan::Plan;
use crate::problem::Result;
use crate::record::Adapter;
use crate::session::{Request, prepare};
use crate::tuned::{Shelf, Used, Uses};
use std::collections::BTreeSet;

/// What is kept for an adapter; no device is opened for that.
pub struct Kept {
    shelf: Shelf,
    adapter: Adapter,
}

impl Kept {
    /// For the adapter that `wanted` chooses, as elsewhere.
    pub fn on(wanted: Option<&str>) -> Result<Self> {
        let adapter = Adapter::new(&device::choose(wanted)?.get_info());
        Ok(Self { shelf: Shelf::of_user()?, adapter })
    }

    /// The values for knobs of a plan that are not set.
    pub fn uses(&self, plan: &Plan) -> Result<Uses> {
        self.shelf.uses(plan, &self.adapter)
    }

    /// Puts the values into all subjects that have some; one at least must.
    pub fn put_into(&self, subjects: &mut [Subject], library: &Library) -> Result<()> {
        let (mut any, mut without, mut said) = (false, None, BTreeSet::new());
        for subject in subjects {
            let request = Request {
                pipeline: subject.pipeline.clone(),
                sets: subject.sets.clone(),
                parts: subject.parts.clone(),
                ..Request::default()
            };
            let plan = &prepare(&request, library, None)?.graph.plan;
            match self.uses(plan) {
                Ok(uses) => {
                    said.insert(told(plan, &uses));
                    (any, subject.tuned) = (true, uses);
                }
                Err(problems) if problems.iter().all(|problem| problem.code == "not-tuned") => {
                    said.extend(problems.iter().map(|problem| format!("tuned: {}\n", problem.message)));
                    without.get_or_insert(problems);
                }
                Err(problems) => return Err(problems),
            }
        }
        match without {
            Some(problems) if !any => Err(problems),
            _ => {
                said.iter().for_each(|text| eprint!("{text}"));
                Ok(())
            }
        }
    }
}

/// What is used, for people: a line for each knob.
pub fn told(plan: &Plan, uses: &Uses) -> String {
    let name = &plan.name;
    let line = |(knob, used): (&String, &Used)| {
        format!("tuned: {name}, {knob}={}, found on {} at {}\n", used.text(), used.scene, used.when)
    };
    match uses.is_empty() {
        true => format!("tuned: {name}, nothing: all knobs with kept values are set\n"),
        false => uses.iter().map(line).collect(),
    }
}
