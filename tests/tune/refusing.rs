//! What is refused, before anything is measured or kept.

use crate::bench::Bench;

#[test]
fn bad_input_names_its_cause_and_keeps_nothing() {
    let bench = Bench::new();
    let cases = [
        ("-p work --knob tils --least time", "unknown-knob", "did you mean `tile`?"),
        ("-p work --knob order --least time --within 1..2", "not-a-number", "'back', 'forth'"),
        ("-p work --knob brief --least time --within 0..1", "not-a-number", "true or false"),
        ("-p work --knob tile --least time --within 0..100", "knob-out-of-range", "from 1 to 65536"),
        ("-p work --knob tile --least time --within 1.2..1.8", "no-values", "from 1 to 65536"),
        ("-p work --knob rounds --least time --within 1..2", "no-values", "600, 2000"),
        ("-p work --knob tile --least time --stage wrok", "unknown-stage", "work_loop"),
        ("-p work --knob tile --least time --stage work_never", "nothing-timed", "--stage"),
        ("-p work --knob tile --set tile=4 --least time", "tuned-and-set", "--set"),
        ("-p work,tile=4 --knob tile --least time", "tuned-and-set", "--set"),
        ("-p gain --knob gain --least error --stage ramp", "stage-of-error", "--output"),
        ("-p gain --knob gain --least error --reference truth --output colour", "unknown-output", "`color`"),
        ("-p gain --knob gain --least error --reference gain", "no-progress", "progress"),
        ("-p truth --knob first_sample --least time", "progress", "reference"),
        ("-p wrok --knob tile --least time", "unknown-pipeline", "work"),
    ];
    for (arguments, code, help) in cases {
        let problem = bench.refused(&format!("tune POINT {arguments}"));
        assert_eq!(problem["code"], code, "{arguments}: {problem}");
        assert!(problem["help"].as_str().is_some_and(|text| text.contains(help)), "{arguments}: {problem}");
    }
    for arguments in ["--within 3..1", "--within 1", "--within a..b", "--within 1..inf", "--repeats 5"] {
        let output = bench.run(&format!("tune POINT -p work --knob tile --least time {arguments}"));
        assert_eq!(output.status.code(), Some(2), "{arguments}");
    }
    assert!(bench.kept().is_empty());
}

#[test]
fn a_tuning_that_is_killed_leaves_nothing() {
    let bench = Bench::new();
    let arguments = "tune POINT -p work --knob tile --least time --repeats 1000";
    let mut killed =
        bench.command(arguments).stdout(std::process::Stdio::null()).spawn().expect("the program");
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let still = killed.try_wait().expect("its state").is_none();
    killed.kill().expect("killed");
    killed.wait().expect("its end");
    assert!(still, "it was killed too late to be a test");
    assert!(bench.kept().is_empty());
}

#[test]
fn a_folder_that_cannot_be_written_to_is_a_failure() {
    let bench = Bench::new();
    std::fs::write(bench.path("cache"), "a file, not a folder").expect("a file");
    let output = bench.run("tune POINT -p work --knob brief --least time --repeats 6");
    assert_eq!(output.status.code(), Some(1));
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["problems"][0]["code"], "cache-write");
}
