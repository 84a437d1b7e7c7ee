//! Random pipelines: none panics, all plan alike each time, and what is planned holds together.

use super::*;
use proptest::prelude::*;
use proptest::sample::select;

fn expression() -> impl Strategy<Value = String> {
    let number = select(vec![
        "1",
        "2",
        "3",
        "n",
        "v",
        "w",
        "t.mips",
        "t.width",
        "u.layers",
        "b.count",
        "scene.triangles",
        "lights.point",
        "0",
    ]);
    let unsure =
        select(vec!["i", "j", "lights.directional", "frame.index", "camera.position.x", "gone", "true", "s"]);
    let leaf = prop_oneof![100 => number, 1 => unsure];
    leaf.prop_map(str::to_owned).prop_recursive(2, 4, 2, |inner| {
        let operator = prop_oneof![40 => select(vec!["+", "*"]), 1 => select(vec!["-", "/", "%", "<"])];
        (inner.clone(), inner, operator).prop_map(|(a, b, operator)| format!("({a} {operator} {b})"))
    })
}

fn reference() -> impl Strategy<Value = String> {
    let right = select(vec![
        "t",
        "u",
        "b",
        "c",
        "lights",
        "t@mip0",
        "t@mip(v)",
        "u@layer0",
        "t@previous",
        "t@mip1@previous",
    ]);
    let unsure = (select(vec!["t", "u", "b", "x", "n"]), select(vec!["@mip7", "@layer(i)", "@previous", ""]));
    prop_oneof![
        60 => right.prop_map(str::to_owned),
        1 => unsure.prop_map(|(name, suffix)| format!("{name}{suffix}")),
    ]
}

/// A stage that calls parts, or one inside of a part.
fn stage(calls: bool) -> impl Strategy<Value = String> {
    let when = prop_oneof![
        3 => Just(String::new()),
        1 => expression().prop_map(|when| format!("when: \"{when} > 1\",")),
        1 => Just("when: \"scene.emissive\",".to_owned()),
    ];
    let call = (reference(), when.clone(), prop::bool::weighted(0.03))
        .prop_map(|(reference, when, named)| {
            let name = if named { "name: \"a\"," } else { "" };
            format!("kernel: \"k/l\", {name} {when} bind: {{\"x\": \"{reference}\"}},")
        })
        .boxed();
    let calls = if calls { 20 } else { 1 };
    let leaf = prop_oneof![
        20 => (call.clone(), expression())
            .prop_map(|(call, count)| format!("Compute({call} over: Count(\"{count}\", 2)),")),
        20 => (call.clone(), reference())
            .prop_map(|(call, over)| format!("Compute({call} over: Texels(\"{over}\")),")),
        20 => (call, expression()).prop_map(|(call, count)| format!("Raster({call} draw: Points(\"{count}\")),")),
        calls => (reference(), when.clone()).prop_map(|(reference, when)| format!(
            "Part(role: \"p\", {when} bind: {{\"x\": \"{reference}\"}}),"
        )),
    ];
    leaf.prop_recursive(3, 12, 3, move |inner| {
        let stages = prop::collection::vec(inner, 0..3).prop_map(|stages| stages.concat());
        let over = prop_oneof![
            (0..3, expression()).prop_map(|(from, to)| format!("Range({from}, \"min(5, {to})\")")),
            Just("Mips(\"t\")".to_owned()),
            Just("Views".to_owned()),
            Just("Lights(\"point\")".to_owned()),
        ];
        prop_oneof![
            (over, stages.clone(), select(vec!["i", "j"])).prop_map(|(over, stages, name)| format!(
                "Each(name: \"{name}\", over: {over}, stages: [{stages}]),"
            )),
            (expression(), stages, when.clone()).prop_map(|(times, stages, when)| {
                format!(
                    "Repeat(times: \"min(3, {times})\", {when} swap: [(\"b\", \"c\")], stages: [{stages}]),"
                )
            }),
        ]
    })
}

