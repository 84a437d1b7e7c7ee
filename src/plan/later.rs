//! Named values in later frames: features change (the camera moves, frames are counted), all else stays as planned.

use super::world::fact;
use super::{Named, Plan, Reference, ScopeId};
use crate::expr::{Expr, Names, Value};
use crate::problem::{Problem, Result};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;

impl Plan {
    /// All named values, in the order of [`Plan::values`], with `changed` in place of the features planned with.
    pub fn values_with(&self, changed: &BTreeMap<String, Value>) -> Result<Vec<Value>, Problem> {
        let later = Later {
            plan: self,
            changed,
            done: self.values.iter().map(|_| OnceCell::new()).collect(),
            problem: RefCell::default(),
        };
        let values = (0..self.values.len()).map(|index| later.value(index)).collect();
        match later.problem.take() {
            Some(problem) => Err(problem),
            None => Ok(values),
        }
    }
}

struct Later<'p> {
    plan: &'p Plan,
    changed: &'p BTreeMap<String, Value>,
    done: Vec<OnceCell<Value>>,
    /// The first.
    problem: RefCell<Option<Problem>>,
}

impl Later<'_> {
    /// Values wait for each other as they did when planned: in no ring, and not deeply.
    fn value(&self, index: usize) -> Value {
        let planned = &self.plan.values[index];
        let compute = || {
            let names = View { later: self, scope: planned.scope };
            let value = Expr::parse(&planned.text.place).and_then(|expr| expr.eval(&names));
            value.unwrap_or_else(|problem| {
                self.problem.borrow_mut().get_or_insert(problem);
                Value::Unknown
            })
        };
        self.done[index].get_or_init(compute).clone()
    }
}

struct View<'l, 'p> {
    later: &'l Later<'p>,
    scope: ScopeId,
}

impl Names for View<'_, '_> {
    fn get(&self, name: &str) -> Option<Value> {
        let plan = self.later.plan;
        match plan.lookup(self.scope, name) {
            Some(Named::Knob(index)) => return Some(plan.knobs[*index].value.clone()),
            Some(Named::Value(index)) => return Some(self.later.value(*index)),
            Some(Named::Index(value)) => return Some(value.clone()),
            Some(Named::Resource(_) | Named::Sampler(_)) | None => {}
        }
        if let Some(value) = self.later.changed.get(name).or_else(|| plan.features.get(name)) {
            return Some(value.clone());
        }
        let (of, last) = name.rsplit_once('.')?;
        let Named::Resource(Reference { resource, .. }) = plan.lookup(self.scope, of)? else { return None };
        Some(fact(&plan.resources[*resource].kind, last))
    }

    /// Unknown names were found when planning.
    fn known(&self) -> Vec<String> {
        Vec::new()
    }
}
