//! Examples worked out by hand, and properties against definitions.

use super::*;
use crate::comparison::{Memory, StageTime, Timing};
use crate::record::Spread;
use proptest::prelude::*;
use std::collections::BTreeMap;

fn run(set: &[(&str, &str)], ms: f64, relmse: f64) -> Run {
    Run {
        repeats_ms: vec![Some(ms)],
        documents: BTreeMap::new(),
        name: format!("{set:?}"),
        scene: "box".to_owned(),
        reference: "full".to_owned(),
        pipeline: "a".to_owned(),
        parts: BTreeMap::new(),
        knobs: BTreeMap::from([("n".to_owned(), 64.0.into())]),
        set: set.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect(),
        clock: "timestamps".to_owned(),
        clock_reason: None,
        gpu_ms: Timing { median: Some(ms), ..Timing::default() },
        first_use_ms: None,
        encode_ms: None,
        stages: Vec::new(),
        errors: BTreeMap::from([("color".to_owned(), BTreeMap::from([("relmse".to_owned(), relmse)]))]),
        masked: BTreeMap::new(),
        within_noise: Vec::new(),
        memory: Memory::default(),
        tuned: BTreeMap::new(),
        lacks: Vec::new(),
        pictures: BTreeMap::new(),
    }
}

/// With the knob `n` at a number, as a record has it.
fn with(n: f64, set: &[(&str, &str)], ms: f64, relmse: f64) -> Run {
    let mut run = run(set, ms, relmse);
    run.knobs.insert("n".to_owned(), n.into());
    run.set.insert("n".to_owned(), n.to_string());
    run
}

fn stage(path: &str, status: &str) -> StageTime {
    StageTime {
        path: path.to_owned(),
        status: status.to_owned(),
        reason: None,
        gpu_ms: None,
        spread: Spread::default(),
        samples_ms: Vec::new(),
    }
}

fn point(run: usize, time: f64, error: f64) -> Point {
    Point { run, time, error }
}

fn indices(points: &[Point]) -> Vec<usize> {
    points.iter().map(|point| point.run).collect()
}

#[test]
fn what_is_not_known_takes_no_part() {
    let mut runs = vec![run(&[], 1.0, 0.5), run(&[], 2.0, f64::NAN), run(&[], 3.0, 0.1), run(&[], 0.0, 0.1)];
    runs[2].gpu_ms.median = None;
    assert_eq!(indices(&points(&runs, "box", "color", "relmse")), [0]);
    assert!(points(&runs, "other", "color", "relmse").is_empty());
    assert!(points(&runs, "box", "depth", "relmse").is_empty());
}

#[test]
fn the_front_leaves_out_what_another_run_beats() {
    let points =
        [point(0, 4.0, 0.1), point(1, 1.0, 0.5), point(2, 2.0, 0.5), point(3, 2.0, 0.3), point(4, 5.0, 0.2)];
    assert_eq!(indices(&front(&points)), [1, 3, 0]);
    assert!(front(&[]).is_empty());
}

#[test]
fn the_cheapest_is_the_fastest_that_is_good_enough() {
    let points = [point(0, 10.0, 0.100), point(1, 5.0, 0.104), point(2, 1.0, 0.150)];
    let cheapest = |percent, noise| cheapest_within(&points, percent, noise).map(|point| point.run);
    assert_eq!([cheapest(0.0, 0.0), cheapest(5.0, 0.0), cheapest(50.0, 0.0)], [Some(0), Some(1), Some(2)]);
    // All are within noise: the fastest will do.
    assert_eq!(cheapest(0.0, 0.2), Some(2));
    assert_eq!(cheapest_within(&[], 5.0, 0.0), None);
}

#[test]
fn runs_of_equal_time_are_together() {
    let points = [
        point(0, 10.0, 0.1),
        point(1, 30.0, 0.1),
        point(2, 11.9, 0.1),
        point(3, 12.1, 0.1),
        point(4, 100.0, 0.1),
    ];
    let groups: Vec<Vec<usize>> = equal_times(&points, 0.2).iter().map(|group| indices(group)).collect();
    assert_eq!(groups, [[0, 2]]);
    let apart = [point(0, 1.0, 0.1), point(1, 10.0, 0.1), point(2, 40.0, 0.1)];
    assert_eq!(equal_times(&apart, 0.2), [[apart[1], apart[2]]], "4 × is nearer than 10 ×");
    assert!(equal_times(&apart[..1], 0.2).is_empty());
}

