//! What goes wrong is found, and said with the name of where.

use crate::bench::{Job, messages, open, root, scene};
use std::process::Command;
use voxgi::device::LimitSet;
use voxgi::library::Shelf;

fn voxgi() -> Command {
    Command::new(env!("CARGO_BIN_EXE_voxgi"))
}

/// `--scan` names the stage that first writes a NaN, and not those that hand it on.
#[test]
fn scan_finds_where_a_nan_comes_from() {
    let scene = scene("cornell-point");
    let scan = |planted: &str| {
        let job = Job::new(&scene, "nan", [8, 8]).set("planted", planted);
        let gpu = open(&LimitSet::Adapter);
        let mut run = job.start(&gpu).expect("a run");
        run.frame.scan(&gpu).expect("a scan")
    };
    assert_eq!(scan("none"), []);
    let found = scan("picture");
    let names: Vec<(&str, &str)> = found.iter().map(|f| (&*f.stage, &*f.resource)).collect();
    assert_eq!(names, [("source", "middle@mip1@layer0"), ("sink", "sunk@mip0@layer0")]);
    assert_eq!((found[0].nan, found[0].infinite, found[0].first), (1, 0, 4 * 2 + 3));
    let found = scan("list");
    assert_eq!((&*found[0].stage, &*found[0].resource), ("source", "list"));
    assert_eq!((found[0].nan, found[0].infinite, found[0].first), (0, 1, 5));
}

/// The same from the command line, with a mip as a file.
#[test]
fn scan_and_dump_from_the_command_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let dumped = folder.path().join("middle.exr");
    let render = |planted: &str| {
        let output = voxgi()
            .arg("render")
            .arg(root("scenes/cornell-point.glb"))
            .args(["-p", "nan", "--size", "8x8", "--scan", "--library"])
            .arg(root("tests/library-engine"))
            .args(["--set", &format!("planted={planted}")])
            .arg(format!("--dump=middle@mip1={}", dumped.display()))
            .output();
        output.expect("the program")
    };
    assert_eq!(render("none").status.code(), Some(0));
    let (picture, _) = voxgi::picture::read_exr(&dumped).map(first_layer).expect("a picture");
    assert_eq!((picture.width(), picture.height()), (4, 4));
    assert!(picture.data().iter().all(|x| *x == 0.25), "{:?}", picture.data());
    let failed = render("picture");
    assert_eq!(failed.status.code(), Some(1));
    let told = String::from_utf8_lossy(&failed.stderr);
    assert!(told.contains("stage `source`") && told.contains("middle@mip1"), "{told}");
}

fn first_layer(layers: Vec<(String, voxgi::picture::Picture)>) -> (voxgi::picture::Picture, String) {
    let (name, picture) = layers.into_iter().next().expect("a layer");
    (picture, name)
}

/// A resource that no device has the memory for is an error with its name, not a crash; the device goes on.
#[test]
fn more_memory_than_there_is_is_an_error() {
    let scene = scene("cornell-point");
    let gpu = open(&LimitSet::Adapter);
    let size = gpu.device.limits().max_texture_dimension_3d.min(2048).to_string();
    let job = Job::new(&scene, "huge", [8, 8]);
    let started = job.clone().set("size", &size).start(&gpu);
    let told = messages(&started.err().expect("32 GiB and more are too much"));
    assert!(told.contains("[out-of-memory]") && told.contains("`volume"), "{told}");
    // The control: the same pipeline, when small, runs on the same device.
    let mut run = job.set("size", "4").start(&gpu).expect("a run");
    run.frames(1).expect("a frame");
}

/// What our checks don't know and wgpu refuses stops the run, and says what is wrong.
#[test]
fn what_the_device_refuses_stops_the_run() {
    let scene = scene("cornell-point");
    for wall_clock in [false, true] {
        let gpu = open(&LimitSet::Adapter);
        let with = |offset: &str| {
            let mut job = Job::new(&scene, "refused", [8, 8]).set("offset", offset);
            job.wall_clock = wall_clock;
            job.start(&gpu).and_then(|mut run| run.frames(1))
        };
        let told = with("2").expect_err("there are four words");
        assert!(messages(&told).contains("overrun"), "{}", messages(&told));
        assert_eq!(told.exit_code(), 1);
        // The control: what is right runs on the same device.
        assert_eq!(with("1"), Ok(()));
    }
}

/// A device that is gone is an error, and not a crash or a wait without end.
#[test]
fn a_lost_device_stops_the_run() {
    let scene = scene("cornell-point");
    let gpu = open(&LimitSet::Adapter);
    let mut run = Job::new(&scene, "texels", [8, 8]).start(&gpu).expect("a run");
    run.frames(1).expect("a frame");
    gpu.device.destroy();
    let told = run.frames(1).expect_err("the device is gone");
    assert_eq!(told.exit_code(), 1, "{}", messages(&told));
}

/// Loops in shipped kernels end whatever the data: each is a `for` with a comparison, and none a `loop` or `while`.
#[test]
fn loops_of_shipped_kernels_are_bounded() {
    let library = voxgi::library::Library::default();
    let mut loops = 0;
    for name in library.list(Shelf::Kernels) {
        let source = library.find(Shelf::Kernels, &name).expect("a listed kernel");
        for (number, line) in source.text().lines().enumerate() {
            let code = line.split("//").next().unwrap_or_default();
            let words: Vec<&str> =
                code.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|w| !w.is_empty()).collect();
            assert!(!is_unbounded(&words, code), "{name}:{}: {line}", number + 1);
            loops += usize::from(words.contains(&"for"));
        }
    }
    assert!(loops > 10);
    assert!(is_unbounded(&["while", "true"], "while true {"));
    assert!(is_unbounded(&["for", "var", "i"], "for (var i = 0;; i++) {"));
}

fn is_unbounded(words: &[&str], code: &str) -> bool {
    let open_for = || {
        let condition = code.split(';').nth(1).unwrap_or_default();
        !["<", ">", "!="].iter().any(|operator| condition.contains(operator))
    };
    words.contains(&"loop") || words.contains(&"while") || (words.first() == Some(&"for") && open_for())
}
