//! Conditions, `Each`, `Repeat`, paths.

use super::*;
use proptest::prelude::*;

#[track_caller]
fn conditions(plan: &Plan) -> Vec<(&str, Condition)> {
    plan.stages.iter().map(|stage| (stage.path.as_str(), stage.condition.clone())).collect()
}

fn fails(why: &str) -> Condition {
    Condition::Fails(why.to_owned())
}

fn unknown(what: &str) -> Condition {
    Condition::Unknown(what.to_owned())
}

const CONDITIONS: &str = r#"knobs: {"on": (default: true, about: "")}, stages: [
    Compute(kernel: "a", over: Count(1), when: "scene.emissive"),
    Compute(kernel: "b", over: Count(1), when: "on"),
    Compute(kernel: "c", over: Count("scene.triangles", "lights.directional")),
    Raster(kernel: "d", draw: Points(0)),
    Each(name: "i", over: Range(0, 1), when: " lights.point > 0 ", stages: [
        Compute(kernel: "e", over: Count(1), when: "scene.triangles > 100"),
        Compute(kernel: "f", over: Count(1), when: "!on"),
    ]),
    Compute(kernel: "g", over: Count(1), when: "frame.index % 4 == 0"),
]"#;

#[test]
fn conditions_are_three_valued() {
    assert_eq!(
        conditions(&plan(CONDITIONS)),
        [
            ("a", fails("scene.emissive is false")),
            ("b", Condition::Holds),
            ("c", fails("count lights.directional is 0")),
            ("d", fails("count 0 is 0")),
            ("e[0]", fails("scene.triangles > 100 is false")),
            ("f[0]", fails("!on is false")),
            ("g", unknown("frame.index % 4 == 0")),
        ]
    );
    assert_eq!(
        conditions(&plan_with(CONDITIONS, &[], &no_scene())),
        [
            ("a", unknown("scene.emissive")),
            ("b", Condition::Holds),
            ("c", Condition::Holds),
            ("d", fails("count 0 is 0")),
            ("e[0]", unknown("lights.point > 0 && scene.triangles > 100")),
            ("f[0]", fails("!on is false")),
            ("g", unknown("frame.index % 4 == 0")),
        ]
    );
    let threads = |plan: &Plan| plan.stage("c").work.clone();
    assert_eq!(threads(&plan(CONDITIONS)), Work::Compute(Threads::Count(None)));
}

const EACH: &str = r#"parts: {"p": "p"},
    resources: {"t": Texture(format: "r32uint", size: [8, 8], mips: "all", layers: 3, start: Covered)}, stages: [
    Each(name: "n", over: Range(1, "t.mips - 1"), stages: [
        Compute(kernel: "k/mean", over: Texels("to"), bind: {"from": "t@mip(n - 1)", "to": "t@mip(n)"})]),
    Each(name: "n", over: Lights("point"), stages: [Raster(kernel: "draw", draw: Scene, bind: {"to": "t@layer(n)"})]),
    Each(name: "n", over: Lights("spot"), stages: [Compute(kernel: "s", over: Count("n + 1"))]),
    Each(name: "n", over: Lights("all"), stages: [Compute(kernel: "l", over: Count(1))]),
    Each(name: "n", over: Mips("t"), stages: [Part(role: "p", name: "call", bind: {"m": "n"})]),
    Each(name: "v", over: Views, stages: [
        Each(name: "n", over: Range("v", 2), stages: [Compute(kernel: "both", over: Count("v + 1", "n + 1"))])]),
]"#;

const P: &str = r#"Part(about: "", role: "p", stages: [
    Each(name: "o", over: Range(5, 7), stages: [Compute(kernel: "b", over: Count("m + o"))])])"#;