/// The fields of a pipeline, and the stages of its part.
fn pipeline() -> impl Strategy<Value = (String, String)> {
    let stages = |calls| prop::collection::vec(stage(calls), 0..4).prop_map(|stages| stages.concat());
    let small =
        select(vec!["4", "n", "v + 1", "n * 2", "scene.triangles", "lights.point"]).prop_map(str::to_owned);
    let size = move || prop_oneof![40 => small.clone(), 1 => expression()];
    (size(), size(), size(), size(), stages(true), stages(false)).prop_map(|(width, layers, count, value, stages, inner)| {
        let text = format!(
            r#"parts: {{"p": "p"}}, knobs: {{"n": (default: 3, range: (0, 9), about: "")}}, samplers: {{"s": ()}},
            values: {{"v": 2, "w": "{value}"}}, resources: {{
                "t": Texture(format: "r32uint", size: ["{width}", 4], mips: "all", start: Kept),
                "u": Texture(format: "r32uint", size: [4, 4], layers: "{layers}", start: Covered),
                "b": Buffer(count: "{count}", start: Covered), "c": Buffer(count: "{count}", start: Covered),
            }}, stages: [{stages}], outputs: {{"color": "t"}}"#
        );
        let part = format!(
            r#"Part(about: "", role: "p", resources: {{"x": Buffer(count: "n", start: Covered)}}, stages: [{inner}])"#
        );
        (text, part)
    })
}

fn whole_holds_together(plan: &Plan) {
    let mut paths = BTreeSet::new();
    for stage in &plan.stages {
        assert!(paths.insert(&stage.path), "{} stands twice", stage.path);
        assert!(stage.scope < plan.scopes.len());
        for (reference, place) in stage.bind.values() {
            holds_together(plan, reference);
            assert!(!place.text().is_empty());
        }
        match &stage.work {
            Work::Compute(Threads::Count(Some(count))) => assert!(count.iter().all(|n| *n > 0)),
            Work::Compute(Threads::Texels(reference, _)) => holds_together(plan, reference),
            Work::Raster { draw: Draw::Points(Some(count)), .. } => assert!(*count > 0),
            _ => {}
        }
    }
    for scope in &plan.scopes {
        assert!(scope.parent.is_none_or(|parent| parent < plan.scopes.len()));
    }
}

fn holds_together(plan: &Plan, reference: &Reference) {
    let resource = &plan.resources[reference.resource];
    if let ResourceKind::Texture { mips, layers, array, .. } = resource.kind {
        assert!(reference.mip.zip(mips).is_none_or(|(mip, mips)| mip < mips));
        assert!(reference.layer.zip(layers).is_none_or(|(layer, layers)| layer < layers));
        assert!(array || reference.layer.is_none());
    } else {
        assert_eq!((reference.mip, reference.layer), (None, None));
    }
    assert!(!reference.previous || matches!(resource.start, Start::Kept { .. }) && resource.history);
}

proptest! {
    #[test]
    fn random_pipelines_hold_together((text, part) in pipeline(), scene in any::<bool>()) {
        let setup = if scene { setup() } else { no_scene() };
        let parts = [("p", part.as_str())];
        let (_folder, library) = library(&parts);
        let document = document(&text).unwrap();
        match (expand(&document, &library, &setup), expand(&document, &library, &setup)) {
            (Ok(plan), Ok(again)) => {
                whole_holds_together(&plan);
                let values: Vec<Value> = plan.values.iter().map(|value| value.value.clone()).collect();
                prop_assert_eq!(plan.values_with(&BTreeMap::new()), Ok(values));
                prop_assert_eq!(format!("{plan:?}"), format!("{again:?}"));
            }
            (Err(found), Err(again)) => {
                for problem in found.iter() {
                    prop_assert!(!problem.labels.is_empty(), "{:?}", problem);
                }
                prop_assert_eq!(found.to_string(), again.to_string());
            }
            _ => prop_assert!(false, "planned once only"),
        }
    }
}

/// Else the property above would hold of nothing.
#[test]
fn enough_random_pipelines_can_be_planned() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    let mut codes = BTreeMap::new();
    for _ in 0..200 {
        let (text, part) = pipeline().new_tree(&mut runner).unwrap().current();
        let code = match try_plan(&text, &[("p", &part)], &setup()) {
            Ok(plan) if plan.stages.is_empty() => "without stages",
            Ok(_) => "planned",
            Err(problems) => problems.iter().next().unwrap().code,
        };
        *codes.entry(code).or_insert(0) += 1;
    }
    assert!((50..200).contains(&codes["planned"]), "{codes:?}");
    assert!(codes.len() > 5, "{codes:?}");
}
