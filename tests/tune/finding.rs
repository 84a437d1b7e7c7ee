//! What is found.

use crate::bench::Bench;
use serde_json::Value;

fn values(found: &Value) -> Vec<f64> {
    let tried = found["tried"].as_array().expect("what was tried");
    tried.iter().map(|tried| tried["value"].as_f64().expect("a number")).collect()
}

#[test]
fn the_time_of_a_stage_is_made_least() {
    let bench = Bench::new();
    let (found, _) = bench.ok("tune POINT -p work --knob tile --least time --stage work");
    let tile = found["chosen"].as_f64().expect("a number");
    // By the kernel's formula, and nothing that was measured: beyond these two it takes over twice what it does at 256.
    assert!((128.0..=512.0).contains(&tile), "{tile} of {:?}", values(&found));
    assert_eq!(
        (&found["knob"], &found["least"], &found["of"]),
        (&"tile".into(), &"time".into(), &"work".into())
    );
    assert_eq!(found["default"], 1024.0);
    assert_eq!(found["parts"]["tint"], "tint/none");
    let tried = found["tried"].as_array().expect("what was tried");
    let tried_values = values(&found);
    assert!(tried_values.contains(&1.0) && tried_values.contains(&65536.0) && tried_values.contains(&1024.0));
    assert!(tried_values.windows(2).all(|pair| pair[0] < pair[1]), "{tried_values:?}");
    for tried in tried {
        let scene = &tried["scenes"][0];
        assert_eq!(scene["samples"].as_array().map(Vec::len), Some(9), "{scene}");
        let [low, median, high] = ["low", "median", "high"].map(|end| scene[end].as_f64().expect("ms"));
        assert!(low <= median && median <= high && low > 0.0, "{scene}");
    }
    // The control: what is measured are the kernel's turns, so that the search had something to find.
    let median = |at: usize| tried[at]["scenes"][0]["median"].as_f64().expect("ms");
    let best = tried_values.iter().position(|value| *value == 256.0).expect("256");
    assert!(median(tried.len() - 1) > 3.0 * median(best));
    let kept = bench.kept();
    assert_eq!(kept.len(), 1, "{kept:?}");
    assert_eq!(found["kept"], kept[0].display().to_string());
}

#[test]
fn values_of_lists_are_all_tried() {
    let bench = Bench::new();
    let (found, _) = bench.ok("tune POINT -p work --knob rounds --least time --repeats 6");
    assert_eq!(values(&found), [600.0, 2000.0, 4000.0], "numbers rise");
    assert_eq!(found["chosen"], 600.0);
    assert_eq!(found["of"], "frame");
    let (found, _) = bench.ok("tune POINT -p work --knob brief --least time --stage work --repeats 6");
    assert_eq!((&found["chosen"], &found["default"]), (&true.into(), &false.into()));
    let (found, _) = bench.ok("tune POINT -p work --knob order --least time --repeats 6");
    let names: Vec<&Value> = found["tried"].as_array().expect("tried").iter().map(|t| &t["value"]).collect();
    assert_eq!(names, ["back", "forth"]);
    assert_eq!(bench.kept().len(), 3);
    let (found, _) =
        bench.ok("tune POINT -p work --knob rounds --within 1000..4000 --least time --repeats 6");
    assert_eq!(values(&found), [2000.0, 4000.0]);
    assert_eq!(bench.kept().len(), 3, "the same knob has one file");
}

#[test]
fn the_error_of_an_output_is_made_least() {
    let bench = Bench::new();
    let error = "tune POINT BOX -p gain --least error --reference truth --samples 1 --frames 1";
    let (found, _) = bench.ok(&format!("{error} --knob gain"));
    let gain = found["chosen"].as_f64().expect("a number");
    assert!((gain - 0.7).abs() < 0.01, "{gain} of {:?}", values(&found));
    let (found, _) = bench.ok(&format!("{error} --knob gain --within 1..2"));
    assert_eq!(found["chosen"], 1.0, "at an end");
    assert_eq!(found["scenes"], serde_json::json!(["cornell-point", "cornell-box"]));
    for tried in found["tried"].as_array().expect("tried") {
        // The picture is off by the same everywhere: relMSE is (gain - 0.7)², over a mean that does not depend on it.
        let relmse = |tried: &Value| tried["scenes"][1]["median"].as_f64().expect("relMSE");
        let ratio = relmse(tried) / relmse(&found["tried"][0]);
        let expected = ((tried["value"].as_f64().expect("a number") - 0.7) / 0.3).powi(2);
        assert!((ratio / expected - 1.0).abs() < 1e-3, "{ratio} for {expected}");
        assert!((tried["ratio"]["median"].as_f64().expect("a ratio") - ratio).abs() < 1e-6 * ratio);
    }
    let (found, _) = bench.ok(&format!("{error} --knob halved"));
    assert_eq!(found["chosen"], true);
}