#[test]
fn each_goes_over_all_elements() {
    let plan = plan_with(EACH, &[("p", P)], &setup());
    let calls = (0..4).flat_map(|m| (5..7).map(move |o| format!("call[{m}]/b[{o}]")));
    let mut paths: Vec<String> = ["mean[1]", "mean[2]", "draw[0]", "draw[2]", "s[1]", "l[0]", "l[1]", "l[2]"]
        .map(str::to_owned)
        .into();
    paths.extend(calls);
    paths.extend(["both[0][0]", "both[0][1]", "both[1][1]", "both[2][2]"].map(str::to_owned));
    assert_eq!(plan.paths(), paths);
    assert_eq!(
        (plan.bound("mean[2]", "from"), plan.bound("mean[2]", "to")),
        ("t@mip1".into(), "t@mip2".into())
    );
    assert_eq!(plan.bound("draw[2]", "to"), "t@layer2");
    assert_eq!(plan.stage("s[1]").work, Work::Compute(Threads::Count(Some([2, 1, 1]))));
    assert_eq!(plan.stage("call[3]/b[6]").work, Work::Compute(Threads::Count(Some([9, 1, 1]))));
    let element = |name: &str, index, of| Element { name: name.to_owned(), index, of };
    let elements = [element("v", 1, ElementOf::View), element("n", 1, ElementOf::Range)];
    assert_eq!(plan.stage("both[1][1]").elements, elements);
    assert_eq!(plan.stage("draw[2]").elements, [element("n", 2, ElementOf::Light)]);
    assert_eq!(plan.stage("call[3]/b[6]").elements[0], element("n", 3, ElementOf::Range));
    assert_eq!(plan.stage("both[2][2]").condition, fails("no elements: nothing is from 2 to before 2"));
    assert_eq!(plan.means("both[0][1]", "n"), "index 1");
}

#[test]
fn no_elements_stand_as_one_that_is_dropped() {
    let none = Setup { elements: Some(Elements::default()), ..setup() };
    let plan = plan_with(EACH, &[("p", P)], &none);
    assert_eq!(plan.stage("draw[0]").condition, fails("no elements: there are 0 point lights"));
    assert_eq!(plan.stage("l[0]").condition, fails("no elements: there are 0 lights"));
    assert_eq!(plan.stage("both[0][1]").condition, fails("no elements: there are 0 views"));
    let plan = plan_with(EACH, &[("p", P)], &no_scene());
    assert_eq!(plan.stage("draw[0]").condition, unknown("the number of point lights"));
    assert_eq!(plan.stage("both[0][1]").condition, unknown("the number of views"));
    assert_eq!(plan.stage("mean[2]").condition, Condition::Holds);
    let text = r#"stages: [
        Each(name: "i", over: Range(3, "scene.triangles"), stages: [Compute(kernel: "a", over: Count("i"))]),
        Repeat(times: "scene.triangles", stages: [Compute(kernel: "b", over: Count(1))]),
        Repeat(times: 0, stages: [Compute(kernel: "c", over: Count(1))]),
    ]"#;
    let plan = plan_with(text, &[], &no_scene());
    assert_eq!(
        plan.stage("a[3]").condition,
        unknown("the number of elements from 3 to before scene.triangles")
    );
    assert_eq!(plan.stage("b[0]").condition, unknown("repeated scene.triangles times"));
    assert_eq!(plan.stage("c[0]").condition, fails("repeated 0 times: 0 is 0"));
}

#[test]
fn unnamed_stages_that_are_alike_are_numbered() {
    let stage = r#"Compute(kernel: "a/k", over: Count(1)), "#;
    let plan = plan(&format!(
        r#"stages: [{stage}{stage}{stage} Each(name: "i", over: Range(0, 2), stages: [{stage}{stage}]),
            Compute(kernel: "x", name: "own", over: Count(1)), Compute(kernel: "own", over: Count(1))]"#
    ));
    assert_eq!(plan.paths(), ["k", "k#2", "k#3", "k[0]", "k[0]#2", "k[1]", "k[1]#2", "own", "own#2"]);
}

