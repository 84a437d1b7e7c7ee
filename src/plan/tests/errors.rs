//! Every mistake has its code and its place.

use super::*;

/// The piece between « and » is what the first label of the only problem `code` marks.
#[track_caller]
fn errs(marked: &str, code: &str) -> Problem {
    errs_with(marked, &[], &setup(), code)
}

#[track_caller]
fn errs_with(marked: &str, parts: &[(&str, &str)], setup: &Setup, code: &str) -> Problem {
    let clean = |text: &str| text.replace(['«', '»'], "");
    let files: Vec<(&str, String)> = parts.iter().map(|(name, text)| (*name, clean(text))).collect();
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let found = problems(&clean(marked), &files, setup);
    let [problem] = found.as_slice() else { panic!("{marked}: {found:#?}") };
    let texts = [marked].into_iter().chain(parts.iter().map(|(_, text)| *text));
    let (line_offset, text) = texts.enumerate().find(|(_, text)| text.contains('«')).unwrap();
    let start = text.find('«').unwrap();
    let piece = &text[start + 2..text.find('»').unwrap()];
    let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    // The pipeline's fields begin in line 2 of its file, those of a part in line 1.
    let line = text[..start].matches('\n').count() + if line_offset == 0 { 2 } else { 1 };
    let column = text[line_start..start].chars().count() + 1;
    let (place, _) = &problem.labels[0];
    assert_eq!(
        (problem.code, place.text(), place.line_column()),
        (code, piece, (line, column)),
        "{problem:?}"
    );
    problem.clone()
}

#[test]
fn knobs() {
    for (knob, code) in [
        ("default: «9», range: (0, 4)", "knob-out-of-range"),
        ("default: «9», values: [1, 2]", "knob-out-of-range"),
        ("default: «9»", "bad-knob"),
        ("default: «\"a\"»", "bad-knob"),
        ("default: «\"a\"», range: (0, 1)", "bad-knob"),
        ("default: «true», range: (0, 1)", "bad-knob"),
        ("default: «1», values: [1, 1.5]", "bad-knob"),
        ("default: «true», values: [true, 1]", "bad-knob"),
    ] {
        errs(&format!("knobs: {{\n\"k\": ({knob}, about: \"\")}}"), code);
    }
}

