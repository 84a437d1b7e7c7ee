//! `compare`, `sweep`, `merge` and `diff` as a user's program sees them.

use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A place of its own: references and runs of other tests are not seen.
struct Bench {
    folder: TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn voxgi(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_voxgi"));
        command.args(arguments).env("VOXGI_CACHE", self.path("cache")).current_dir(self.folder.path());
        command.output().expect("the program")
    }

    fn ok(&self, arguments: &[&str]) -> String {
        let output = self.voxgi(arguments);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {told}");
        String::from_utf8(output.stdout).expect("text")
    }

    fn json(&self, arguments: &[&str]) -> Value {
        serde_json::from_str(&self.ok(&[arguments, &["--json"]].concat())).expect("one JSON object")
    }

    /// The code of the first problem of a command that fails.
    fn refused(&self, arguments: &[&str]) -> (Option<i32>, String) {
        let output = self.voxgi(&[arguments, &["--json"]].concat());
        let value: Value = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
        let code = value["problems"][0]["code"].as_str().unwrap_or_default().to_owned();
        (output.status.code(), code)
    }
}

fn shipped(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file)
}

fn scene() -> String {
    shipped("scenes/cornell-point.glb").display().to_string()
}

/// Small, and as good as 32 samples are.
const SMALL: [&str; 10] = [
    "--size",
    "24x24",
    "--samples",
    "32",
    "--frames",
    "2",
    "--reference-set",
    "batch=16",
    "--reference-set",
    "seed=3",
];

fn names(comparison: &Value) -> BTreeSet<String> {
    let runs = comparison["runs"].as_array().expect("runs");
    runs.iter().map(|run| run["name"].as_str().expect("a name").to_owned()).collect()
}

fn run<'v>(comparison: &'v Value, name: &str) -> &'v Value {
    let runs = comparison["runs"].as_array().expect("runs");
    runs.iter().find(|run| run["name"] == name).unwrap_or_else(|| panic!("{name} in {:?}", names(comparison)))
}

#[test]
fn compare_measures_against_a_reference_that_is_kept() {
    let bench = Bench::new();
    let (scene, out) = (scene(), bench.path("out").display().to_string());
    let pipelines = ["-p", "cones,resolution=16", "-p", "cones,resolution=16,bounces=1"];
    let first = [&["compare", &scene], &pipelines[..], &SMALL, &["--out", &out]].concat();
    let comparison = bench.json(&first);
    assert_eq!(comparison["schema"], 1);
    let reference = &comparison["scenes"][0]["references"]["reference, diffuse_only=true, ao_distance=0.1, batch=16, seed=3"];
    assert_eq!(reference["samples"], 32, "{}", comparison["scenes"]);
    assert_eq!(reference["cached_samples"], 0);
    assert_eq!(&comparison["reference"], reference);
    assert!(reference["noise"]["indirect"].as_f64().is_some_and(|noise| noise > 0.0));
    let run_ = run(&comparison, "cones, resolution=16");
    assert_eq!(run_["knobs"]["bounces"], 4.0);
    assert!(run_["gpu_ms"]["median"].as_f64().is_some_and(|ms| ms > 0.0));
    assert!(run_["memory"]["peak_bytes"].as_u64().is_some_and(|bytes| bytes > 100_000));
    assert_eq!(run_["gpu_ms"]["samples"].as_array().map(Vec::len), Some(2));
    for output in ["color", "direct", "indirect", "ambient_occlusion"] {
        for measure in ["rmse", "relmse", "relmse_trimmed", "smape", "bias", "ssim", "flip"] {
            assert!(run_["errors"][output][measure].is_f64(), "{output} {measure}: {}", run_["errors"]);
        }
    }
    assert!(run_["masked"]["lit"]["color"]["relmse"].is_f64(), "{}", run_["masked"]);
    // More light is scattered: one bounce is darker.
    let bias = |name: &str| run(&comparison, name)["errors"]["indirect"]["bias"].as_f64().expect("a bias");
    assert!(bias("cones, resolution=16, bounces=1") < 0.9 * bias("cones, resolution=16"));
    let stage = run_["stages"].as_array().and_then(|s| s.iter().find(|s| s["path"] == "trace/cones"));
    assert_eq!(stage.expect("the tracer")["status"], "run");

    let folder = Path::new(&out);
    let files = ["png", "difference", "flip", "exr"].map(|kind| run_["pictures"]["color"][kind].as_str());
    let documents = run_["documents"].as_object().expect("documents");
    assert!(documents.keys().any(|name| name.ends_with("trace/cones.wgsl")), "{documents:?}");
    for file in files.into_iter().chain(documents.values().map(Value::as_str)) {
        assert!(folder.join(file.expect("a name")).is_file(), "{file:?}");
    }
    let page = std::fs::read_to_string(folder.join("index.html")).expect("the page");
    assert!(page.contains("cones, resolution=16, bounces=1"));

    // Elsewhere again: the reference is found, and the pictures are the same.
    let other = bench.path("other").display().to_string();
    let again = bench.json(&[&["compare", &scene], &pipelines[..2], &SMALL, &["--out", &other]].concat());
    let found = &again["scenes"][0]["references"];
    assert_eq!(found.as_object().and_then(|r| r.values().next()).expect("one")["cached_samples"], 32);
    assert_eq!(run(&again, "cones, resolution=16")["errors"], run_["errors"]);

    // With twice the samples it goes on from there.
    let more = bench.path("more").display().to_string();
    let longer = [
        &["compare", &scene],
        &pipelines[..2],
        &SMALL[..2],
        &["--samples", "64"],
        &SMALL[4..],
        &["--out", &more],
    ];
    let longer = bench.json(&longer.concat());
    let found =
        longer["scenes"][0]["references"].as_object().and_then(|r| r.values().next()).expect("one").clone();
    assert_eq!((&found["cached_samples"], &found["samples"]), (&Value::from(32), &Value::from(64)));
}

