use super::*;
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    channels: u32,
    masked: bool,
    curve: String,
    exposure: f32,
    errors: BTreeMap<String, f64>,
}

/// Values of numpy, scikit-image and the evaluator of ꟻLIP's authors.
#[test]
fn other_implementations_agree() {
    let cases: Vec<Case> = serde_json::from_str(include_str!("expected.json")).unwrap();
    assert_eq!(cases.len(), 4);
    for case in cases {
        let [truth, test, variance] = pictures(case.channels);
        let truth = Truth { name: "truth", picture: &truth, variance: Some(&variance) };
        let options = Options { exposure: case.exposure, curve: case.curve.parse().unwrap() };
        let left: Vec<bool> = (0..WIDTH * HEIGHT).map(|i| i % WIDTH + i / WIDTH < 30).collect();
        let mask = case.masked.then_some(left.as_slice());
        let measures =
            Measures::new(Kind::Light, Input { name: "test", picture: &test }, truth, &options).unwrap();
        let mut found = measures.errors(mask).unwrap();
        found.insert("noise", noise(&truth, mask).unwrap().unwrap());
        assert!(found.keys().copied().eq(case.errors.keys().map(String::as_str)), "{:?}", found.keys());
        for (name, value) in found {
            let expected = case.errors[name];
            // ꟻLIP is computed in 32 bits.
            let tolerance = if name == "flip" { 1e-5 } else { 1e-11 };
            let near = (value - expected).abs() <= tolerance * expected.abs();
            assert!(near, "{name} of {} channels, {mask:?}: {value}, expected {expected}", case.channels);
        }
    }
}