#[test]
fn marginals_are_medians_over_pairs_that_differ_in_one_coordinate() {
    let runs = [
        with(32.0, &[], 10.0, 0.4),
        with(128.0, &[], 40.0, 0.1),
        with(64.0, &[], 20.0, 0.2),
        with(32.0, &[("p", "many")], 16.0, 0.2),
        with(64.0, &[("p", "many")], 48.0, 0.15),
    ];
    let found = marginals(&runs, "box", "color", "relmse");
    let steps: Vec<(&str, &str, &str, usize)> =
        found.iter().map(|m| (m.name.as_str(), m.from.as_str(), m.to.as_str(), m.pairs)).collect();
    // 32 → 128 is no step where 64 is between; `p` was left alone in the first three.
    assert_eq!(steps, [("n", "32", "64", 2), ("n", "64", "128", 1), ("p", "", "many", 2)]);
    let near = |change: Option<Change>, difference: f64, ratio: f64| {
        let change = change.expect("known");
        assert!((change.difference - difference).abs() < 1e-12, "{change:?}");
        assert!((change.ratio.expect("known") - ratio).abs() < 1e-12, "{change:?}");
    };
    near(found[0].time, 21.0, 2.5); // of 10 → 20 and 16 → 48
    near(found[0].error, -0.125, 0.625); // of 0.4 → 0.2 and 0.2 → 0.15
    near(found[1].time, 20.0, 2.0);
    near(found[2].time, 17.0, 2.0); // of 10 → 16 and 20 → 48
}

#[test]
fn a_step_says_which_stages_it_adds() {
    let mut runs = [run(&[("p", "few")], 1.0, 0.2), run(&[("p", "many")], 2.0, 0.1)];
    runs[0].stages = vec![stage("trace", "run"), stage("second", "dropped"), stage("first", "kept")];
    runs[1].stages = vec![stage("trace", "run"), stage("second", "run"), stage("first", "dropped")];
    let found = marginals(&runs, "box", "color", "relmse");
    assert_eq!(found[0].stages_to, ["second"]);
    assert_eq!(found[0].stages_from, ["first"]);
}

#[test]
fn a_knob_that_was_not_set_has_its_default_value() {
    // The first leaves `n` at its default of 64.
    let runs = [run(&[], 20.0, 0.2), with(32.0, &[], 10.0, 0.4), with(128.0, &[], 40.0, 0.1)];
    let lines = lines(&runs, "box", "n");
    assert_eq!(lines.len(), 1);
    assert_eq!(lines[0].runs, [1, 0, 2]);
    assert!(coordinates(&runs[..1], "box").is_empty());
}

#[test]
fn other_scenes_and_pipelines_make_no_pairs() {
    let mut runs = [with(32.0, &[], 1.0, 0.1), with(64.0, &[], 2.0, 0.1)];
    runs[1].pipeline = "b".to_owned();
    assert!(marginals(&runs, "box", "color", "relmse").is_empty());
    runs[1].pipeline = "a".to_owned();
    assert_eq!(marginals(&runs, "box", "color", "relmse").len(), 1);
    runs[1].scene = "hall".to_owned();
    assert!(marginals(&runs, "box", "color", "relmse").is_empty());
}

fn some_points() -> impl Strategy<Value = Vec<Point>> {
    // Few values, so that equal ones are common.
    let pair = (1..6_u8, 0..6_u8);
    prop::collection::vec(pair, 0..12).prop_map(|pairs| {
        let point = |(run, (time, error)): (usize, (u8, u8))| point(run, f64::from(time), f64::from(error));
        pairs.into_iter().enumerate().map(point).collect()
    })
}

proptest! {
    #[test]
    fn the_front_is_what_its_definition_says(points in some_points()) {
        let front = front(&points);
        let beats = |a: &Point, b: &Point| {
            a.time <= b.time && a.error <= b.error && (a.time < b.time || a.error < b.error)
        };
        for candidate in &points {
            let beaten = points.iter().any(|other| beats(other, candidate));
            let there = front.iter().any(|p| p.time == candidate.time && p.error == candidate.error);
            prop_assert_eq!(there, !beaten);
        }
        prop_assert!(front.windows(2).all(|pair| pair[0].time < pair[1].time && pair[0].error > pair[1].error));
    }

    #[test]
    fn the_cheapest_is_on_the_front_where_nothing_is_noise(points in some_points(), percent in 0.0..200.0) {
        if let Some(cheapest) = cheapest_within(&points, percent, 0.0) {
            prop_assert!(front(&points).iter().any(|p| p.time == cheapest.time && p.error == cheapest.error));
        } else {
            prop_assert!(points.is_empty());
        }
    }

    #[test]
    fn groups_of_equal_time_share_no_run(points in some_points(), share in 0.0..1.0) {
        let groups = equal_times(&points, share);
        let mut all: Vec<usize> = groups.iter().flat_map(|group| indices(group)).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        prop_assert_eq!(all.len(), count);
        prop_assert!(groups.iter().all(|group| group.len() > 1));
        prop_assert_eq!(groups.is_empty(), points.len() < 2);
    }
}
