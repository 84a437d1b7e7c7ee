//! Each mistake in a kernel: its code, and the place in the author's file.

use super::*;

/// The only problem of composing and reflecting `files`.
fn problem(files: &[(&str, &str)]) -> Problem {
    let names = known(&[("scene.emissive", Value::Flag(true)), ("resolution", Value::Number(64.0))]);
    let result = Files::new(files).compose(&[("storage", "dense")], &names);
    only(result.and_then(|composed| reflect(&composed, &BTreeMap::new())))
}

/// The only problem of a `main` alone: its code and first label.
fn in_main(text: &str) -> (&'static str, (String, usize, usize, String)) {
    let problem = problem(&[("main", text)]);
    (problem.code, label(&problem, 0))
}

#[test]
fn an_unknown_kernel_is_named_where_the_pipeline_says_it() {
    let problem = problem(&[("mein", "")]);
    assert_eq!((problem.code, label(&problem, 0)), ("unknown-kernel", at("pipeline.ron", 1, 9, "\"main\"")));
    assert_eq!(problem.help.as_deref(), Some("did you mean `mein`?"));
}

#[test]
fn an_unknown_import() {
    let problem = problem(&[("main", "fn f() {}\nimport  lib/sampled ;"), ("lib/sample", "")]);
    assert_eq!((problem.code, label(&problem, 0)), ("unknown-kernel", at("main.wgsl", 2, 9, "lib/sampled")));
    assert_eq!(problem.help.as_deref(), Some("did you mean `lib/sample`?"));
    assert_eq!(in_main("import ../secret;"), ("bad-name", at("main.wgsl", 1, 8, "../secret")));
}

#[test]
fn a_ring_of_imports() {
    let problem = problem(&[("main", "import a;"), ("a", "import b;"), ("b", "\nimport a;")]);
    assert_eq!((problem.code, label(&problem, 0)), ("import-ring", at("b.wgsl", 2, 8, "a")));
    assert!(problem.message.ends_with("a → b → a"), "{}", problem.message);
}

#[test]
fn an_unknown_role() {
    let problem = problem(&[("main", "import role/storag;"), ("dense", "")]);
    assert_eq!((problem.code, label(&problem, 0)), ("unknown-role", at("main.wgsl", 1, 8, "role/storag")));
    assert_eq!(problem.help.as_deref(), Some("did you mean `storage`?"));
}

#[test]
fn one_file_in_two_roles() {
    let problem = problem(&[("main", "import role/storage;\nimport dense;"), ("dense", "")]);
    assert_eq!((problem.code, label(&problem, 0)), ("import-twice", at("main.wgsl", 2, 8, "dense")));
}

#[test]
fn a_name_declared_twice_points_at_both_files() {
    let problem = problem(&[("main", "import a;\nfn twice() {}"), ("a", "struct twice { x: f32 }")]);
    assert_eq!((problem.code, label(&problem, 0)), ("declared-twice", at("main.wgsl", 2, 4, "twice")));
    assert_eq!(label(&problem, 1), at("a.wgsl", 1, 8, "twice"));
}

#[test]
fn wgsl_errors_point_into_the_import_where_they_happened() {
    let body = "// é\nfn area(r: f32) -> f32 {\n    return r * 2u;\n}";
    let problem = problem(&[("main", "import lib/a;\nfn m() { }"), ("lib/a", body)]);
    assert_eq!((problem.code, label(&problem, 0)), ("wgsl", at("a.wgsl", 3, 12, "r * 2u")));
    assert_eq!(problem.message, "Operation Multiply can't work with f32 and u32");
    assert_eq!(label(&problem, 1), at("a.wgsl", 2, 4, "area"));
}

/// What a role's module lacks, another part may have.
#[test]
fn what_a_module_lacks_may_be_in_another_parts() {
    let main = "import role/storage;\nfn m() -> f32 { return brightness(); }";
    let problem = problem(&[("main", main), ("dense", "fn darkness() -> f32 { return 0.0; }")]);
    assert_eq!((problem.code, label(&problem, 0)), ("wgsl", at("main.wgsl", 2, 24, "brightness")));
    let help = problem.help.unwrap_or_default();
    assert!(help.contains("--part") && help.ends_with("here `role/storage` is `dense`"), "{help}");
}

#[test]
fn wgsl_errors_of_all_sorts_have_a_place() {
    let wgsl = |text| {
        let (code, label) = in_main(text);
        assert_eq!(code, "wgsl", "{text}");
        (label.1, label.2, label.3)
    };
    let there = |line, column, text: &str| (line, column, text.to_owned());
    assert_eq!(wgsl("fn f() -> u32 {\n  let x = y; }"), there(2, 11, "y"));
    assert_eq!(wgsl("fn f() {\n  let x = ; }"), there(2, 11, ";"));
    assert_eq!(wgsl("fn f() -> u32 { return 1f; }"), there(1, 24, "1f"));
    assert_eq!(wgsl("fn f() -> u32 { if true { return 1; } }"), there(1, 4, "f"));
    assert_eq!(wgsl("@vertex fn v() -> @location(0) vec4f { return vec4f(); }"), there(1, 12, "v"));
    assert_eq!(wgsl("var<uniform> a: array<f32, 4>;"), there(1, 14, "a"));
    let write = "var<storage> a: atomic<u32>; @compute @workgroup_size(1) fn main() { atomicAdd(&a, 1u); }";
    assert_eq!(wgsl(write), there(1, 1, "var<storage> a: atomic<u32>;"));
    let sample = "var t: texture_2d<f32>; var s: sampler;\n@compute @workgroup_size(1) fn c() { let x = textureSample(t, s, vec2f()); }";
    assert_eq!(wgsl(sample), there(2, 32, "c"));
}

