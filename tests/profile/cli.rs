//! `voxgi profile` as a user's program sees it.

use crate::traces::read;
use crate::world::root;
use serde_json::Value;
use std::process::{Command, Output};

const SMALL: [&str; 8] = ["-p", "cones", "--size", "64x64", "--set", "resolution=16", "--frames", "3"];

fn profile(more: &[&str]) -> Output {
    let scene = root("scenes/cornell-box.glb").display().to_string();
    let mut command = Command::new(env!("CARGO_BIN_EXE_voxgi"));
    command.args(["profile", &scene]).args(SMALL).args(more).env_remove("COLUMNS");
    command.output().expect("the program")
}

fn json(output: &Output) -> Value {
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object on standard output")
}

fn text(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).expect("text")
}

fn all(list: &Value, fits: fn(&Value) -> bool) -> bool {
    list.as_array().is_some_and(|list| list.len() == 3 && list.iter().all(fits))
}

type Field = (&'static str, fn(&Value) -> bool);

const FIELDS: [Field; 20] = [
    ("/schema", Value::is_u64),
    ("/adapter/name", Value::is_string),
    ("/adapter/driver", Value::is_string),
    ("/adapter/driver_info", Value::is_string),
    ("/clock", Value::is_string),
    ("/pipeline", Value::is_string),
    ("/scene", Value::is_string),
    ("/knobs/grid.resolution", |v| v == 16.0),
    ("/frames", |v| v == 3),
    ("/warm_up", |v| v == 2),
    ("/frame_samples_ms", |v| all(v, Value::is_f64)),
    ("/encode_samples_ms", |v| all(v, Value::is_f64)),
    ("/fills_samples_ms", |v| all(v, |ms| ms.is_f64() || ms.is_null())),
    ("/first_use_ms", Value::is_f64),
    ("/fills/written_bytes", Value::is_u64),
    ("/copy/buffer/bytes", |v| v.as_u64() >= Some(16 << 20)),
    ("/copy/buffer/gb_per_s", Value::is_f64),
    ("/copy/texture/samples_ms", |v| v.as_array().is_some_and(|list| list.len() == 9)),
    ("/counters", Value::is_object),
    ("/memory/peak_bytes", Value::is_u64),
];

fn misfits(profile: &Value) -> Vec<&'static str> {
    FIELDS
        .iter()
        .filter(|(path, fits)| !profile.pointer(path).is_some_and(fits))
        .map(|field| field.0)
        .collect()
}

#[test]
fn json_has_all_samples_and_files_are_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let mut found = json(&profile(&["--json", "--out", &out.display().to_string()]));
    assert_eq!(misfits(&found), [""; 0]);
    let stages = found["stages"].as_array().expect("stages").clone();
    let mut shares = 0.0;
    for stage in &stages {
        match stage["status"].as_str() {
            Some("run") => {
                assert!(all(&stage["samples_ms"], Value::is_f64), "{stage}");
                assert!(stage["read_bytes"].is_u64() && stage["written_bytes"].as_u64() > Some(0), "{stage}");
                let ms = stage["gpu_ms"].as_f64().expect("a time");
                let bytes = stage["read_bytes"].as_f64().zip(stage["written_bytes"].as_f64());
                let expected = bytes.map(|(r, w)| (r + w) / ms / 1e6).expect("bytes");
                assert!((stage["gb_per_s"].as_f64().expect("a speed") - expected).abs() < 1e-9 * expected);
                shares += stage["share"].as_f64().expect("a share");
            }
            _ => assert!(stage["reason"].is_string() && stage.get("share").is_none(), "{stage}"),
        }
    }
    assert!((0.3..1.7).contains(&shares), "the stages are {shares} of the frame");

    let file = |name| serde_json::from_slice(&std::fs::read(out.join(name)).expect("a file")).expect("JSON");
    let written: Value = file("profile.json");
    assert_eq!(written, found);
    let trace: Value = file("trace.json");
    let (slices, counts) = read(&trace).expect("a trace");
    assert_eq!(counts, 3 * found["counters"].as_object().expect("counters").len());
    for stage in stages.iter().filter(|stage| stage["status"] == "run") {
        let of =
            |s: &&crate::traces::Read| s.names[1..].join("/") == *stage["path"].as_str().expect("a path");
        let lengths: Vec<f64> =
            slices.iter().filter(of).map(|slice| (slice.end - slice.begin) as f64 / 1e6).collect();
        let samples = stage["samples_ms"].as_array().expect("samples");
        assert_eq!(lengths.len(), 3, "{stage}");
        for (length, sample) in lengths.iter().zip(samples) {
            assert!((length - sample.as_f64().expect("ms")).abs() < 1e-4, "{length} ms of {stage}");
        }
    }
    // The control: what is missing or of another type is noticed.
    found["copy"]["buffer"]["gb_per_s"] = Value::Null;
    found["frame_samples_ms"] = serde_json::json!([1.0, 2.0]);
    assert_eq!(misfits(&found), ["/frame_samples_ms", "/copy/buffer/gb_per_s"]);
}