#[test]
fn a_comparison_goes_on_where_it_stopped() {
    let bench = Bench::new();
    let (scene, out) = (scene(), bench.path("out").display().to_string());
    let of = |pipelines: &[&str]| {
        let all: Vec<&str> = pipelines.iter().flat_map(|p| ["-p", *p]).collect();
        bench.json(&[&["compare", scene.as_str()], &all[..], &SMALL, &["--out", &out]].concat())
    };
    let first = of(&["cones,resolution=16"]);
    let both = of(&["cones,resolution=16", "cones,resolution=32"]);
    assert_eq!(names(&both).len(), 2);
    assert_eq!(
        run(&both, "cones, resolution=16"),
        run(&first, "cones, resolution=16"),
        "it was not run again"
    );
    // From another kernel it is another run.
    let kernel = bench.path("library/kernels/light/pixels.wgsl");
    std::fs::create_dir_all(kernel.parent().expect("a folder")).expect("folders");
    let text = std::fs::read_to_string(shipped("kernels/light/pixels.wgsl")).expect("the kernel");
    let darker = text.replace("vec4f(light + textureLoad", "vec4f(0.5 * light + textureLoad");
    assert_ne!(text, darker);
    std::fs::write(&kernel, darker).expect("a kernel");
    let changed =
        ["--library", "library", "-p", "cones,resolution=16", "-p", "cones,resolution=32", "--out", &out];
    let changed = bench.json(&[&["compare", scene.as_str()], &changed[..], &SMALL].concat());
    let bias =
        |comparison: &Value| run(comparison, "cones, resolution=16")["errors"]["color"]["bias"].as_f64();
    assert!(bias(&changed) < bias(&both), "{:?} {:?}", bias(&changed), bias(&both));
    assert_eq!(names(&changed).len(), 2);
    let other_size =
        ["compare", &scene, "-p", "cones,resolution=16", "--size", "16x16", "--samples", "32", "--out", &out];
    assert_eq!(bench.refused(&other_size), (Some(2), "other-comparison".to_owned()));
    std::fs::write(Path::new(&out).join("comparison.json"), "{").expect("a broken file");
    let again = [&["compare", &scene, "-p", "cones,resolution=16"], &SMALL[..], &["--out", &out]].concat();
    assert_eq!(bench.refused(&again), (Some(2), "comparison-file".to_owned()));
}

