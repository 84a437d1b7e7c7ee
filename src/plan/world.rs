//! What names mean, and their values.
//!
//! Values and the sizes of resources may use each other in any order: each is computed when first asked for, once. What
//! is wrong with an expression is reported where it stands, and its value is unknown from there on.

use super::setup::{Setup, cause};
use super::{
    Named, PlannedKnob, PlannedResource, PlannedValue, Reference, ResourceId, ResourceKind, Scope, ScopeId,
    resources,
};
use crate::document::{Cause, ExprText, Resource};
use crate::expr::{Expr, Names, Value};
use crate::problem::{Place, Problem};
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet};

/// How many values and sizes can wait for each other, so that no file exhausts the stack. (Those that use what stands
/// above them wait for nothing.)
const MAX_WAITING: usize = 16;

/// Whether what is computed will run. In stages that are dropped, numbers out of bounds are nobody's fault: they say
/// `when` for that very reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Live {
    Yes,
    No,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Item {
    Value(usize),
    Resource(ResourceId),
}

struct LazyValue<'a> {
    path: String,
    place: Place,
    text: &'a ExprText,
    scope: ScopeId,
    done: OnceCell<(Value, BTreeSet<Cause>)>,
}

pub(super) struct LazyResource<'a> {
    pub path: String,
    pub place: Place,
    /// `None`: the scene gives it.
    pub declared: Option<&'a Resource>,
    /// Where the names in its sizes are looked up.
    pub scope: ScopeId,
    pub live: Live,
    pub done: OnceCell<(ResourceKind, BTreeSet<Cause>)>,
}

