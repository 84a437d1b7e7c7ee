//! Conditional compilation, against a writer that leaves the dropped parts out in the first place.

use super::*;
use proptest::prelude::*;

/// A piece of a kernel: what sort it is depends on the list it is in.
#[derive(Clone, Debug)]
struct Tree {
    shape: u8,
    condition: u8,
    children: Vec<Tree>,
}

fn trees() -> impl Strategy<Value = Vec<Tree>> {
    let leaf =
        (any::<u8>(), any::<u8>()).prop_map(|(shape, condition)| Tree { shape, condition, children: vec![] });
    let tree = leaf.prop_recursive(6, 80, 5, |inner| {
        (any::<u8>(), any::<u8>(), prop::collection::vec(inner, 0..5))
            .prop_map(|(shape, condition, children)| Tree { shape, condition, children })
    });
    prop::collection::vec(tree, 0..6)
}

#[derive(Clone, Copy)]
enum List {
    Module,
    Members,
    Statements,
    Clauses,
}

/// What stands after some tokens of a piece.
type Inner<'a> = Option<(List, &'a [Tree])>;

/// Writes trees as WGSL tokens with a space between each two; every piece has a number of its own in it.
struct Writer<'a> {
    flags: &'a [Value; 4],
    /// Leave out conditions, and what they drop.
    decided: bool,
    text: String,
    numbered: u32,
}

impl Writer<'_> {
    fn write(mut self, trees: &[Tree]) -> String {
        self.list(List::Module, trees, true);
        self.text
    }

    fn put(&mut self, live: bool, tokens: &str) {
        if live {
            self.text += tokens;
            self.text += " ";
        }
    }

    fn list(&mut self, list: List, trees: &[Tree], live: bool) {
        // The values of the conditions of the run that a piece ends, its own last.
        let mut run: Vec<Value> = Vec::new();
        for tree in trees {
            let flag = usize::from(tree.condition / 4 % 4);
            let value = self.flags[flag].clone();
            let word = match tree.condition % 4 {
                2 if !run.is_empty() => format!("@elif(f{flag})"),
                3 if !run.is_empty() => "@else".to_owned(),
                1 | 2 => {
                    run.clear();
                    format!("@if(f{flag})")
                }
                _ => {
                    run.clear();
                    self.piece(list, tree, live);
                    continue;
                }
            };
            run.push(if word == "@else" { Value::Flag(true) } else { value });
            let first = run.iter().position(|value| *value != Value::Flag(false));
            let keep = first == Some(run.len() - 1);
            if word == "@else" {
                run.clear();
            }
            if !self.decided {
                self.put(true, &word);
                self.put(true, "/* } @if(f0) { /* */ */");
            }
            self.piece(list, tree, live && (keep || !self.decided));
        }
    }

    fn piece(&mut self, list: List, tree: &Tree, live: bool) {
        self.numbered += 1;
        let name = format!("n{}", self.numbered);
        let (first, second) = tree.children.split_at(tree.children.len() / 2);
        let mut nested = |parts: &[(&str, Inner)]| {
            for (tokens, inner) in parts {
                self.put(live, &tokens.replace('N', &name));
                if let Some((list, trees)) = inner {
                    self.list(*list, trees, live);
                }
            }
        };
        let statements = |trees| Some((List::Statements, trees));
        let all = &tree.children[..];
        match (list, tree.shape % 8) {
            (List::Module, 0..3) => nested(&[
                ("@must_use fn N (", Some((List::Members, first))),
                (") -> array < u32 , 2 > {", statements(second)),
                ("}", None),
            ]),
            (List::Module, 3 | 4) => nested(&[("struct N {", Some((List::Members, all))), ("}", None)]),
            (List::Module, 5) => nested(&[("var < storage , read > N : array < vec2 < f32 > > ;", None)]),
            (List::Module, _) => nested(&[("const N = array ( 1 , 2 ) [ 0 ] ;", None)]),
            (List::Members, 0..4) => nested(&[("@size ( 16 ) N : array < vec2 < f32 >, 1 << 2 > ,", None)]),
            (List::Members, _) => nested(&[("N : f32 ,", None)]),
            (List::Clauses, 0..6) => nested(&[("case N , 2 : {", statements(all)), ("}", None)]),
            (List::Clauses, _) => nested(&[("default /* N */ {", statements(all)), ("}", None)]),
            (List::Statements, 0) => nested(&[
                ("if ( N > 1 ) {", statements(first)),
                ("} else if true {", statements(second)),
                ("} else { }", None),
            ]),
            (List::Statements, 1) => nested(&[("{ N ++ ;", statements(all)), ("}", None)]),
            (List::Statements, 2) => {
                nested(&[("for ( var i = 0 ; i < N ; i ++ ) {", statements(all)), ("}", None)]);
            }
            (List::Statements, 3) => nested(&[
                ("loop { N = 1 ;", statements(first)),
                ("continuing {", statements(second)),
                ("break if true ; } }", None),
            ]),
            (List::Statements, 4) => nested(&[("switch N {", Some((List::Clauses, all))), ("}", None)]),
            (List::Statements, 5) => nested(&[("while N < 2 {", statements(all)), ("}", None)]),
            (List::Statements, _) => nested(&[("let N = f ( 1 , vec2 < f32 > ( ) ) ;", None)]),
        }
    }
}

