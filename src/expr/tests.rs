use super::*;
use crate::problem::Source;
use proptest::prelude::*;
use std::collections::BTreeMap;

struct Table(BTreeMap<&'static str, Value>);

impl Names for Table {
    fn get(&self, name: &str) -> Option<Value> {
        self.0.get(name).cloned()
    }

    fn known(&self) -> Vec<String> {
        self.0.keys().map(|name| (*name).to_owned()).collect()
    }
}

fn table() -> Table {
    Table(BTreeMap::from([
        ("n", Value::Number(64.0)),
        ("zero", Value::Number(0.0)),
        ("on", Value::Flag(true)),
        ("format", Value::Text("rgba8unorm".into())),
        ("trace.origin", Value::Vector(vec![1.0, 2.0, 3.0])),
        ("scene.emissive", Value::Unknown),
    ]))
}

/// The expression stands inside a larger text, as it does in a file.
fn whole(text: &str) -> Place {
    let source = Source::new("test.ron", format!("[\n  \"{text}\"]"));
    source.at(5..5 + text.len())
}

fn eval(text: &str) -> Result<Value, Problem> {
    Expr::parse(&whole(text))?.eval(&table())
}

fn number(text: &str) -> f64 {
    match eval(text) {
        Ok(Value::Number(number)) => number,
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn computes() {
    for (text, expected) in [
        ("1 + 2 * 3 - 4 / 2", 5.0),
        ("-2 * -3", 6.0),
        ("10 - 4 - 3", 3.0),
        ("(10 - (4 - 3)) % 4", 1.0),
        ("-7 % 4", -3.0),
        ("0x40 + 1_000 + 1.5e+2 + 2E-1", 1214.2),
        ("if(on && n >= 64, 1, zero / 0)", 1.0),
        ("min(3, n, 1) + max(2, 5)", 6.0),
        ("clamp(n, 1, 8) + abs(-1) + floor(1.5) + ceil(1.5) + round(2.5)", 14.0),
        ("sqrt(16) + log2(n) + exp2(3) + pow(2, 4)", 34.0),
        ("trace.origin.x + trace.origin.y * trace.origin.z", 7.0),
        ("vec3(1, 2, 3).z + (trace.origin * 2).y", 7.0),
        ("dot(trace.origin, vec3(1)) + length(vec2(3, 4))", 11.0),
        ("max_of(trace.origin) - min_of(trace.origin)", 2.0),
        ("vec4(trace.origin, 9).w", 9.0),
        ("sin_degrees(90) - cos_degrees(-180) + sin_degrees(-90) + cos_degrees(360)", 2.0),
        (
            "abs(sin_degrees(180)) + abs(cos_degrees(90)) + abs(cos_degrees(-450)) + abs(sin_degrees(720))",
            0.0,
        ),
    ] {
        assert_eq!(number(text), expected, "{text}");
    }
    for (text, expected) in [
        ("format == 'rgba8unorm'", true),
        ("format != 'rgba8unorm' || !on", false),
        ("1 < 2 == true && 1 <= 1 && 2 > 1 && 1 >= 1", true),
        ("vec2(1, 2) == vec2(1, 2)", true),
        ("1 == 2", false),
    ] {
        assert_eq!(eval(text), Ok(Value::Flag(expected)), "{text}");
    }
    assert_eq!(eval("vec2(1, 2) * 2 + vec2(1)"), Ok(Value::Vector(vec![3.0, 5.0])));
    assert_eq!(eval("-trace.origin"), Ok(Value::Vector(vec![-1.0, -2.0, -3.0])));
}

#[test]
fn angles_are_degrees() {
    for degrees in (-1000..1000).map(|i| f64::from(i) * 0.37) {
        let off = |text: &str, expected: f64| (number(&format!("{text}({degrees:?})")) - expected).abs();
        assert!(off("sin_degrees", degrees.to_radians().sin()) < 1e-14, "{degrees}");
        assert!(off("cos_degrees", degrees.to_radians().cos()) < 1e-14, "{degrees}");
    }
}

#[test]
fn unknown_spreads_unless_the_rest_decides() {
    for text in [
        "scene.emissive",
        "scene.emissive + 1",
        "-scene.emissive",
        "!scene.emissive",
        "scene.emissive && on",
        "scene.emissive || false",
        "scene.emissive == 1",
        "scene.emissive < 1",
        "scene.emissive.x",
        "vec3(scene.emissive, 1, 2)",
        "dot(scene.emissive, trace.origin)",
        "if(scene.emissive, 1, 2)",
        "if(on, scene.emissive, 2)",
    ] {
        assert_eq!(eval(text), Ok(Value::Unknown), "{text}");
    }
    for (text, expected) in [
        ("scene.emissive && false", Value::Flag(false)),
        ("false && scene.emissive", Value::Flag(false)),
        ("scene.emissive || on", Value::Flag(true)),
        ("if(scene.emissive, 3, n - 61)", Value::Number(3.0)),
        ("if(on, 3, scene.emissive)", Value::Number(3.0)),
    ] {
        assert_eq!(eval(text), Ok(expected), "{text}");
    }
}

/// The piece between « and » is what the first label marks.
#[test]
fn errors_point_at_their_piece() {
    for (marked, code) in [
        ("«»", "expression-syntax"),
        ("1 +«»", "expression-syntax"),
        ("1 «2»", "expression-syntax"),
        ("(1 + 2«»", "expression-syntax"),
        ("min(1 «2»)", "expression-syntax"),
        ("n «=» 1", "expression-syntax"),
        ("«12abc»", "expression-syntax"),
        ("«1e999»", "expression-syntax"),
        ("format == «'x»", "expression-syntax"),
        ("(1).«q»", "expression-syntax"),
        ("1 + «ä»", "expression-syntax"),
        ("1 + «mim»(1, 2)", "unknown-function"),
        ("1 + «min(1)»", "expression-arguments"),
        ("«if(on, 1)»", "expression-arguments"),
        ("1 + «scene.emisive»", "unknown-name"),
        ("if(on, 1, «gone»)", "unknown-name"),
        ("false && «gone»", "unknown-name"),
        ("1 + «on»", "expression-type"),
        ("-«format»", "expression-type"),
        ("«n» && on", "expression-type"),
        ("scene.emissive && «n»", "expression-type"),
        ("scene.emissive + «on»", "expression-type"),
        ("!«n»", "expression-type"),
        ("«on» < n", "expression-type"),
        ("«on» == n", "expression-type"),
        ("«n».x", "expression-type"),
        ("«vec2(1)».z", "expression-type"),
        ("«vec2(1) + vec3(1)»", "expression-type"),
        ("«vec2(1) == vec3(1)»", "expression-type"),
        ("«dot(vec2(1), vec3(1))»", "expression-type"),
        ("length(«n»)", "expression-type"),
        ("vec3(«on»)", "expression-type"),
        ("«vec4(1, 2)»", "expression-type"),
        ("if(«n», 1, 2)", "expression-type"),
        ("n / «(1 - 1)»", "division-by-zero"),
        ("n % «zero»", "division-by-zero"),
        ("1 + «log2(zero)»", "not-finite"),
        ("«sqrt(-1)»", "not-finite"),
        ("«1e300 * 1e300»", "not-finite"),
    ] {
        let text = marked.replace(['«', '»'], "");
        let problem = eval(&text).expect_err(marked);
        let (place, _) = &problem.labels[0];
        let before = marked.chars().take_while(|c| *c != '«').count();
        let piece = &marked[marked.find('«').unwrap() + 2..marked.find('»').unwrap()];
        assert_eq!(
            (problem.code, place.text(), place.line_column()),
            (code, piece, (2, 4 + before)),
            "{marked}"
        );
    }
    let help = |text: &str| eval(text).expect_err(text).help;
    assert_eq!(help("scene.emisive"), Some("did you mean `scene.emissive`?".into()));
    assert_eq!(help("1 + mim(1, 2)"), Some("did you mean `min`?".into()));
    assert_eq!(help("n = 1"), Some("to compare, write `==`".into()));
}

#[test]
fn names_are_listed_without_components() {
    let place = whole("min(n, trace.origin.x) + if(on, gone, n)");
    let expr = Expr::parse(&place).unwrap();
    let names: Vec<_> = expr.names().collect();
    assert_eq!(
        names.iter().map(|(name, _)| *name).collect::<Vec<_>>(),
        ["n", "trace.origin", "on", "gone", "n"]
    );
    assert!(names.iter().all(|(name, place)| place.text() == *name));
}

#[test]
fn hostile_depth_is_an_error() {
    for text in ["(".repeat(100_000), "-".repeat(100_000), "1+".repeat(100_000) + "1", "abs(".repeat(100_000)]
    {
        assert_eq!(eval(&text).map_err(|problem| problem.code), Err("expression-depth"));
    }
    assert_eq!(number(&("1+".repeat(60) + "1")), 61.0);
}

/// A random arithmetic text with the value that ordinary Rust gives it.
fn arithmetic() -> impl Strategy<Value = (String, f64)> {
    let leaf = (0u32..100).prop_map(|n| (n.to_string(), f64::from(n)));
    leaf.prop_recursive(6, 64, 2, |inner| {
        (inner.clone(), inner, 0..6).prop_map(|((a, x), (b, y), which)| match which {
            0 => (format!("({a}) + ({b})"), x + y),
            1 => (format!("({a} )-( {b})"), x - y),
            2 => (format!("({a})*({b})"), x * y),
            3 => (format!("max({a}, {b})"), x.max(y)),
            4 => (format!("-({a})"), -x),
            _ => (format!("if({a} < {b}, {a}, {b})"), if x < y { x } else { y }),
        })
    })
}

proptest! {
    #[test]
    fn agrees_with_rust((text, expected) in arithmetic()) {
        prop_assert_eq!(eval(&text), Ok(Value::Number(expected)));
    }

    #[test]
    fn no_text_panics(text in r#"([a-z.'"()\[\]+*/%!&|=<>,-]|[0-9ex_]|n|on|trace\.origin|vec[23]\(|if\(|\PC){0,40}"#) {
        if let Err(problem) = eval(&text) {
            prop_assert!(!problem.labels.is_empty());
        }
    }

    #[test]
    fn values_print_as_expressions(x in -1e6f64..1e6, y in -1e6f64..1e6) {
        for value in [Value::Number(x), Value::Vector(vec![x, y]), Value::Flag(x > y)] {
            prop_assert_eq!(eval(&value.to_string()), Ok(value));
        }
    }
}