/// What a name in an expression is.
enum Found<'w> {
    Ready(&'w Value),
    Feature(&'w Value, Option<Cause>),
    Value(usize),
    Fact(ResourceId, &'static str),
}

const TEXTURE_FACTS: [&str; 5] = ["width", "height", "depth", "mips", "layers"];
const BUFFER_FACTS: [&str; 1] = ["count"];

pub(super) struct World<'a> {
    pub setup: &'a Setup,
    pub features: BTreeMap<String, Value>,
    pub knobs: Vec<PlannedKnob>,
    values: Vec<LazyValue<'a>>,
    pub resources: Vec<LazyResource<'a>>,
    pub scopes: Vec<Scope>,
    /// Where each name of each scope is declared.
    pub declared: BTreeMap<(ScopeId, String), Place>,
    problems: RefCell<Vec<Problem>>,
    waiting: RefCell<Vec<Item>>,
}

impl<'a> World<'a> {
    pub fn new(setup: &'a Setup) -> Self {
        Self {
            setup,
            features: setup.all_features(),
            knobs: Vec::new(),
            values: Vec::new(),
            resources: Vec::new(),
            scopes: Vec::new(),
            declared: BTreeMap::new(),
            problems: RefCell::default(),
            waiting: RefCell::default(),
        }
    }

    pub fn report(&self, problem: Problem) {
        self.problems.borrow_mut().push(problem);
    }

    /// The problems so far; what several rounds of a loop found is listed once.
    pub fn take_problems(&self) -> Vec<Problem> {
        let mut seen = BTreeSet::new();
        let mut problems = self.problems.take();
        problems.retain(|problem| {
            let place = |(place, _): &(Place, String)| {
                (place.source.name().to_owned(), place.span.start, place.span.end)
            };
            seen.insert((problem.code, problem.labels.iter().map(place).collect::<Vec<_>>()))
        });
        problems
    }

    pub fn add_scope(&mut self, parent: Option<ScopeId>) -> ScopeId {
        self.scopes.push(Scope { parent, names: BTreeMap::new() });
        self.scopes.len() - 1
    }

    pub fn add_value(&mut self, path: String, place: Place, text: &'a ExprText, scope: ScopeId) -> usize {
        self.values.push(LazyValue { path, place, text, scope, done: OnceCell::new() });
        self.values.len() - 1
    }

    pub fn lookup(&self, scope: ScopeId, name: &str) -> Option<&Named> {
        super::lookup(&self.scopes, scope, name)
    }

    /// Computes all values, in order.
    pub fn planned_values(&self) -> Vec<PlannedValue> {
        let planned = |(index, lazy): (usize, &LazyValue<'a>)| {
            let (value, causes) = self.named_value(index);
            PlannedValue {
                path: lazy.path.clone(),
                value,
                causes,
                place: lazy.place.clone(),
                text: lazy.text.clone(),
                scope: lazy.scope,
            }
        };
        self.values.iter().enumerate().map(planned).collect()
    }

    /// Computes the kinds of all resources; `history` are those whose slot of the frame before is read.
    pub fn planned_resources(&self, history: &BTreeSet<ResourceId>) -> Vec<PlannedResource> {
        let planned = |(id, lazy): (ResourceId, &LazyResource<'a>)| PlannedResource {
            path: lazy.path.clone(),
            place: lazy.place.clone(),
            kind: self.resource(id).0,
            start: resources::start(lazy.declared),
            history: history.contains(&id),
        };
        self.resources.iter().enumerate().map(planned).collect()
    }

    /// Computes `text` with the names of `scope`; unknown where something is wrong with it.
    pub fn value(&self, text: &ExprText, scope: ScopeId, live: Live) -> Value {
        self.try_value(&text.place, scope).unwrap_or_else(|problem| {
            if live == Live::Yes || !matches!(problem.code, "division-by-zero" | "not-finite") {
                self.report(problem);
            }
            Value::Unknown
        })
    }

    fn try_value(&self, place: &Place, scope: ScopeId) -> Result<Value, Problem> {
        Expr::parse(place)?.eval(&View { world: self, scope })
    }

    /// A whole number of at least `least`; `None` where it is unknown or something is wrong with it.
    pub fn whole(&self, text: &ExprText, scope: ScopeId, least: u64, live: Live) -> Option<u64> {
        /// The largest below which a real number holds every whole one.
        const MOST: f64 = 9_007_199_254_740_992.0;
        let value = self.value(text, scope, live);
        let problem = match value {
            Value::Unknown => return None,
            Value::Number(number) if number.fract() != 0.0 => {
                Problem::input("not-whole", format!("here should be a whole number, not {number}"))
                    .help("round it with `floor(…)` or `ceil(…)`")
            }
            Value::Number(number) if number == 0.0 && least > 0 => {
                Problem::input("size-zero", "a size of zero").help("where it can be 0, write `max(1, …)`")
            }
            Value::Number(number) if number < least as f64 || number > MOST => {
                Problem::input("out-of-range", format!("{number} is out of range: {least} is the least"))
            }
            Value::Number(number) => return Some(number as u64),
            other => {
                let problem =
                    Problem::input("wrong-type", format!("here should be a number, not {}", other.kind()));
                self.report(problem.at(&text.place, format!("this is {other}")));
                return None;
            }
        };
        if live == Live::Yes {
            self.report(problem.at(&text.place, format!("this is {value}")));
        }
        None
    }

    /// What `text` depends on, through values and sizes too.
    pub fn causes(&self, text: &ExprText, scope: ScopeId) -> BTreeSet<Cause> {
        let Ok(expr) = Expr::parse(&text.place) else { return BTreeSet::new() };
        let found = expr.names().filter_map(|(name, _)| self.find(scope, name));
        found
            .flat_map(|found| match found {
                Found::Ready(_) => BTreeSet::new(),
                Found::Feature(_, cause) => cause.into_iter().collect(),
                Found::Value(index) => self.named_value(index).1,
                Found::Fact(resource, _) => self.resource(resource).1,
            })
            .collect()
    }

    /// The kind of a resource, and what its size depends on.
    pub fn resource(&self, id: ResourceId) -> (ResourceKind, BTreeSet<Cause>) {
        let unknown = (ResourceKind::Scene, BTreeSet::new());
        self.once(Item::Resource(id), &self.resources[id].done, unknown, || {
            self.declared_kind(&self.resources[id])
        })
    }

    fn named_value(&self, index: usize) -> (Value, BTreeSet<Cause>) {
        let lazy = &self.values[index];
        self.once(Item::Value(index), &lazy.done, (Value::Unknown, BTreeSet::new()), || {
            (self.value(lazy.text, lazy.scope, Live::Yes), self.causes(lazy.text, lazy.scope))
        })
    }

    /// What `done` holds, or else `make`s it; `unknown` where that waits for itself.
    fn once<T: Clone>(&self, item: Item, done: &OnceCell<T>, unknown: T, make: impl FnOnce() -> T) -> T {
        if let Some(made) = done.get() {
            return made.clone();
        }
        let waiting = self.waiting.borrow().clone();
        if let Some(start) = waiting.iter().position(|other| *other == item) {
            self.report(self.ring(&waiting[start..]));
            return unknown;
        }
        if waiting.len() >= MAX_WAITING {
            let (path, place) = self.item(item);
            let message =
                format!("`{path}` is at the end of more than {MAX_WAITING} others that wait for each other");
            let problem = Problem::input("expression-depth", message).at(place, "declared here");
            self.report(problem.help("write values in an order where each uses only those above it"));
            return unknown;
        }
        self.waiting.borrow_mut().push(item);
        let made = make();
        self.waiting.borrow_mut().pop();
        done.get_or_init(|| made).clone()
    }

    fn item(&self, item: Item) -> (&str, &Place) {
        match item {
            Item::Value(index) => (&self.values[index].path, &self.values[index].place),
            Item::Resource(id) => (&self.resources[id].path, &self.resources[id].place),
        }
    }

    fn ring(&self, items: &[Item]) -> Problem {
        let names: Vec<&str> = items.iter().chain(items.first()).map(|item| self.item(*item).0).collect();
        let message = format!("`{}` depends on itself: {}", names[0], names.join(" → "));
        items.iter().enumerate().fold(Problem::input("ring", message), |problem, (i, item)| {
            let label = format!("{} uses {}", names[i], names[i + 1]);
            problem.at(self.item(*item).1, label)
        })
    }

    fn find(&self, scope: ScopeId, name: &str) -> Option<Found<'_>> {
        match self.lookup(scope, name) {
            Some(Named::Knob(index)) => return Some(Found::Ready(&self.knobs[*index].value)),
            Some(Named::Value(index)) => return Some(Found::Value(*index)),
            Some(Named::Index(value)) => return Some(Found::Ready(value)),
            Some(Named::Resource(_) | Named::Sampler(_)) | None => {}
        }
        if let Some(value) = self.features.get(name) {
            return Some(Found::Feature(value, cause(name)));
        }
        let (of, fact) = name.rsplit_once('.')?;
        let Named::Resource(Reference { resource, .. }) = self.lookup(scope, of)? else { return None };
        let fact = self.facts(*resource).iter().find(|known| **known == fact)?;
        Some(Found::Fact(*resource, fact))
    }

    fn facts(&self, id: ResourceId) -> &'static [&'static str] {
        match self.resources[id].declared {
            Some(Resource::Texture { .. }) => &TEXTURE_FACTS,
            Some(Resource::Buffer { .. }) => &BUFFER_FACTS,
            None => &[],
        }
    }
}