#[test]
fn what_does_not_depend_on_the_camera_is_kept() {
    let found = json(&profile(&["--json", "--change", "nothing", "--orbit", "90"]));
    assert_eq!(found["changes"], serde_json::json!(["camera"]));
    let stages = found["stages"].as_array().expect("stages");
    let of = |status: &str| stages.iter().filter(|stage| stage["status"] == status).collect::<Vec<_>>();
    assert!(of("kept").iter().all(|stage| stage["gpu_ms"].is_null() && stage["first_use_ms"].is_f64()));
    assert!(of("run").iter().all(|stage| stage["gpu_ms"].is_f64()));
    assert!(of("kept").len() > 5 && of("run").len() > 1, "{stages:?}");
    assert_eq!(found["fills"]["written_bytes"], 0, "kept stages need no fills");
}

#[test]
fn the_table_fits() {
    for columns in [None, Some("80"), Some("120")] {
        let scene = root("scenes/cornell-box.glb").display().to_string();
        let mut command = Command::new(env!("CARGO_BIN_EXE_voxgi"));
        command.args(["profile", &scene]).args(SMALL).env_remove("COLUMNS");
        if let Some(columns) = columns {
            command.env("COLUMNS", columns);
        }
        let text = text(&command.output().expect("the program"));
        let width = columns.map_or(120, |columns| columns.parse().expect("a number"));
        let widest = text.lines().max_by_key(|line| line.chars().count()).expect("lines");
        assert!(widest.chars().count() <= width, "{columns:?}: {widest}");
        assert!(!text.contains('\u{1b}'), "no colours in a pipe");
        for part in
            ["fills", "encode and submit", "of copy", "first use", "p90", "copy speed", "dropped, since"]
        {
            assert!(text.contains(part), "{part}: {text}");
        }
        let tables = text.lines().filter(|line| line.starts_with("stage ")).count();
        assert_eq!(tables, if columns == Some("80") { 2 } else { 1 });
    }
}

#[test]
fn paths_move_the_camera_and_their_mistakes_are_bad_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("walk.ron");
    let key =
        |frame: u32, x: f64| format!("(frame: {frame}, eye: ({x}, 0.3, -0.8), look_at: (0.28, 0.27, 0))");
    std::fs::write(&file, format!("Path(keys: [{}, {}])", key(0, 0.2), key(1, 0.3))).expect("a file");
    let path = file.display().to_string();
    let found = json(&profile(&["--json", "--path", &path]));
    assert_eq!(found["camera_moves"], format!("along {path}"));
    assert_eq!(found["changes"], Value::Null);
    std::fs::write(&file, format!("Path(keys: [{}, {}])", key(1, 0.2), key(1, 0.3))).expect("a file");
    let refused = profile(&["--json", "--path", &path]);
    assert_eq!(refused.status.code(), Some(2));
    let problems: Value = serde_json::from_slice(&refused.stdout).expect("JSON");
    assert_eq!(problems["problems"][0]["code"], "path-keys");
    assert_eq!(profile(&["--path", "no-such-path.ron"]).status.code(), Some(2));
    assert_eq!(profile(&["--path", &path, "--orbit", "3"]).status.code(), Some(2));
    assert_eq!(profile(&["--orbit", "NaN"]).status.code(), Some(2));
    let nowhere = folder.path().join("none/trace.json").display().to_string();
    assert_eq!(profile(&["--trace", &nowhere]).status.code(), Some(2));
}
