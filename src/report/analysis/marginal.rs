//! What one knob or part costs and gives, from runs that differ in it alone.

use super::{error, time};
use crate::comparison::Run;
use crate::record::quantile;
use serde_json::Value;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// The value of the coordinate `name` in a run: the knob's, or the part in that role, set or by default; else as it
/// was written. Empty if the run knows nothing of that name.
pub fn coordinate(run: &Run, name: &str) -> String {
    match (run.knobs.get(name), run.parts.get(name)) {
        (Some(Value::String(text)), _) | (None, Some(text)) => text.clone(),
        (Some(value), _) => value.as_f64().map_or_else(|| value.to_string(), |number| number.to_string()),
        (None, None) => run.set.get(name).cloned().unwrap_or_default(),
    }
}

/// Knobs and roles that were set in any run of `scene` and have more than one value among those of a pipeline.
pub fn coordinates(runs: &[Run], scene: &str) -> Vec<String> {
    let of_scene = || runs.iter().filter(|run| run.scene == scene);
    let set: BTreeSet<&String> = of_scene().flat_map(|run| run.set.keys()).collect();
    let varies = |name: &&&String| {
        let mut first: BTreeMap<&str, String> = BTreeMap::new();
        of_scene().any(|run| {
            let value = coordinate(run, name);
            *first.entry(&run.pipeline).or_insert_with(|| value.clone()) != value
        })
    };
    set.iter().filter(varies).map(|name| (*name).clone()).collect()
}

/// Runs that differ in one coordinate alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub pipeline: String,
    /// The other coordinates.
    pub fixed: BTreeMap<String, String>,
    /// Indices into the runs, by rising value: numbers in their order, then the one that was not set, then texts.
    /// At least two; of runs with the same value the first.
    pub runs: Vec<usize>,
}

/// All lines of `scene` along `name`, in a fixed order.
pub fn lines(runs: &[Run], scene: &str, name: &str) -> Vec<Line> {
    let names = coordinates(runs, scene);
    let mut groups: BTreeMap<(String, BTreeMap<String, String>), Vec<usize>> = BTreeMap::new();
    for (index, run) in runs.iter().enumerate().filter(|(_, run)| run.scene == scene) {
        let others = names.iter().filter(|other| *other != name);
        let fixed = others.map(|other| (other.clone(), coordinate(run, other))).collect();
        groups.entry((run.pipeline.clone(), fixed)).or_default().push(index);
    }
    let line = |((pipeline, fixed), mut members): ((String, _), Vec<usize>)| {
        members.sort_by(|a, b| by_value(&runs[*a], &runs[*b], name));
        members.dedup_by_key(|index| coordinate(&runs[*index], name));
        (members.len() > 1).then_some(Line { pipeline, fixed, runs: members })
    };
    groups.into_iter().filter_map(line).collect()
}

fn number(run: &Run, name: &str) -> Option<f64> {
    coordinate(run, name).parse().ok().filter(|number: &f64| number.is_finite())
}

fn by_value(a: &Run, b: &Run, name: &str) -> Ordering {
    match (number(a, name), number(b, name)) {
        (Some(x), Some(y)) => x.total_cmp(&y),
        (Some(_), None) => Ordering::Less,
        (None, Some(_)) => Ordering::Greater,
        (None, None) => {
            let key = |run: &Run| (run.set.contains_key(name), coordinate(run, name));
            key(a).cmp(&key(b))
        }
    }
}

/// Medians over pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// After minus before, in the quantity's own unit.
    pub difference: f64,
    /// After over before; `None` where no pair starts above 0.
    pub ratio: Option<f64>,
}

/// What going from one value of a coordinate to another changes, all else equal.
#[derive(Clone, Debug, PartialEq)]
pub struct Marginal {
    pub name: String,
    pub from: String,
    pub to: String,
    /// How many pairs of runs differ in that alone and have both times or both errors.
    pub pairs: usize,
    /// Of the median frame, ms.
    pub time: Option<Change>,
    pub error: Option<Change>,
    /// Stages that run with `from` alone, and with `to` alone, in every pair.
    pub stages_from: Vec<String>,
    pub stages_to: Vec<String>,
}

/// Two runs that differ in one coordinate alone: before and after.
type Pair<'a> = [&'a Run; 2];

/// The marginal cost and error of each step along each coordinate of `scene`: from each number to the next larger one,
/// and from the first of other values (the one that is not set, if there is one) to each of the others.
pub fn marginals(runs: &[Run], scene: &str, output: &str, measure: &str) -> Vec<Marginal> {
    let error = |run: &Run| error(run, output, measure);
    let mut found = Vec::new();
    for name in coordinates(runs, scene) {
        for pairs in steps(runs, scene, &name) {
            let known = pairs.iter().filter(|pair| both(pair, time).is_some() || both(pair, error).is_some());
            found.push(Marginal {
                from: coordinate(pairs[0][0], &name),
                to: coordinate(pairs[0][1], &name),
                name: name.clone(),
                pairs: known.count(),
                time: change(&pairs, time),
                error: change(&pairs, error),
                stages_from: stages_of_one(&pairs, 0),
                stages_to: stages_of_one(&pairs, 1),
            });
        }
    }
    found
}

/// The pairs of each step along `name`, none empty, in order of their values.
fn steps<'a>(runs: &'a [Run], scene: &str, name: &str) -> Vec<Vec<Pair<'a>>> {
    let mut steps: Vec<Vec<Pair>> = Vec::new();
    let order = |a: &Pair, b: &Pair| by_value(a[0], b[0], name).then_with(|| by_value(a[1], b[1], name));
    for line in lines(runs, scene, name) {
        for (at, after) in line.runs.iter().enumerate().skip(1) {
            let before = if number(&runs[*after], name).is_some() { at - 1 } else { 0 };
            let pair = [&runs[line.runs[before]], &runs[*after]];
            let alike = |known: &&mut Vec<Pair>| {
                (0..2).all(|side| coordinate(known[0][side], name) == coordinate(pair[side], name))
            };
            match steps.iter_mut().find(alike) {
                Some(pairs) => pairs.push(pair),
                None => steps.push(vec![pair]),
            }
        }
    }
    steps.sort_by(|a, b| order(&a[0], &b[0]));
    steps
}

fn both(pair: &Pair, of: impl Fn(&Run) -> Option<f64>) -> Option<[f64; 2]> {
    Some([of(pair[0])?, of(pair[1])?])
}

fn change(pairs: &[Pair], of: impl Fn(&Run) -> Option<f64>) -> Option<Change> {
    let known: Vec<[f64; 2]> = pairs.iter().filter_map(|pair| both(pair, &of)).collect();
    let differences: Vec<f64> = known.iter().map(|[before, after]| after - before).collect();
    let above = known.iter().filter(|[before, _]| *before > 0.0);
    let ratios: Vec<f64> = above.map(|[before, after]| after / before).collect();
    Some(Change { difference: quantile(&differences, 0.5)?, ratio: quantile(&ratios, 0.5) })
}

/// What runs on one side of every pair and not on the other.
fn stages_of_one(pairs: &[Pair], side: usize) -> Vec<String> {
    let running = |run: &Run| -> BTreeSet<String> {
        let stages = run.stages.iter().filter(|stage| stage.status != "dropped");
        stages.map(|stage| stage.path.clone()).collect()
    };
    let alone = |pair: &Pair| -> BTreeSet<String> { &running(pair[side]) - &running(pair[1 - side]) };
    let common = pairs.iter().map(alone).reduce(|a, b| &a & &b);
    common.unwrap_or_default().into_iter().collect()
}