/// A number that describes a resource; unknown where it has none of that name.
pub(super) fn fact(kind: &ResourceKind, name: &str) -> Value {
    let number = match (kind, name) {
        (ResourceKind::Texture { size, .. }, "width") => size.map(|size| size[0].into()),
        (ResourceKind::Texture { size, .. }, "height") => size.map(|size| size[1].into()),
        (ResourceKind::Texture { size, .. }, "depth") => size.map(|size| size[2].into()),
        (ResourceKind::Texture { mips, .. }, "mips") => mips.map(u64::from),
        (ResourceKind::Texture { layers, .. }, "layers") => layers.map(u64::from),
        (ResourceKind::Buffer { count }, "count") => *count,
        _ => None,
    };
    number.map_or(Value::Unknown, |number| Value::Number(number as f64))
}

/// The names of one scope, as expressions see them.
struct View<'w, 'a> {
    world: &'w World<'a>,
    scope: ScopeId,
}

impl Names for View<'_, '_> {
    fn get(&self, name: &str) -> Option<Value> {
        Some(match self.world.find(self.scope, name)? {
            Found::Ready(value) | Found::Feature(value, _) => value.clone(),
            Found::Value(index) => self.world.named_value(index).0,
            Found::Fact(resource, name) => fact(&self.world.resource(resource).0, name),
        })
    }

    fn has(&self, name: &str) -> bool {
        self.world.find(self.scope, name).is_some()
    }

    fn known(&self) -> Vec<String> {
        let mut known: Vec<String> = self.world.features.keys().cloned().collect();
        for (name, named) in super::visible(&self.world.scopes, self.scope) {
            match named {
                Named::Knob(_) | Named::Value(_) | Named::Index(_) => known.push(name.to_owned()),
                Named::Resource(reference) => {
                    let facts = self.world.facts(reference.resource);
                    known.extend(facts.iter().map(|fact| format!("{name}.{fact}")));
                }
                Named::Sampler(_) => {}
            }
        }
        known
    }
}