const PAIR: &str = r#"
        "a": Texture(format: "r32uint", size: [4, 4], start: Covered),
        "b": Texture(format: "r32uint", size: [4, 4], start: Covered),
        "c": Texture(format: "r32uint", size: [4, 4], start: Covered),"#;

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// Names after swaps, against an array whose entries change places.
    #[test]
    fn swaps_move_names(
        loops in prop::collection::vec((0usize..5, prop::collection::vec((0usize..3, 1usize..3), 0..3), any::<bool>()), 0..4)
    ) {
        let names = ["a", "b", "c"];
        let bind = r#"bind: {"x": "a", "y": "b", "z": "c"}"#;
        let mut stages = String::new();
        for (i, (times, pairs, runs)) in loops.iter().enumerate() {
            let pairs: String =
                pairs.iter().map(|(a, by)| format!("(\"{}\", \"{}\"),", names[*a], names[(a + by) % 3])).collect();
            stages += &format!("Repeat(times: {times}, when: {runs}, swap: [{pairs}], stages: [
                Compute(kernel: \"k{i}\", over: Count(1), {bind})]), Compute(kernel: \"after{i}\", over: Count(1), {bind}),");
        }
        let plan = plan(&format!("resources: {{{PAIR}}}, stages: [{stages}], outputs: {{\"color\": \"b\"}}"));
        let mut now = names;
        let check = |path: &str, now: &[&str; 3]| {
            for (i, binding) in ["x", "y", "z"].iter().enumerate() {
                assert_eq!(plan.bound(path, binding), now[i]);
                assert_eq!(plan.means(path, names[i]), now[i]);
            }
        };
        for (i, (times, pairs, runs)) in loops.iter().enumerate() {
            let before = now;
            for round in 0..*times {
                check(&format!("k{i}[{round}]"), &now);
                pairs.iter().for_each(|(a, by)| now.swap(*a, (a + by) % 3));
            }
            if !runs {
                now = before;
            }
            check(&format!("after{i}"), &now);
        }
        prop_assert_eq!(plan.show(&plan.outputs[0].1), now[1]);
    }
}

/// A part swaps what it has been given: the names of the pipeline, of other parts and of their modules follow.
#[test]
fn swaps_in_parts_hold_outside_too() {
    let storage = r#"Part(about: "", role: "storage", module: "m", exports: ["light", "spare"], resources: {
        "light": Buffer(count: 4, start: Covered), "spare": Buffer(count: 4, start: Covered)})"#;
    let spread = r#"Part(about: "", role: "spread", resources: {"own": Buffer(count: 4, start: Covered)}, stages: [
        Repeat(times: 3, swap: [("front", "own")], stages: [
            Compute(kernel: "k", over: Count(1), bind: {"from": "front", "to": "own"})])])"#;
    let text = r#"parts: {"storage": "storage", "spread": "spread"}, stages: [
        Compute(kernel: "before", over: Count(1)),
        Part(role: "spread", bind: {"front": "light"}),
        Compute(kernel: "after", over: Count(1), bind: {"x": "light"}),
        Part(role: "spread", name: "again", bind: {"front": "light"}),
        Compute(kernel: "last", over: Count(1)),
    ]"#;
    let plan = plan_with(text, &[("storage", storage), ("spread", spread)], &setup());
    assert_eq!(plan.means("before", "light"), "light");
    assert_eq!(plan.bound("spread/k[0]", "from"), "light");
    assert_eq!(plan.bound("spread/k[1]", "from"), "spread.own");
    assert_eq!(plan.bound("spread/k[1]", "to"), "light");
    assert_eq!(plan.means("spread/k[1]", "front"), "spread.own");
    assert_eq!(plan.bound("after", "x"), "spread.own");
    assert_eq!(plan.means("after", "light"), "spread.own");
    assert_eq!(plan.bound("again/k[0]", "from"), "spread.own");
    assert_eq!(plan.bound("again/k[1]", "to"), "spread.own");
    let in_module = |path: &str| {
        let scope = plan.module_scope(plan.stage(path), "storage").unwrap();
        match plan.lookup(scope, "light") {
            Some(Named::Resource(reference)) => plan.show(reference),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(in_module("before"), "light");
    assert_eq!(in_module("after"), "spread.own");
    assert_eq!(in_module("last"), "again.own");
}
