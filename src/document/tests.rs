use super::*;
use proptest::prelude::*;

/// Every sort of element, with comments, raw texts and odd spacing.
const FULL: &str = r##"// A comment before.
/* and /* nested */ one */
Pipeline(
    about: "Rays, trächtig mit ümlauts",
    knobs: {
        "resolution": (default: 64, range: (8, 512), unit: "texels", about: "Along one side."),
        "gain": (default: 0.5, range: (-1, 1e3), about: "A factor."),
        "soft": (default: true, about: "Whether."), // after
        "format": (default: "rgba8unorm", values: ["rgba8unorm", "rgba16float"], unit: Some("bits"), about: "One."),
    },
    values: {"cell": "2.0 / resolution", "origin": r"vec3(0)", "four": 4, "minus": -1.5, "yes": true},
    samplers: {"linear": (filter: Linear, mip_filter: Linear, wrap: Mirror, compare: Greater), "plain": ()},
    parts: {"storage": "storage/isotropic"},
    resources: {
        "radiance": Texture(format: "format", size: ["resolution", /* why */ 16, "n"], mips: "all", start: Fill(0)),
        "distant": Texture(format: "depth32float", layers: "lights.spot", mips: All, start: Covered),
        "list": Buffer(count: "resolution", start: Kept(value: 1, reset: [Camera, Lights])),
        "head": Buffer(start: Kept),
    },
    stages: [
        Compute(kernel: "make/triangles", over: Count("scene.triangles"), when: "scene.emissive"),
        Compute(kernel: "mean", name: "mean_of", over: Texels("radiance@mip1"), bind: {"source": "radiance@mip(0)"}),
        Compute(kernel: "b", over: Indirect(buffer: "list", offset: 4), order_dependent: "running average"),
        Raster(kernel: "c", draw: Scene, depth: (target: "distant", compare: Greater, write: false), blend: Add),
        Raster(kernel: "d", draw: Screen), Raster(kernel: "e", draw: Points("n")),
        Raster(kernel: "f", draw: Vertices(3)), Raster(kernel: "g", draw: Indirect(buffer: "list")),
        Part(role: "storage", name: "store", when: true, bind: {"volume": "radiance"}),
        Each(name: "level", over: Range(1, "n"), stages: [
            Each(name: "light", over: Lights("point"), when: "soft", stages: []),
            Each(name: "view", over: Views, stages: [Compute(kernel: r#"h"#, over: Count(1, "2", 3))]),
        ]),
        Each(name: "mip", over: Mips("radiance"), stages: []),
        Repeat(times: "4", swap: [("a", "b"), ("c", "d")], when: false, stages: []),
    ],
    outputs: {"color": "radiance@mip0"},
)
// after all
"##;

fn document(text: &str) -> Result<Document> {
    parse(&Source::new("test.ron", text))
}

/// All texts of a document that have a place.
#[derive(Default)]
struct Texts(Vec<Spanned<String>>);

impl Texts {
    fn add<'a>(&mut self, texts: impl IntoIterator<Item = &'a Spanned<String>>) {
        self.0.extend(texts.into_iter().cloned());
    }

    fn entries(&mut self, entries: &Entries<String>) {
        entries.iter().for_each(|(key, value)| self.add([key, value]));
    }

    fn call(&mut self, call: &Call) {
        self.add([&call.kernel]);
        self.add(call.name.iter().chain(&call.when));
        self.entries(&call.bind);
    }

    fn stage(&mut self, stage: &Stage) {
        match stage {
            Stage::Compute(compute) => {
                self.call(&compute.call);
                match &compute.over.value {
                    Extent::Texels(of) => self.add([of]),
                    Extent::Count(counts) => self.add(counts),
                    Extent::Triangles => {}
                    Extent::Indirect { buffer, offset } => self.add([buffer].into_iter().chain(offset)),
                }
            }
            Stage::Raster(raster) => {
                self.call(&raster.call);
                self.add(raster.depth.iter().map(|depth| &depth.target));
                match &raster.draw.value {
                    Draw::Scene | Draw::Screen => {}
                    Draw::Points(count) | Draw::Vertices(count) => self.add([count]),
                    Draw::Indirect { buffer, offset } => self.add([buffer].into_iter().chain(offset)),
                }
            }
            Stage::Part { role, name, when, bind } => {
                self.add([role].into_iter().chain(name).chain(when));
                self.entries(bind);
            }
            Stage::Each { name, over, when, stages } => {
                self.add([name].into_iter().chain(when));
                match &over.value {
                    Over::Range(from, to) => self.add([from, to]),
                    Over::Lights(of) | Over::Mips(of) => self.add([of]),
                    Over::Views => {}
                }
                stages.iter().for_each(|stage| self.stage(&stage.value));
            }
            Stage::Repeat { times, swap, when, stages } => {
                self.add([times].into_iter().chain(when));
                swap.iter().for_each(|(a, b)| self.add([a, b]));
                stages.iter().for_each(|stage| self.stage(&stage.value));
            }
        }
    }
}

#[test]
fn every_place_is_where_its_text_stands() {
    let document = document(FULL).unwrap();
    let mut texts = Texts::default();
    texts.add([&document.about]);
    texts.entries(&document.values);
    for (key, knob) in &document.knobs {
        texts.add([key, &knob.value.about]);
        let written = knob.value.default.place.text().trim_matches('"');
        assert_eq!(knob.value.default.value, literal(written));
        assert!(knob.place.text().starts_with("(default: ") && knob.place.text().ends_with(')'));
    }
    texts.add(document.samplers.iter().map(|(key, _)| key));
    for (key, resource) in &document.resources {
        texts.add([key]);
        let start = match &resource.value {
            Resource::Texture { format, size, mips, layers, start } => {
                texts.add([format].into_iter().chain(size).chain(layers));
                texts.add(mips.iter().filter(|mips| mips.place.text() != "All"));
                start
            }
            Resource::Buffer { count, start } => {
                texts.add(count);
                start
            }
        };
        assert!(
            ["Fill(0)", "Covered", "Kept(value: 1, reset: [Camera, Lights])", "Kept"]
                .contains(&start.place.text())
        );
        assert!(resource.place.text().ends_with(')') && resource.place.text().contains(start.place.text()));
    }
    for stage in &document.stages {
        texts.stage(&stage.value);
        let name = match &stage.value {
            Stage::Compute(_) => "Compute(",
            Stage::Raster(_) => "Raster(",
            Stage::Part { .. } => "Part(",
            Stage::Each { .. } => "Each(",
            Stage::Repeat { .. } => "Repeat(",
        };
        assert!(stage.place.text().starts_with(name) && stage.place.text().ends_with(')'));
    }
    let Root::Pipeline { parts, outputs, .. } = &document.root else { panic!("a pipeline") };
    texts.entries(parts);
    texts.entries(outputs);
    // 76 pairs of quotes, less 6 whose place is not kept (units, a knob's texts, a reason), and 11 without quotes.
    assert_eq!(texts.0.len(), 76 - 6 + 11);
    for text in &texts.0 {
        assert_eq!(text.place.text(), text.value);
    }
}

fn literal(written: &str) -> Literal {
    if let Ok(whole) = written.parse() {
        return Literal::Whole(whole);
    }
    if let Ok(flag) = written.parse() {
        return Literal::Flag(flag);
    }
    written.parse().map_or_else(|_| Literal::Text(written.to_owned()), Literal::Real)
}

#[test]
fn absent_things_are_empty() {
    let document = document(r#"Part(about: "a", role: "storage")"#).unwrap();
    let Root::Part { role, module, modules, moving, order_dependent, exports } = &document.root else {
        panic!("a part")
    };
    assert!(moving.is_empty() && order_dependent.is_none());
    assert_eq!((role.value.as_str(), module, modules.len(), exports.len()), ("storage", &None, 0, 0));
    assert!(document.knobs.is_empty() && document.stages.is_empty() && document.resources.is_empty());
}

#[test]
fn fields_have_their_values() {
    let document = document(FULL).unwrap();
    let (_, resolution) = &document.knobs[0];
    assert_eq!(resolution.value.allowed, Allowed::Range(8.0, 512.0));
    assert_eq!(resolution.value.unit.as_deref(), Some("texels"));
    let (_, format) = &document.knobs[3];
    let texts = ["rgba8unorm", "rgba16float"].map(|text| Literal::Text(text.into()));
    assert_eq!(format.value.allowed, Allowed::Values(texts.into()));
    assert_eq!(format.value.unit.as_deref(), Some("bits"));
    let linear = Sampler {
        filter: Filter::Linear,
        mip_filter: Filter::Linear,
        wrap: Wrap::Mirror,
        compare: Some(Compare::Greater),
    };
    assert_eq!(document.samplers[0].1.value, linear);
    assert_eq!(document.samplers[1].1.value, Sampler::default());
    let Resource::Buffer { start, .. } = &document.resources[2].1.value else { panic!("a buffer") };
    assert_eq!(
        start.value,
        Start::Kept { value: 1.0, reset: vec![Cause::Camera, Cause::Lights], steady: false }
    );
    let Stage::Raster(raster) = &document.stages[3].value else { panic!("a raster stage") };
    assert_eq!(raster.blend, Some(Blend::Add));
    assert!(raster.depth.as_ref().is_some_and(|depth| !depth.write && depth.compare == Compare::Greater));
    let Resource::Texture { mips, .. } = &document.resources[1].1.value else { panic!("a texture") };
    assert_eq!(mips.as_ref().map(|mips| mips.value.as_str()), Some("all"));
}

/// The piece between « and » is what the first label of the only problem marks.
#[test]
fn errors_point_at_their_piece() {
    let of_pipeline = [
        ("«colour»: 1", "unknown-field", "field `colour`"),
        (
            "knobs: {\"a\": (default: 1, about: \"\"), \"«a»\": (default: 2, about: \"\")}",
            "duplicate-key",
            "`a`",
        ),
        ("values: {\"a\": 1}, «values»: {}", "duplicate-key", "`values`"),
        ("knobs: {\"a\": «(default: 1)»}", "missing-field", "`about`"),
        ("knobs: {\"a\": (default: 1, about: «2»)}", "wrong-type", "a text"),
        ("knobs: {\"a\": (default: «[]», about: \"\")}", "wrong-type", "a finite number"),
        ("knobs: {\"a\": (default: «1e999», about: \"\")}", "wrong-type", "a finite number"),
        ("knobs: {\"a\": (default: 1, range: «(2, 1)», about: \"\")}", "bad-knob", "from 2 to 1"),
        ("knobs: {\"a\": (default: 1, range: «(2, 1, 3)», about: \"\")}", "wrong-type", "a range"),
        ("knobs: {\"a\": (default: 1, range: (0, «\"2\"»), about: \"\")}", "wrong-type", "a number"),
        ("knobs: {\"a\": (default: 1, range: (1, 2), values: «[1]», about: \"\")}", "bad-knob", "not both"),
        ("knobs: «[]»", "wrong-type", "a map"),
        ("knobs: {\"«a b»\": (default: 1, about: \"\")}", "bad-name", "`a b`"),
        ("knobs: {«a»: (default: 1, about: \"\")}", "wrong-type", "a text"),
        ("values: {\"a\": \"«x == \\\"y\\\"»\"}", "escape-in-expression", "escapes"),
        ("values: {\"a\": «nope»}", "wrong-type", "an expression"),
        ("samplers: {\"a\": (filter: «Linar»)}", "unknown-variant", "a filter"),
        ("samplers: {\"a\": (filter: «\"Linear\"»)}", "wrong-type", "a filter"),
        ("samplers: {\"a\": («filtr»: Linear)}", "unknown-field", "a sampler"),
        ("resources: {\"a\": «Textur»(start: Covered)}", "unknown-variant", "a resource"),
        ("resources: {\"a\": «Texture»(start: Covered)}", "missing-field", "`format`"),
        ("resources: {\"a\": Buffer(start: «Cleared»)}", "unknown-variant", "a start"),
        ("resources: {\"a\": Buffer(start: «Fill»)}", "wrong-type", "`Fill(value)`"),
        ("resources: {\"a\": Buffer(start: «Covered(1)»)}", "wrong-type", "alone"),
        ("resources: {\"a\": Buffer(start: Kept(reset: [«Sun»]))}", "unknown-variant", "a cause"),
        (
            "resources: {\"a\": Texture(format: \"f\", size: «[1, 2, 3, 4]», start: Covered)}",
            "wrong-type",
            "one to three",
        ),
        ("stages: [«Comput»(kernel: \"a\")]", "unknown-variant", "a stage"),
        ("stages: [«Compute»(kernel: \"a\")]", "missing-field", "`over`"),
        ("stages: [Compute(kernel: \"a\", over: «Count()»)]", "wrong-type", "one to three"),
        ("stages: [Compute(kernel: \"a\", over: «Texels(\"a\", \"b\")»)]", "wrong-type", "`Texels"),
        ("stages: [Raster(kernel: \"a\", draw: «Screen(1)»)]", "wrong-type", "alone"),
        (
            "stages: [Raster(kernel: \"a\", draw: Screen, depth: («taget»: \"a\", target: \"b\", compare: Less))]",
            "unknown-field",
            "taget",
        ),
        ("stages: [Each(name: \"i\", over: «Views(1)», stages: [])]", "wrong-type", "alone"),
        ("stages: [Each(name: \"i\", over: «Range(1)», stages: [])]", "wrong-type", "`Range"),
        (
            "stages: [Each(name: \"i\", over: Lights(\"«pont»\"), stages: [])]",
            "unknown-variant",
            "a kind of light",
        ),
        ("stages: [Repeat(times: 1, swap: [(\"a\", \"«a»\")], stages: [])]", "swap-with-itself", "`a`"),
        ("stages: [Repeat(times: 1, swap: [«(\"a\", \"b\", \"c\")»], stages: [])]", "wrong-type", "a pair"),
        ("stages: [Part(role: \"«a.b»\")]", "bad-name", "`a.b`"),
        ("outputs: {\"a\": «1»}", "wrong-type", "a text"),
    ];
    for (marked, code, says) in of_pipeline {
        errs(&format!("Pipeline(\n about: \"ü\", {marked}\n)"), code, says);
    }
    errs("«Pipline»(about: \"a\")", "unknown-variant", "`Pipline`");
    errs("«Pipeline»()", "missing-field", "`about`");
    errs("«(about: \"a\")»", "wrong-type", "`Pipeline(…)`");
    errs("«[]»", "wrong-type", "`Pipeline(…)`");
    errs("Pipeline(about: \"ü\", «»\"\")", "syntax", "RON");
    errs("Pipeline(about: \"ü\", knobs: «{»", "syntax", "RON");
    errs("Pipeline(about: \"ü\" «»knobs: {})", "syntax", "RON");
    errs("«»", "syntax", "RON");
}

/// `marked` has the one problem `code`, whose message has `says` in it and which points between « and ».
fn errs(marked: &str, code: &str, says: &str) {
    let text = marked.replace(['«', '»'], "");
    let problems = document(&text).expect_err(marked);
    let problems: Vec<_> = problems.iter().collect();
    let [problem] = problems.as_slice() else { panic!("{marked}: {problems:#?}") };
    let (place, _) = &problem.labels[0];
    let start = marked.find('«').unwrap();
    let piece = &marked[start + 2..marked.find('»').unwrap()];
    let line_start = marked[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let position = (marked[..start].matches('\n').count() + 1, marked[line_start..start].chars().count() + 1);
    assert_eq!((problem.code, place.line_column()), (code, position), "{marked}: {problem:?}");
    assert!(piece.is_empty() || piece == place.text(), "{marked}: {:?}", place.text());
    assert!(problem.message.contains(says), "{marked}: {}", problem.message);
}

#[test]
fn all_problems_are_found_at_once() {
    let problems = document(
        r#"Pipeline(knobs: {"a": (default: [], about: 1)}, resources: {"b": Bufer(), "c": Buffer(start: Full)},
            stages: [Compute(kernel: 1, over: Count()), Each(stages: [Part()])], colour: 1)"#,
    );
    let codes: Vec<_> = problems.unwrap_err().iter().map(|problem| problem.code).collect();
    assert_eq!(codes.len(), 11, "{codes:?}");
}

#[test]
fn a_key_that_stands_twice_shows_both() {
    let problems =
        document("Pipeline(about: \"a\", values: {\n\"a\": 1,\n\"b\": 2,\n\"a\": 3})").unwrap_err();
    let places: Vec<_> =
        problems.iter().flat_map(|problem| &problem.labels).map(|(p, _)| p.line_column()).collect();
    assert_eq!(places, [(4, 2), (2, 2)]);
}

#[test]
fn hostile_depth_is_an_error() {
    for open in [
        "[",
        "(",
        "{",
        "Some(",
        "a(",
        "a(b:",
        "{1:",
        "[(",
        "/*",
        "\"",
        "r#",
        "Pipeline(stages:[Each(stages:[",
    ] {
        for many in [40, 200, 20_000] {
            assert!(document(&open.repeat(many)).is_err(), "{open}");
        }
    }
    let nested = |depth: usize| {
        let (open, close) = ("Each(name:\"i\",over:Views,stages:[".repeat(depth), "])".repeat(depth));
        document(&format!("Pipeline(about:\"a\",stages:[{open}{close}])"))
    };
    assert!(nested(12).is_ok());
    for depth in [20, 60, 1000] {
        assert!(nested(depth).unwrap_err().iter().all(|problem| problem.code == "nested-too-deeply"));
    }
}

proptest! {
    #[test]
    fn no_text_panics(text in "\\PC{0,200}") {
        prop_assert!(document(&text).is_err());
    }

    #[test]
    fn no_mixture_of_its_words_panics(words in prop::collection::vec(prop::sample::select(vec![
        "Pipeline", "Part", "(", ")", "[", "]", "{", "}", ":", ",", "\"", "about", "\"a\"", "stages", "Compute", "Some",
        "None", "1", "-1.5", "true", "r#\"x\"#", "//", "\n", "/*", "*/", "'c'", "b\"y\"", "1..2", "#![enable(x)]", "()",
    ]), 0..60)) {
        let text = words.concat();
        let ours = document(&text);
        if ron::from_str::<ron::Value>(&text).is_err() {
            prop_assert!(ours.is_err());
        }
    }

    /// Cuts, doubles or replaces a piece of a right file.
    #[test]
    fn no_damage_panics(at in 0..FULL.len(), length in 0usize..60, with in "\\PC{0,3}|[\\[\\](){}\":,]", twice in any::<bool>()) {
        let floor = |mut i: usize| { i = i.min(FULL.len()); while !FULL.is_char_boundary(i) { i -= 1 } i };
        let (start, end) = (floor(at), floor(at + length));
        let piece = if twice { &FULL[start..end] } else { "" };
        let text = format!("{}{piece}{with}{piece}{}", &FULL[..start], &FULL[end..]);
        if let Err(problems) = document(&text) {
            for problem in problems.iter() {
                prop_assert!(!problem.labels.is_empty());
                prop_assert!(!problem.render(false).is_empty());
            }
        }
    }

    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..100)) {
        prop_assert!(document(&String::from_utf8_lossy(&bytes)).is_err());
    }
}
