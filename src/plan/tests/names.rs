//! Knobs, values, parts, scopes.

use super::*;

const KNOBS: &str = r#"knobs: {
    "resolution": (default: 64, range: (8, 512), about: ""),
    "gain": (default: 0.5, range: (0, 2), about: ""),
    "soft": (default: true, about: ""),
    "format": (default: "rgba8unorm", values: ["rgba8unorm", "rgba16float"], about: ""),
}, "#;

fn with_sets(sets: &[(&str, &str)]) -> Setup {
    let sets = sets.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
    Setup { sets, ..setup() }
}

#[test]
fn knobs_are_set() {
    let sets =
        [("resolution", "32"), ("gain", "1"), ("soft", "false"), ("format", "rgba16float"), ("gain", "2")];
    let plan = plan_with(KNOBS, &[], &with_sets(&sets));
    let values: Vec<_> = plan.knobs.iter().map(|knob| knob.value.to_string()).collect();
    assert_eq!(values, ["32", "2", "false", "'rgba16float'"]);
    assert!(plan.knobs.iter().all(|knob| knob.set));
    assert!(!super::plan(KNOBS).knobs.iter().any(|knob| knob.set));
}

#[test]
fn knobs_of_parts_are_set_by_path_or_last_piece() {
    let part = |role: &str, knob: &str| {
        format!(
            r#"Part(about: "", role: "{role}", knobs: {{"{knob}": (default: 1, range: (0, 9), about: "")}})"#
        )
    };
    let (a, b) = (part("a", "steps"), part("b", "steps"));
    let files = [("a", a.as_str()), ("b", b.as_str())];
    let text = r#"parts: {"a": "a", "b": "b"}, knobs: {"steps": (default: 1, range: (0, 9), about: "")}"#;
    let plan = plan_with(text, &files, &with_sets(&[("steps", "2"), ("b.steps", "3")]));
    let knobs: Vec<_> = plan.knobs.iter().map(|knob| (knob.path.as_str(), knob.value.to_string())).collect();
    assert_eq!(knobs, [("steps", "2".into()), ("a.steps", "1".into()), ("b.steps", "3".into())]);

    let text = r#"parts: {"a": "a", "b": "b"}"#;
    let found = problems(text, &files, &with_sets(&[("steps", "2")]));
    assert_eq!(
        (found[0].code, found[0].help.as_deref()),
        ("ambiguous-knob", Some("say which: a.steps, b.steps"))
    );
    let other = part("b", "rays");
    let plan = plan_with(text, &[("a", &a), ("b", &other)], &with_sets(&[("rays", "7")]));
    assert_eq!(plan.knobs[1].value, Value::Number(7.0));
}

/// Setting → code and the piece of `NAME=TEXT` that the first label marks.
#[test]
fn wrong_settings_point_at_their_piece() {
    for (name, text, code, piece) in [
        ("resolutoin", "32", "unknown-knob", "resolutoin"),
        ("resolution", "3", "knob-out-of-range", "3"),
        ("resolution", "32.5", "knob-type", "32.5"),
        ("gain", "inf", "knob-type", "inf"),
        ("gain", "x", "knob-type", "x"),
        ("soft", "1", "knob-type", "1"),
        ("format", "rgba8", "knob-out-of-range", "rgba8"),
    ] {
        let found = problems(KNOBS, &[], &with_sets(&[(name, text)]));
        let [problem] = found.as_slice() else { panic!("{found:?}") };
        let (place, _) = &problem.labels[0];
        assert_eq!((problem.code, place.source.name(), place.text()), (code, "--set", piece));
    }
    let found = problems(KNOBS, &[], &with_sets(&[("resolutoin", "32")]));
    assert_eq!(found[0].help.as_deref(), Some("did you mean `resolution`?"));
}

#[test]
fn values_know_what_they_depend_on() {
    let text = r#"knobs: {"n": (default: 4, range: (1, 8), about: "")}, values: {
        "plain": "n * 2 + output.width",
        "later": "snapped.x + plain",
        "snapped": "floor(camera.position / 2) * 2",
        "when": "frame.index + scene.triangles",
        "all": "if(when > later, lights.point, vec2(t.height).x)",
    }, resources: {"t": Texture(format: "r32float", size: ["n", "n + scene.triangles"], start: Covered)}"#;
    let plan = plan(text);
    let shown = |path: &str| (plan.value(path).value.to_string(), plan.value(path).causes.clone());
    use Cause::{Camera, Frame, Geometry, Lights};
    assert_eq!(shown("plain"), ("648".into(), [].into()));
    assert_eq!(shown("snapped"), ("vec3(0, 2, 2)".into(), [Camera].into()));
    assert_eq!(shown("later"), ("648".into(), [Camera].into()));
    assert_eq!(shown("when"), ("unknown".into(), [Frame, Geometry].into()));
    assert_eq!(shown("all"), ("unknown".into(), [Frame, Geometry, Lights, Camera].into()));
}