/// Text without its comments, as tokens.
fn tokens(text: &str) -> Vec<&str> {
    let mut depth = 0;
    let outside = text.split_whitespace().filter(move |token| {
        depth += i32::from(*token == "/*");
        let keep = depth == 0;
        depth -= i32::from(*token == "*/");
        keep
    });
    outside.collect()
}

fn value() -> impl Strategy<Value = Value> {
    prop_oneof![Just(Value::Flag(true)), Just(Value::Flag(false)), Just(Value::Unknown)]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn what_is_dropped_is_as_if_never_written(trees in trees(), flags in [value(), value(), value(), value()]) {
        let write = |decided| Writer { flags: &flags, decided, text: String::new(), numbered: 0 }.write(&trees);
        let (written, expected) = (write(false), write(true));
        let names: Vec<(String, Value)> = (0..4).map(|i| (format!("f{i}"), flags[i].clone())).collect();
        let names = Known(names.into_iter().collect());
        let composed = Files::new(&[("main", &written)]).compose(&[], &names);
        let composed = composed.map_err(|problems| TestCaseError::fail(format!("{problems:#?}\n{written}")))?;
        prop_assert_eq!(tokens(&composed.text), tokens(&expected), "{}", written);
        for (start, name) in composed.text.match_indices('n').filter_map(|(start, _)| {
            let digits = composed.text[start + 1..].find(|c: char| !c.is_ascii_digit())?;
            (digits > 0).then(|| (start, &composed.text[start..=start + digits]))
        }) {
            let place = composed.place(start..start + name.len());
            prop_assert_eq!((place.span.start, place.text()), (start, name));
        }
        let unknown = flags.contains(&Value::Unknown);
        prop_assert!(unknown || composed.undecided.is_empty());
    }

    /// Any text at all: an answer, and no panic.
    #[test]
    fn no_text_is_too_strange(text in "[@{}()<>;,/*\\\\\"'a-z0-9_. \n\u{e9}]{0,60}|(@if\\(|@else|@elif\\(|\\)|fn |struct |import |var<|a|\\{|\\}|;|,|\"){0,40}") {
        let composed = Files::new(&[("main", &text)]).compose(&[], &known(&[("a", Value::Flag(true))]));
        if let Ok(composed) = composed {
            prop_assert_eq!(composed.text.len(), text.len() + 1);
            let _ = reflect(&composed, &BTreeMap::new());
        }
    }
}

#[test]
fn what_nobody_can_decide_is_kept_and_said() {
    let names = known(&[("a", Value::Unknown), ("yes", Value::Flag(true)), ("no", Value::Flag(false))]);
    let text = "@if(a) const A = 1;\n@else const B = 1;\n@if(no) fn f() { @if(a) return; }\n@if(a && no) const C = 1;\n@if(no) const D = 1; @elif(a) const E = 1;";
    let composed = Files::new(&[("main", text)]).compose(&[], &names).unwrap();
    assert_eq!(composed.declarations.keys().collect::<Vec<_>>(), ["A", "E"]);
    let undecided: Vec<_> =
        composed.undecided.iter().map(|place| (place.line_column(), place.text())).collect();
    assert_eq!(undecided, [((1, 1), "@if(a)"), ((5, 22), "@elif(a)")]);
}