#[test]
fn numbers_on_bindings_are_refused() {
    let text = "import dense;\n@group(0) @binding(1) var<uniform> x: vec4f;";
    let names = known(&[]);
    let Err(problems) = Files::new(&[("main", text), ("dense", "")]).compose(&[], &names) else { panic!() };
    assert_eq!(codes(&problems), ["numbered-binding"]);
    let labels: Vec<_> = problems.iter().map(|problem| label(problem, 0)).collect();
    assert_eq!(labels, [at("main.wgsl", 2, 1, "@group(0)")]);
}

#[test]
fn conditions_that_make_no_sense() {
    for (text, code, line, column, marked) in [
        ("@if(resolutoin > 2) const A = 1;", "unknown-name", 1, 5, "resolutoin"),
        ("const B = 1;\n@if(resolution) const A = 1;", "bad-condition", 2, 5, "resolution"),
        ("@if const A = 1;", "bad-condition", 1, 1, "@if"),
        ("@else const A = 1;", "lone-else", 1, 1, "@else"),
        ("@if(true) const A = 1; const B = 1; @elif(true) const C = 1;", "lone-else", 1, 37, "@elif(true)"),
        ("struct S { a: f32, @if(true) }", "lone-condition", 1, 20, "@if(true)"),
        ("fn f() { let x = @if(true) 1; }", "misplaced-condition", 1, 18, "@if"),
        ("@compute @if(true) @workgroup_size(1) fn f() {}", "misplaced-condition", 1, 10, "@if"),
        ("@if(false) fn f() { @if(nothing) return; }", "unknown-name", 1, 25, "nothing"),
    ] {
        assert_eq!(in_main(text), (code, at("main.wgsl", line, column, marked)), "{text}");
    }
    assert_eq!(
        problem(&[("main", "@if(scene.emisive) const A = 1;")]).help.as_deref(),
        Some("did you mean `scene.emissive`?")
    );
}

#[test]
fn files_that_would_run_into_the_next_one() {
    for (text, code, column, marked) in [
        ("fn f() { if (true) { }", "bracket", 8, "{"),
        ("fn f() }", "bracket", 8, "}"),
        ("fn f(] {}", "bracket", 6, "]"),
        ("fn f() {} /* /* */", "open-comment", 11, "/*"),
        ("const A = 1", "open-declaration", 1, "const"),
    ] {
        assert_eq!(in_main(text), (code, at("main.wgsl", 1, column, marked)), "{text}");
    }
}

#[test]
fn what_would_run_out_of_stack_is_too_long() {
    let many = |before: &str, piece: &str, after: &str| format!("{before}{}{after}", piece.repeat(50_000));
    assert_eq!(in_main(&many("fn f() { let x = ", "(", "")).0, "bracket");
    let level = format!("f(0, {}", "1 + ".repeat(50));
    for text in [
        format!("fn f() {{ {}1{}; }}", level.repeat(20), ")".repeat(20)),
        many("fn f() { let x = ", "!", "true; }"),
        many("fn f() { let x = 1", " + 1", "; }"),
        many("fn f() { var y = 1; let x = y", "[0]", "; }"),
        many("fn f() { if true {}", " else if true { return; }", "}"),
        many("fn f() { f(1, 2 + ", "!", "true); }"),
        many("const A0 = 1; ", "\n", "").replace('\n', "const X = 1;"),
    ] {
        let problems = Files::new(&[("main", &text)]).compose(&[], &known(&[])).map(|_| ()).unwrap_err();
        assert!(codes(&problems).contains(&"too-long"), "{}", &text[..40]);
    }
    let table = many("const TABLE = array(", "vec3f(1.0, 2.0, 3.0) + 1, ", "1); fn f() { ")
        + &"if true {} ".repeat(2000)
        + "}";
    assert!(Files::new(&[("main", &table)]).compose(&[], &known(&[])).is_ok());
    let chain: Vec<(String, String)> =
        (0..100).map(|i| (format!("k{i}"), format!("import k{};", i + 1))).collect();
    let chain: Vec<(&str, &str)> = chain.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let files = [&[("main", "import k0;")], &chain[..]].concat();
    assert_eq!(problem(&files).code, "deep-imports");
}

#[test]
fn interfaces_that_no_pipeline_has() {
    for (text, code, column, marked) in [
        ("@fragment fn f() -> @location(0) vec4f { return vec4f(); }", "unnamed-target", 14, "f"),
        (
            "@vertex fn v(@location(0) p: vec4f) -> @builtin(position) vec4f { return p; }",
            "vertex-input",
            12,
            "v",
        ),
        (
            "var<immediate> i: f32; @compute @workgroup_size(1) fn c() { let x = i; }",
            "unsupported-binding",
            16,
            "i",
        ),
    ] {
        assert_eq!(in_main(text), (code, at("main.wgsl", 1, column, marked)), "{text}");
    }
}

#[test]
fn all_problems_of_all_files_come_at_once() {
    let files = Files::new(&[
        ("main", "import a;\nimport b;\nimport c;"),
        ("a", "@else const A = 1;"),
        ("b", "fn b( {}"),
    ]);
    let Err(problems) = files.compose(&[], &known(&[])) else { panic!() };
    assert_eq!(codes(&problems), ["lone-else", "bracket", "unknown-kernel"]);
}