#[test]
fn values_follow_the_frame() {
    let text = r#"knobs: {"n": (default: 4, range: (1, 8), about: "")},
        resources: {"t": Texture(format: "r32float", size: ["n", 8], start: Covered)}, values: {
        "sum": "snapped.x + fixed + frame.index", "snapped": "floor(camera.position / 2) * 2",
        "fixed": "t.height + output.width + n", "inverse": "1 / camera.position.y"}"#;
    let plan = plan(text);
    let shown = |values: Vec<Value>| values.iter().map(Value::to_string).collect::<Vec<_>>();
    let moved = |y: f64| {
        features(&[
            ("camera.position", Value::Vector(vec![7.0, y, 0.0])),
            ("frame.index", Value::Number(3.0)),
        ])
    };
    assert_eq!(
        shown(plan.values_with(&BTreeMap::new()).unwrap()),
        ["unknown", "vec3(0, 2, 2)", "652", "0.5"]
    );
    assert_eq!(shown(plan.values_with(&moved(4.0)).unwrap()), ["661", "vec3(6, 4, 0)", "652", "0.25"]);
    assert_eq!(plan.values_with(&moved(0.0)).map_err(|problem| problem.code), Err("division-by-zero"));
}

const STORAGE: &str = r#"Part(about: "", role: "storage", module: "storage/isotropic", exports: ["radiance", "cell", "side"],
    knobs: {"side": (default: 32, range: (1, 64), about: ""), "gain": (default: 1, range: (0, 2), about: "")},
    values: {"cell": "size / side", "inner": "cell * gain"},
    resources: {
        "radiance": Texture(format: "rgba8unorm", size: ["side", "side", "side"], start: Covered),
        "counts": Buffer(count: "side * scale", start: Fill(0)),
    },
    stages: [Compute(kernel: "a/fill", over: Texels("radiance"), bind: {"target": "given@mip0"}),
             Compute(kernel: "a/count", name: "tally", over: Texels("counted"), when: "inner > 0")],
)"#;

const USE: &str = r#"parts: {"storage": "storage/isotropic"}, values: {"size": "side * 2", "other": "cell"},
    knobs: {"scale": (default: 3, range: (1, 4), about: "")},
    samplers: {"linear": (filter: Linear)},
    resources: {"color": Texture(format: "rgba16float", mips: 2, start: Covered)},
    stages: [
        Part(role: "storage", bind: {"given": "color", "counted": "color@mip1", "smooth": "linear", "amount": "scale"}),
        Part(role: "storage", name: "again", bind: {"given": "radiance", "counted": "color", "counts": "lights"}),
        Each(name: "i", over: Range(0, 2), stages: [
            Part(role: "storage", bind: {"given": "color", "counted": "color", "round": "i"})]),
        Compute(kernel: "view", over: Count(1), bind: {"field": "radiance", "smooth": "linear"}),
    ],
    outputs: {"color": "color@mip0"}"#;

#[test]
fn parts_see_and_show_what_they_should() {
    let plan = plan_with(USE, &[("storage/isotropic", STORAGE)], &setup());
    let paths =
        ["storage/fill", "storage/tally", "again/fill", "again/tally", "storage[0]/fill", "storage[0]/tally"];
    assert_eq!(plan.paths()[..6], paths);
    assert_eq!(plan.value("size").value, Value::Number(64.0));
    assert_eq!(plan.value("other").value, Value::Number(2.0));
    assert_eq!(plan.value("storage.inner").value, Value::Number(2.0));
    for (path, name, means) in [
        ("storage/fill", "given", "color"),
        ("storage/fill", "counted", "color@mip1"),
        ("storage/fill", "smooth", "sampler"),
        ("storage/fill", "linear", "sampler"),
        ("storage/fill", "amount", "knob scale"),
        ("storage/fill", "gain", "knob storage.gain"),
        ("storage/fill", "inner", "value storage.inner"),
        ("storage/fill", "counts", "storage.counts"),
        ("storage/fill", "radiance", "radiance"),
        ("storage/fill", "vertices", "vertices"),
        ("again/tally", "counts", "lights"),
        ("storage[1]/tally", "counts", "storage[1].counts"),
        ("storage[1]/tally", "round", "index 1"),
        ("storage[1]/tally", "i", "nothing"),
        ("view", "radiance", "radiance"),
        ("view", "smooth", "sampler"),
        ("view", "cell", "value storage.cell"),
        ("view", "side", "knob storage.side"),
        ("view", "gain", "nothing"),
        ("view", "inner", "nothing"),
        ("view", "counts", "nothing"),
    ] {
        assert_eq!(plan.means(path, name), means, "{name} for {path}");
    }
    assert_eq!(plan.bound("storage/fill", "target"), "color@mip0");
    assert_eq!(plan.bound("again/fill", "target"), "radiance@mip0");
    assert_eq!(plan.bound("view", "field"), "radiance");
    let Work::Compute(Threads::Texels(reference, _)) = &plan.stage("storage/tally").work else { panic!() };
    assert_eq!(plan.show(reference), "color@mip1");
    let module = &plan.modules["storage"];
    assert_eq!(module.kernel, "storage/isotropic");
    assert!(matches!(plan.lookup(module.scope, "radiance"), Some(Named::Resource(_))));
    assert_eq!(plan.lookup(module.scope, "counts"), None);
    assert_eq!(plan.kind("storage.counts"), &ResourceKind::Buffer { count: Some(96) });
    let outputs: Vec<_> = plan.outputs.iter().map(|(name, at, _)| (name.as_str(), plan.show(at))).collect();
    assert_eq!(outputs, [("color", "color@mip0".into())]);
    assert_eq!((plan.name.as_str(), plan.warnings.len()), ("test", 0));
}

#[test]
fn the_user_swaps_parts() {
    let small = STORAGE.replace("default: 32", "default: 16");
    let files = [("storage/isotropic", STORAGE), ("small", &small)];
    let plan = plan_with(USE, &files, &Setup { parts: vec![("storage".into(), "small".into())], ..setup() });
    assert_eq!(plan.value("size").value, Value::Number(32.0));
}