#[test]
fn a_reference_that_was_interrupted_is_gone_on_with() {
    let bench = Bench::new();
    let scene = scene();
    let compare = |samples: &str| {
        let mut arguments = [&["compare", scene.as_str(), "-p", "cones,resolution=16"], &SMALL[..]].concat();
        let place = arguments.iter().position(|argument| *argument == "32").expect("the samples");
        arguments[place] = samples;
        arguments.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let mut long = Command::new(env!("CARGO_BIN_EXE_voxgi"));
    long.args(compare("100000000")).env("VOXGI_CACHE", bench.path("cache")).current_dir(bench.folder.path());
    let mut long = long.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program");
    let kept = || {
        let folders = std::fs::read_dir(bench.path("cache/references")).into_iter().flatten().flatten();
        { folders }.any(|folder| folder.path().join("estimate.json").is_file())
    };
    let begun = Instant::now();
    while !kept() && begun.elapsed() < Duration::from_secs(120) {
        assert!(long.try_wait().expect("its state").is_none(), "it would take hours");
        std::thread::sleep(Duration::from_millis(20));
    }
    long.kill().expect("interrupted");
    long.wait().expect("ended");
    let arguments = compare("32");
    let after = bench.json(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(after["reference"]["cached_samples"].as_u64().is_some_and(|n| n >= 32), "{}", after["reference"]);
    assert_eq!(after["reference"]["samples"], after["reference"]["cached_samples"]);
}

#[test]
fn shards_of_a_sweep_come_to_the_whole() {
    let bench = Bench::new();
    let scene = scene();
    let sweep = |out: &str, more: &[&str]| {
        let grid = ["-p", "cones", "--set", "resolution=16,32", "--set", "bounces=1,2", "--repeats", "2"];
        let out = bench.path(out).display().to_string();
        bench.json(&[&["sweep", scene.as_str()], &grid[..], &SMALL, &["--out", &out], more].concat())
    };
    let whole = sweep("whole", &[]);
    assert_eq!(names(&whole).len(), 4);
    let one = run(&whole, "cones, resolution=32, bounces=2");
    assert_eq!(one["repeats_ms"].as_array().map(Vec::len), Some(2));
    assert_eq!(one["gpu_ms"]["samples"].as_array().map(Vec::len), Some(4), "two frames of each repeat");
    assert_eq!(one["set"]["bounces"], "2");
    let parts = [sweep("a", &["--shard", "1/2"]), sweep("b", &["--shard", "2/2"])];
    assert!(parts.iter().all(|part| names(part).len() == 2));
    bench.ok(&["merge", "a", "b", "--out", "merged"]);
    let text = std::fs::read(bench.path("merged/comparison.json")).expect("the file");
    let merged: Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!(names(&merged), names(&whole));
    for name in names(&whole) {
        assert_eq!(run(&merged, &name)["errors"], run(&whole, &name)["errors"], "{name}");
    }
    assert!(bench.path("merged/index.html").is_file());

    // The same work: nothing but times can differ. Other knobs do.
    let differences = bench.json(&["diff", "whole", "merged"]);
    for difference in differences["differences"].as_array().expect("a list") {
        let what = difference["what"].as_str().expect("what");
        assert!(what == "frame" || what.starts_with("stage "), "{difference}");
        assert!(difference["ratio"].is_number(), "a time, no other fate: {difference}");
    }
    let out = bench.path("other").display().to_string();
    let other = ["-p", "cones,resolution=32", "--set", "display.exposure=1"];
    bench.json(&[&["compare", scene.as_str()], &other[..], &SMALL, &["--out", &out]].concat());
    assert!(bench.ok(&["diff", "a", "other"]).contains("run: there → not there"));
    assert_eq!(bench.refused(&["diff", "a", "nowhere"]), (Some(2), "comparison-file".to_owned()));
    let unlike = bench.voxgi(&["merge", "a", "other", "--out", "bad"]);
    assert_eq!(unlike.status.code(), Some(2));
    assert!(!bench.path("bad").exists(), "nothing half done");
}

#[test]
fn sweeps_say_what_each_step_costs_and_brings() {
    let bench = Bench::new();
    let scene = scene();
    let grid = ["-p", "cones", "--set", "resolution=16,32", "--repeats", "1", "--one-at-a-time"];
    let text = bench.ok(&[&["sweep", scene.as_str()], &grid[..], &SMALL].concat());
    assert!(text.contains("resolution 16 → 32: "), "{text}");
    assert!(text.contains("the cheapest within 10 % of the best: cones, resolution="), "{text}");
    let runs: Vec<_> = std::fs::read_dir(bench.path("runs")).expect("runs").flatten().collect();
    assert_eq!(runs.len(), 1, "a folder with date and name");
    assert!(runs[0].file_name().to_string_lossy().ends_with("-sweep-cornell-point"));
}

#[test]
fn sweeps_say_what_an_effect_costs_and_brings() {
    let bench = Bench::new();
    let lamp = shipped("scenes/cornell-box.glb").display().to_string();
    let sweep = ["sweep", &lamp, "-p", "cones,resolution=16", "--effect", "scene.emissive", "--repeats", "1"];
    let comparison = bench.json(&[&sweep[..], &SMALL].concat());
    let (with, without) =
        ("cones, resolution=16, scene.emissive=true", "cones, resolution=16, scene.emissive=false");
    let bias = |name: &str| run(&comparison, name)["errors"]["color"]["bias"].as_f64().expect("a bias");
    assert!(bias(with) > 0.5, "the lamp shines: {}", bias(with));
    assert_eq!(bias(without), 0.0, "nothing else does");
    let left_out = |name: &str| run(&comparison, name)["lacks"].to_string().contains("scene.emissive");
    assert_eq!((left_out(with), left_out(without)), (false, true));
    let ran = |name: &str| {
        let stages = run(&comparison, name)["stages"].as_array().expect("stages").clone();
        stages.iter().filter(|s| s["status"] == "run").map(|s| s["path"].to_string()).collect::<BTreeSet<_>>()
    };
    assert!(ran(without).is_subset(&ran(with)));
    assert!(ran(with).iter().any(|path| path.contains("mipmap_emitted") && !ran(without).contains(path)));
    let sky = ["sweep", &lamp, "-p", "cones", "--effect", "scene.environment"];
    assert_eq!(bench.refused(&[&sky[..], &SMALL].concat()), (Some(2), "no-effect".to_owned()));
    let unknown = ["compare", &lamp, "-p", "cones,scene.emissive=perhaps"];
    assert_eq!(bench.refused(&[&unknown[..], &SMALL].concat()), (Some(2), "effect-value".to_owned()));
    let both = ["sweep", &lamp, "-p", "cones,scene.emissive=false", "--effect", "scene.emissive"];
    assert_eq!(bench.refused(&[&both[..], &SMALL].concat()), (Some(2), "swept-and-set".to_owned()));
}

#[test]
fn what_can_not_be_compared_is_refused() {
    let bench = Bench::new();
    let scene = scene();
    let refused = |more: &[&str]| bench.refused(&[&["compare", scene.as_str()], more, &SMALL].concat());
    let input = |code: &str| (Some(2), code.to_owned());
    assert_eq!(refused(&["-p", "cones", "-p", "cones"]), input("compared-twice"));
    assert_eq!(refused(&["-p", "reference"]), input("progress"));
    assert_eq!(refused(&["-p", "cones,resolution"]), input("pipeline-option"));
    assert_eq!(refused(&["-p", "cone"]), input("unknown-pipeline"));
    assert_eq!(refused(&["-p", "cones,resolutoin=8"]), input("unknown-knob"));
    let no_truth = ["compare", &scene, "-p", "cones,resolution=32", "--reference", "volume"];
    assert_eq!(bench.refused(&[&no_truth[..], &SMALL[..6]].concat()), input("no-progress"));
    let twice = ["sweep", &scene, "-p", "cones", "--set", "bounces=1", "--set", "bounces=2"];
    assert_eq!(bench.refused(&twice), input("swept-twice"));
    let twin = bench.path("cornell-point.glb");
    std::fs::copy(shipped("scenes/cornell-box.glb"), &twin).expect("another scene of that name");
    let twins = ["compare", &scene, &twin.display().to_string(), "-p", "cones,resolution=16"];
    assert_eq!(bench.refused(&[&twins[..], &SMALL].concat()), input("other-scene"));
    assert!(!bench.path("runs").exists(), "what is refused leaves nothing behind");
    let render = ["render", &scene, "-p", "cones", "--samples", "3"];
    assert_eq!(bench.refused(&render), input("no-progress"));
}
