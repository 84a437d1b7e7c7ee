//! What `--tuned` does with what was found.

use crate::bench::Bench;
use serde_json::{Value, json};

/// A bench on which the work's `brief` is kept as `true`.
fn tuned() -> Bench {
    let bench = Bench::new();
    let (found, _) = bench.ok("tune POINT -p work --knob brief --least time --stage work --repeats 6");
    assert_eq!(found["chosen"], true);
    bench
}

#[test]
fn render_and_profile_use_it_and_say_so() {
    let bench = tuned();
    for command in ["render POINT -p work --output color=color.png", "profile POINT -p work --frames 1"] {
        let (plain, told) = bench.ok(command);
        assert_eq!(
            (&plain["knobs"]["brief"], plain.get("tuned")),
            (&json!(false), None),
            "only when asked for"
        );
        assert!(!told.contains("tuned"), "{told}");
        let (record, told) = bench.ok(&format!("{command} --tuned"));
        assert_eq!(record["knobs"]["brief"], true);
        let used = record["tuned"].as_object().expect("what is used");
        assert_eq!(used.len(), 1);
        assert_eq!(
            (&used["brief"]["value"], &used["brief"]["scene"]),
            (&json!(true), &json!("cornell-point"))
        );
        assert!(used["brief"]["when"].as_str().is_some_and(|when| when.ends_with('Z')), "{used:?}");
        assert!(told.contains("tuned: work, brief=true, found on cornell-point"), "{told}");
        let (record, told) = bench.ok(&format!("{command} --tuned --set brief=false"));
        assert_eq!(
            (&record["knobs"]["brief"], record.get("tuned")),
            (&json!(false), None),
            "what is set is set"
        );
        assert!(told.contains("nothing"), "{told}");
    }
}

#[test]
fn compare_and_sweep_use_it_for_each_pipeline() {
    let bench = tuned();
    let how = "--reference truth --samples 1 --frames 1 --tuned";
    let (found, told) = bench.ok(&format!("compare POINT -p work -p gain -p work,brief=false {how} --out c"));
    let names: Vec<&Value> = found["runs"].as_array().expect("runs").iter().map(|run| &run["name"]).collect();
    assert_eq!(names, ["work, brief=true", "gain", "work, brief=false"]);
    assert_eq!(found["runs"][0]["tuned"]["brief"]["value"], true);
    assert_eq!((found["runs"][1].get("tuned"), found["runs"][2].get("tuned")), (None, None));
    assert!(told.contains("no knob of `gain` was tuned"), "{told}");
    let (found, _) = bench.ok(&format!("sweep POINT -p work --set tile=2,4 --repeats 1 {how} --out s"));
    let runs = found["runs"].as_array().expect("runs");
    assert!(runs.iter().all(|run| run["knobs"]["brief"] == true && run["tuned"]["brief"]["value"] == true));
    let (found, _) =
        bench.ok(&format!("sweep POINT -p work --set brief=true,false --repeats 1 {how} --out t"));
    assert!(found["runs"].as_array().expect("runs").iter().all(|run| run.get("tuned").is_none()));
    let twice = bench.refused(&format!("compare POINT -p work -p work,brief=true {how} --out u"));
    assert_eq!(twice["code"], "compared-twice");
    let none = bench.refused(&format!("compare POINT -p gain {how} --out v"));
    assert_eq!(none["code"], "not-tuned");
}

#[test]
fn what_does_not_hold_is_refused_with_the_command_to_run() {
    let bench = tuned();
    let help = |problem: &Value| problem["help"].as_str().expect("help").to_owned();
    let message = |problem: &Value| problem["message"].as_str().expect("a message").to_owned();
    let none = bench.refused("render POINT -p gain --tuned");
    assert_eq!(none["code"], "not-tuned");
    assert!(help(&none).contains("voxgi tune SCENE -p gain --knob KNOB"), "{none}");
    let parts = bench.refused("render POINT -p work --part tint=tint/other --tuned");
    assert_eq!(parts["code"], "not-tuned");
    assert!(message(&parts).contains("with others"), "{parts}");
    assert!(help(&parts).contains("-p work --part tint=tint/other --knob brief --least time"), "{parts}");

    let path = bench.kept().remove(0);
    let kept: Value = serde_json::from_slice(&std::fs::read(&path).expect("a file")).expect("JSON");
    let write = |key: &str, value: Value| {
        let mut changed = kept.clone();
        *changed.pointer_mut(key).expect("the key") = value;
        std::fs::write(&path, changed.to_string()).expect("a file");
        bench.refused("render POINT -p work --tuned")
    };
    let driver = write("/adapter/driver_info", json!("Mesa 0.0.1"));
    assert_eq!(driver["code"], "not-tuned");
    assert!(message(&driver).contains("Mesa 0.0.1"), "{driver}");
    let range = write("/value", json!(7));
    assert_eq!(range["code"], "tuned-not-allowed");
    assert!(help(&range).contains("voxgi tune SCENE -p work"), "{range}");
    assert_eq!(write("/format", json!(999))["code"], "not-tuned", "another version's");
    std::fs::write(&path, "{\"format\": 1").expect("a file");
    let broken = bench.refused("render POINT -p work --tuned");
    assert_eq!(broken["code"], "tuned-file");
    assert!(message(&broken).contains(&path.display().to_string()), "{broken}");
    // The control: as it was written, it is used.
    std::fs::write(&path, kept.to_string()).expect("a file");
    assert_eq!(bench.ok("render POINT -p work --tuned --output color=c.png").0["knobs"]["brief"], true);
}