#[test]
fn expressions() {
    errs(r#"values: {"a": "1 + «onn»"}"#, "unknown-name");
    errs(r#"values: {"a": "1 «)»"}"#, "expression-syntax");
    errs(r#"values: {"a": "1 / «0»"}"#, "division-by-zero");
    let help = errs(r#"values: {"a": "«scene.triangels»"}"#, "unknown-name").help;
    assert_eq!(help.as_deref(), Some("did you mean `scene.triangles`?"));
    let help = errs(
        r#"resources: {"volume": Buffer(start: Covered)}, values: {"a": "«volume.cout»"}"#,
        "unknown-name",
    )
    .help;
    assert_eq!(help.as_deref(), Some("did you mean `volume.count`?"));
    let ring = errs(
        r#"values: {"«a»": "b + 1", "b": "t.width", "c": "a"},
        resources: {"t": Texture(format: "r32uint", size: ["a", 1], start: Covered)}"#,
        "ring",
    );
    assert_eq!(ring.message, "`a` depends on itself: a → b → t → a");
    assert_eq!(ring.labels.len(), 3);
    let values: Vec<String> = (0..30).map(|i| format!("\"a{i}\": \"a{}\"", i + 1)).collect();
    let found = problems(&format!("values: {{{}, \"a30\": 1}}", values.join(", ")), &[], &setup());
    assert!(found.iter().all(|problem| problem.code == "expression-depth"));
    let values: Vec<String> = (0..3000).rev().map(|i| format!("\"a{i}\": \"a{}\"", i + 1)).collect();
    plan(&format!("values: {{\"a3000\": 1, {}}}", values.join(", ")));
}

#[test]
fn names() {
    errs(r#"values: {"a": 1}, resources: {"«a»": Buffer(start: Covered)}"#, "duplicate-name");
    let stages = r#"Compute(kernel: "k", name: "a", over: Count(1)), Compute(kernel: "k", name: "«a»", over: Count(1))"#;
    assert_eq!(errs(&format!("stages: [{stages}]"), "duplicate-name").labels.len(), 2);
    errs(&format!("stages: [Each(name: \"i\", over: Range(0, 3), stages: [{stages}])]"), "duplicate-name");
}

#[test]
fn sizes() {
    for (resource, code) in [
        ("Buffer(count: «0», start: Covered)", "size-zero"),
        ("Buffer(count: \"«lights.directional»\", start: Covered)", "size-zero"),
        ("Buffer(count: «-1», start: Covered)", "out-of-range"),
        ("Buffer(count: \"«1 / 2»\", start: Covered)", "not-whole"),
        ("Buffer(count: «true», start: Covered)", "wrong-type"),
        ("Texture(format: \"r32uint\", size: [1, «0»], start: Covered)", "size-zero"),
        ("Texture(format: \"r32uint\", size: [1, «4294967296»], start: Covered)", "out-of-range"),
        ("Texture(format: \"r32uint\", size: [4, 9], mips: «5», start: Covered)", "too-many-mips"),
        ("Texture(format: \"r32uint\", size: [9], mips: «2», start: Covered)", "too-many-mips"),
        ("Texture(format: \"r32uint\", size: [9], layers: «2», start: Covered)", "layers"),
        ("Texture(format: \"r32uint\", size: [9, 9], layers: «0», start: Covered)", "size-zero"),
        ("Texture(format: \"«r32unit»\", start: Covered)", "unknown-format"),
        ("Texture(format: \"«'rgba8'»\", start: Covered)", "unknown-format"),
        ("Texture(format: «5», start: Covered)", "unknown-format"),
        ("Texture(format: \"«scene.triangles»\", start: Covered)", "wrong-type"),
    ] {
        errs(&format!("resources: {{\n  \"t\": {resource}}}"), code);
    }
    let help =
        errs(r#"resources: {"t": Texture(format: "«r32unit»", start: Covered)}"#, "unknown-format").help;
    assert_eq!(help.as_deref(), Some("did you mean `r32uint`?"));
    errs_with(
        r#"resources: {"t": Texture(format: "«if(scene.emissive, 'r32uint', 'r32sint')»", start: Covered)}"#,
        &[],
        &no_scene(),
        "format-unknown",
    );
    errs(r#"resources: {"«t»": Buffer(count: "frame.index", start: Covered)}"#, "size-per-frame");
}

#[test]
fn references() {
    let resources = r#"resources: {"mips": Texture(format: "r32uint", size: [4, 4], mips: 2, start: Covered),
        "layers": Texture(format: "r32uint", size: [4, 4], layers: 2, start: Covered), "list": Buffer(start: Covered)},
        knobs: {"k": (default: true, about: "")}, samplers: {"s": ()}"#;
    for (reference, code) in [
        ("«mipz»", "unknown-resource"),
        ("«mipz» @ mip1", "unknown-resource"),
        ("mips@«map1»", "bad-reference"),
        ("mips@«mip»", "bad-reference"),
        ("mips@«mip(1»", "bad-reference"),
        ("mips@mip0@«mip1»", "bad-reference"),
        ("mips@mip«2»", "out-of-range"),
        ("mips@mip(«1 + 1»)", "out-of-range"),
        ("mips@mip(«-1»)", "out-of-range"),
        ("mips@mip(«0.5»)", "not-whole"),
        ("mips@mip(1 + «x»)", "unknown-name"),
        ("layers@layer«2»", "out-of-range"),
        ("mips@layer«0»", "bad-reference"),
        ("list@mip«0»", "bad-reference"),
        ("«k»@mip0", "not-a-resource"),
        ("mips@«previous»", "not-kept"),
        ("lights@«previous»", "not-kept"),
    ] {
        let stages = [
            format!("Compute(kernel: \"a\", over: Count(1), bind: {{\"x\": \"{reference}\"}})"),
            format!("Compute(kernel: \"a\", over: Texels(\"{reference}\"))"),
            format!("Compute(kernel: \"a\", over: Indirect(buffer: \"{reference}\"))"),
            format!("Raster(kernel: \"a\", draw: Scene, depth: (target: \"{reference}\", compare: Less))"),
        ];
        for stage in stages {
            errs(&format!("{resources},\nstages: [{stage}]"), code);
        }
        errs(&format!("{resources},\noutputs: {{\"o\": \"{reference}\"}}"), code);
    }
    errs(&format!("{resources}, outputs: {{\"o\": \"«s»\"}}"), "not-a-resource");
    let problem = errs(&format!("{resources}, outputs: {{\"o\": \"mips@mip«7»\"}}"), "out-of-range");
    assert_eq!(problem.message, "there is no mip 7 of `mips`: the last is 1");
    let help = errs(&format!("{resources}, outputs: {{\"o\": \"«lauers»\"}}"), "unknown-resource").help;
    assert_eq!(help.as_deref(), Some("did you mean `layers`?"));
    let escaped = r#"outputs: {"o": "«\u{6c}ist»"}"#;
    errs(&format!("{resources}, {escaped}"), "bad-reference");
}

#[test]
fn stages() {
    errs(r#"stages: [Compute(kernel: "a", over: Count(1), when: "«1»")]"#, "bad-condition");
    errs(r#"stages: [Compute(kernel: "a", over: Count(1), when: "«on»")]"#, "unknown-name");
    errs(r#"stages: [Compute(kernel: "a", over: Count("«0.5»"))]"#, "not-whole");
    errs(r#"stages: [Raster(kernel: "a", draw: Points("«'x'»"))]"#, "wrong-type");
    errs(r#"stages: [Each(name: "i", over: Mips("«lights»"), stages: [])]"#, "not-a-texture");
    errs(r#"stages: [Each(name: "i", over: Range(0, "«-3»"), stages: [])]"#, "out-of-range");
    errs(r#"stages: [Each(name: "i", over: «Range(0, 5000)», stages: [])]"#, "too-many-stages");
    errs(r#"stages: [Repeat(times: «1e12», stages: [])]"#, "too-many-stages");
    let nested = r#"Each(name: "j", over: «Range(0, 100)», stages: [Compute(kernel: "a", over: Count(1))])"#;
    errs(
        &format!(r#"stages: [Each(name: "i", over: Range(0, 100), stages: [{nested}])]"#),
        "too-many-stages",
    );
    let many = vec![r#"Compute(kernel: "a", over: Count(1))"#; 60].join(",");
    let found = problems(&format!(r#"stages: [Repeat(times: 100, stages: [{many}])]"#), &[], &setup());
    assert_eq!(found.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["too-many-stages"]);
}

#[test]
fn swaps() {
    let swap = |resources: &str, times: &str, a: &str, b: &str| {
        format!(
            "resources: {{{resources}}},\nstages: [Repeat(times: {times}, swap: [(\"{a}\", \"{b}\")], stages: [])]"
        )
    };
    let buffer = |count: u32, start: &str| format!("Buffer(count: {count}, start: {start})");
    let two = |a: &str, b: &str| format!("\"a\": {a}, \"b\": {b}");
    let (one, other) = (buffer(1, "Covered"), buffer(2, "Covered"));
    assert_eq!(errs(&swap(&two(&one, &other), "2", "«a»", "b"), "bad-swap").labels.len(), 4);
    errs(&swap(&two(&one, &buffer(1, "Fill(0)")), "2", "«a»", "b"), "bad-swap");
    errs(&swap(&two(&one, &one), "2", "«lights»", "b"), "bad-swap");
    errs(&swap(&two(&one, &one), "2", "a", "«c»"), "unknown-resource");
    errs(&swap(&two(&one, &one), "\"«frame.index»\"", "a", "b"), "swap-per-frame");
    let kept = buffer(1, "Kept");
    errs(&swap(&two(&kept, &kept), "3", "«a»", "b"), "swap-kept");
    plan(&swap(&two(&kept, &kept), "4", "a", "b"));
    let inner = r#"Repeat(times: 1, swap: [("a", "b")], stages: [])"#;
    errs(
        &format!(
            "resources: {{{}}}, stages: [Each(name: \"i\", over: Range(0, 1), when: \"«frame.index > 3»\", stages: [{inner}])]",
            two(&one, &one)
        ),
        "swap-per-frame",
    );
}

#[test]
fn parts() {
    let part = r#"Part(about: "", role: "a", stages: [])"#;
    errs(r#"parts: {"a": "«gone»"}"#, "unknown-part");
    errs(r#"parts: {"a": "«../a»"}"#, "bad-name");
    errs(r#"stages: [Part(role: "«b»")]"#, "unknown-role");
    assert_eq!(errs_with(r#"parts: {"b": "«p»"}"#, &[("p", part)], &setup(), "wrong-role").labels.len(), 2);
    errs_with(r#"parts: {"b": "«p»"}"#, &[("p", "Pipeline(about: \"\")")], &setup(), "not-a-part");
    let inner = r#"Part(about: "", role: "a", stages: [Part(role: "«a»")])"#;
    errs_with(r#"parts: {"a": "p"}, stages: [Part(role: "a")]"#, &[("p", inner)], &setup(), "part-in-part");
    errs_with(
        r#"parts: {"a": "p"}"#,
        &[("p", r#"Part(about: "", role: "a", exports: ["«x»"])"#)],
        &setup(),
        "unknown-export",
    );
    errs_with(
        r#"parts: {"a": "p"}"#,
        &[("p", r#"Part(«abuot»: "", about: "", role: "a")"#)],
        &setup(),
        "unknown-field",
    );
    let exports = |role: &str, name: &str| {
        let resource = "resources: {\"x\": Buffer(start: Covered)}";
        format!("Part(about: \"\", role: \"{role}\", exports: [\"{name}\"], {resource})")
    };
    let (first, second) = (exports("a", "x"), exports("b", "«x»"));
    let both = [("p", first.as_str()), ("q", second.as_str())];
    assert_eq!(
        errs_with(r#"parts: {"a": "p", "b": "q"}"#, &both, &setup(), "duplicate-name").labels.len(),
        2
    );
    errs_with(r#"parts: {"b": "q"}, values: {"x": 1}"#, &both[1..], &setup(), "duplicate-name");
    let source = Source::new("part.ron", part);
    let document = crate::document::parse(&source).unwrap();
    let found = expand(&document, &Library::default(), &setup()).unwrap_err();
    assert_eq!(found.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["not-a-pipeline"]);
    for (role, name, code, piece) in [("b", "p", "unknown-role", "b"), ("a", "gone", "unknown-part", "gone")]
    {
        let put_in = Setup { parts: vec![(role.into(), name.into())], ..setup() };
        let found = problems(r#"parts: {"a": "p"}"#, &[("p", part)], &put_in);
        let (place, _) = &found[0].labels[0];
        assert_eq!((found[0].code, place.source.name(), place.text()), (code, "--part", piece));
    }
}

#[test]
fn all_are_found_at_once_and_each_once() {
    let found = problems(
        r#"knobs: {"k": (default: 9, range: (0, 4), about: "")}, values: {"v": "gone"},
        resources: {"t": Texture(format: "nope", size: ["v", 0], start: Covered)},
        stages: [Repeat(times: 5, stages: [Compute(kernel: "a", over: Texels("u"), when: "k")])],
        outputs: {"o": "t@mip3"}"#,
        &[],
        &Setup { sets: vec![("z".into(), "1".into())], ..setup() },
    );
    let mut codes: Vec<_> = found.iter().map(|problem| problem.code).collect();
    codes.sort_unstable();
    let expected = [
        "bad-condition",
        "knob-out-of-range",
        "out-of-range",
        "size-zero",
        "unknown-format",
        "unknown-knob",
        "unknown-name",
        "unknown-resource",
    ];
    assert_eq!(codes, expected);
}

#[test]
fn progress() {
    let knobs = "knobs: { \"first\": (default: 0, range: (0, 9), about: \"\") }";
    for (progress, code) in [
        ("(batch: 4, frames: 1, first: \"«frist»\")", "unknown-knob"),
        ("(batch: \"«first»\", frames: 1, first: \"first\")", "size-zero"),
        ("(batch: 4, frames: \"«first - 1»\", first: \"first\")", "out-of-range"),
    ] {
        errs(&format!("{knobs},\nprogress: {progress}"), code);
    }
}

/// A pipeline whose only part, in the role `fill`, is this.
#[track_caller]
fn errs_in_part(part: &str, code: &str) -> Problem {
    errs_with(
        r#"parts: {"fill": "fill/one"}, stages: [Part(role: "fill")]"#,
        &[("fill/one", part)],
        &setup(),
        code,
    )
}

/// What a module has in stages over what moves must be there, and so must what it has in others.
#[test]
fn modules_see_what_is_exported() {
    let part = |moving: &str| {
        format!(
            r#"Part(about: "", role: "fill", module: "fill", moving: {{{moving}}}, exports: ["cells", "moving_cells"],
            resources: {{"cells": Buffer(count: 1, start: Fill(0)), "moving_cells": Buffer(count: 1, start: Fill(0)),
            "own": Buffer(count: 1, start: Fill(0))}})"#
        )
    };
    let problem = errs_in_part(&part(r#""«cell»": "moving_cells""#), "unknown-resource");
    assert_eq!(problem.help.as_deref(), Some("did you mean `cells`?"));
    errs_in_part(&part(r#""cells": "«moved_cells»""#), "unknown-resource");
    errs_in_part(&part(r#""cells": "«own»""#), "unknown-resource");
    let pipeline = r#"parts: {"fill": "fill/one"}, stages: [Part(role: "fill")]"#;
    let plan = plan_with(pipeline, &[("fill/one", &part(r#""cells": "moving_cells""#))], &setup());
    assert_eq!(plan.modules["fill"].moving["cells"], "moving_cells");
}

#[test]
fn a_module_has_a_name_of_its_own() {
    let one = r#"Part(about: "", role: "one", module: "one", modules: {"two": "«elsewhere»"})"#;
    let two = r#"Part(about: "", role: "two", module: "two")"#;
    let pipeline = r#"parts: {"two": "two", "one": "one"}"#;
    let parts = [("two", two), ("one", one)];
    errs_with(pipeline, &parts, &setup(), "duplicate-module");
    let plan = plan_with(
        pipeline,
        &[
            ("two", two),
            ("one", &one.replace(": \"«elsewhere»\"", ": \"elsewhere\"").replace("\"two\": ", "\"third\": ")),
        ],
        &setup(),
    );
    assert_eq!(plan.modules["third"].kernel, "elsewhere");
    assert!(plan.modules["one"].order_dependent.is_none());
}
