//! Imports, roles, and where things come from.

use super::*;
use crate::kernel::describe;

const NONE: [(&str, &str); 0] = [];

#[test]
fn imports_come_once_before_their_importers_and_every_byte_keeps_its_place() {
    let files = Files::new(&[
        ("main", "// The kernel.\nimport lib/a;\nimport lib/b;\nfn m() { a(); b(); }"),
        ("lib/a", "import lib/c;\nfn a() { c(); } // no end of line"),
        ("lib/b", "import lib/c; /* ; import lib/x; */ fn b() { c(); }\n"),
        ("lib/c", "fn c() {}\n"),
    ]);
    let composed = files.compose(&NONE, &known(&[])).unwrap();
    let order: Vec<&str> = composed.segments.iter().map(|segment| segment.kernel.as_str()).collect();
    assert_eq!(order, ["lib/c", "lib/a", "lib/b", "main"]);
    assert_eq!(composed.about, "The kernel.");
    let text = &composed.text;
    let found = text.find("b() { c").unwrap();
    assert_eq!(composed.place(found..found + 1).line_column(), (1, 40));
    for (i, _) in text.char_indices().filter(|(_, c)| c.is_alphanumeric()) {
        assert_eq!(composed.place(i..i + 1).text(), &text[i..=i]);
    }
    assert!(reflect(&composed, &BTreeMap::new()).is_ok());
}

#[test]
fn a_role_is_the_file_that_the_pipeline_says_with_its_own_names() {
    let files = Files::new(&[
        ("main", "import role/storage; @compute @workgroup_size(1) fn run() { sample(); }"),
        (
            "dense",
            "import lib/x; var volume: texture_3d<f32>; fn sample() -> u32 { return textureDimensions(volume).x; }",
        ),
        ("lib/x", "@if(wide) const X = 1; @else const Y = 1;"),
        (
            "sparse",
            "@if(wide) var<storage> cells: array<u32>; @else var<storage> cells: array<vec2u>;
                    fn sample() -> u32 { return arrayLength(&cells); }",
        ),
    ]);
    let names = known(&[("wide", Value::Flag(true)), ("storage.wide", Value::Flag(false))]);
    let dense = files.compose(&[("storage", "dense")], &names).unwrap();
    assert_eq!(dense.declarations["volume"].role.as_deref(), Some("storage"));
    assert_eq!(dense.declarations["X"].role, None);
    assert!(!dense.declarations.contains_key("Y"));
    let sparse =
        reflect(&files.compose(&[("storage", "sparse")], &names).unwrap(), &BTreeMap::new()).unwrap();
    assert_eq!(
        (sparse.bindings[0].name.as_str(), sparse.bindings[0].role.as_deref()),
        ("cells", Some("storage"))
    );
    let crate::kernel::BindingKind::Storage(layout) = &sparse.bindings[0].kind else { panic!() };
    assert_eq!(layout.stride, Some(8));
}

#[test]
fn directives_of_imports_move_to_the_top_and_keep_their_place() {
    let files = Files::new(&[
        ("main", "import lib/half; fn m() -> f16 { return half(); }"),
        ("lib/half", "enable f16;\nimport lib/other;\nfn half() -> f16 { return 0.5h; }"),
        ("lib/other", "const OTHER = 1;"),
    ]);
    let composed = files.compose(&NONE, &known(&[])).unwrap();
    assert!(composed.text.starts_with("enable f16;\n"));
    assert_eq!(composed.place(0..6).line_column(), (1, 1));
    assert!(composed.place(0..6).source.name().ends_with("lib/half.wgsl"));
    reflect(&composed, &BTreeMap::new()).unwrap();
}

#[test]
fn a_dropped_import_is_not_even_looked_up() {
    let files =
        Files::new(&[("main", "@if(on) import lib/gone; @else import lib/there;"), ("lib/there", "")]);
    let on = |flag| known(&[("on", Value::Flag(flag))]);
    assert!(files.compose(&NONE, &on(false)).is_ok());
    assert_eq!(only(files.compose(&NONE, &on(true))).code, "unknown-kernel");
}

#[test]
fn a_description_has_the_widest_variant_or_says_which_role_it_needs() {
    let files = Files::new(&[
        (
            "main",
            "// Sums.\n// In W.\nimport lib/tools;\noverride n: u32;\n// What is summed.\n@if(x > 1) var<storage> terms: array<f32>;
             @compute @workgroup_size(n) fn run() { let x = terms[0]; }",
        ),
        ("lib/tools", "// Tools.\n\n// Tables.\nvar<uniform> table: vec4f;\nfn first() -> f32 { return table.x; }"),
        ("traced", "import main;\nimport role/storage;"),
    ]);
    let main = describe(&files.library, "main", &BTreeMap::new()).unwrap();
    assert_eq!((main.about.as_str(), main.imports), ("Sums.\nIn W.", vec!["lib/tools".to_owned()]));
    assert_eq!(
        main.bindings.iter().map(|b| (b.name.as_str(), b.about.as_str())).collect::<Vec<_>>(),
        [("terms", "What is summed.")]
    );
    assert_eq!((main.overrides[0].name.as_str(), main.overrides[0].default), ("n", None));
    let tools = describe(&files.library, "lib/tools", &BTreeMap::new()).unwrap();
    assert_eq!((tools.bindings[0].name.as_str(), tools.bindings[0].about.as_str()), ("table", "Tables."));
    let traced = describe(&files.library, "traced", &BTreeMap::new()).unwrap();
    assert_eq!((traced.needs, traced.entries.len()), (vec!["storage".to_owned()], 0));
    let roles = BTreeMap::from([("storage".to_owned(), "lib/tools".to_owned())]);
    let problem = only(describe(&files.library, "traced", &roles));
    assert_eq!(problem.code, "import-twice");
}
