//! References are made once, found again, and gone on from; what they depend on tells them apart; what is broken is made anew.

use super::files::Studio;
use super::flaws::flawed;
use super::shot::gpu;
use glam::Vec4;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use voxgi::converge::Until;
use voxgi::library::Library;
use voxgi::picture::{Picture, write_exr};
use voxgi::reference::{Cache, Made};
use voxgi::scene::{self, Scene};
use voxgi::session::Request;

/// What is asked for.
#[derive(Clone)]
struct Wanted {
    scene: Scene,
    request: Request,
    library: Library,
    samples: u64,
}

impl Wanted {
    fn new() -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-point.glb");
        let set = |knob: &str, value: &str| (knob.to_owned(), value.to_owned());
        let request = Request {
            pipeline: "reference".to_owned(),
            size: [8, 8],
            sets: vec![set("batch", "16"), set("diffuse_only", "true")],
            ..Request::default()
        };
        let scene = scene::load(&path).expect("a scene of this repository");
        Self { scene, request, library: Library::default(), samples: 32 }
    }

    fn samples(&self, samples: u64) -> Self {
        Self { samples, ..self.clone() }
    }

    /// The reference, and how many batches were run for it.
    fn get(&self, folder: &Path) -> (Made, u32) {
        let mut steps = 0;
        let mut watch = |_| {
            steps += 1;
            Ok(())
        };
        let until = Until { samples: Some(self.samples), ..Until::default() };
        let cache = Cache::at(folder.to_owned());
        let made = cache.get(gpu(), &self.scene, &self.library, &self.request, &until, &mut watch);
        (made.expect("a reference"), steps)
    }
}

/// Folders of references.
fn folders(cache: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(cache).expect("a folder").map(|entry| entry.expect("an entry").path()).collect()
}

#[test]
fn a_reference_is_made_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let wanted = Wanted::new();
    let (made, batches) = wanted.get(folder.path());
    assert_eq!((made.cached_samples, made.estimate.samples, batches), (0, 32, 2));
    let (again, batches) = wanted.get(folder.path());
    assert_eq!((again.cached_samples, batches), (32, 0));
    assert_eq!(again.estimate, made.estimate);
    let (fewer, batches) = wanted.samples(16).get(folder.path());
    assert_eq!((fewer.cached_samples, batches), (32, 0));
}

/// More samples are those after the ones that are there: two runs one after another are one, in its mean up to rounding and in
/// its variance as far as that of parts is one.
#[test]
fn a_reference_is_gone_on_from() {
    let folder = tempfile::tempdir().expect("a folder");
    let wanted = Wanted::new();
    let (part, _) = wanted.samples(64).get(folder.path());
    let (all, batches) = wanted.samples(256).get(folder.path());
    assert_eq!((all.cached_samples, all.estimate.samples, batches), (64, 256, 12));
    let elsewhere = tempfile::tempdir().expect("a folder");
    let (whole, batches) = wanted.samples(256).get(elsewhere.path());
    assert_eq!((whole.cached_samples, batches), (0, 16));
    let mean = |made: &Made, output: &str| {
        let data = made.estimate.pictures[output].data();
        data.iter().map(|x| f64::from(*x)).sum::<f64>() / data.len() as f64
    };
    for output in ["color", "direct", "indirect", "ambient_occlusion"] {
        let [all_data, whole_data] = [&all, &whole].map(|made| made.estimate.pictures[output].data());
        let apart = all_data.iter().zip(whole_data).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(apart < 1e-5, "{output}: {apart}");
        let variance = format!("{output}_variance");
        let ratio = mean(&all, &variance) / mean(&whole, &variance);
        assert!((0.5..2.0).contains(&ratio), "{variance}: {ratio}");
        // A mean without weights is another.
        let first = part.estimate.pictures[output].data();
        let off = first.iter().zip(whole_data).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off > 1e-4, "{output}: no control: {off}");
    }
    assert_eq!(folders(folder.path()).len(), 1);
    // Pictures of before are gone.
    assert_eq!(folders(&folders(folder.path())[0]).len(), 2);
}

#[test]
fn whatever_it_depends_on_tells_references_apart() {
    let studio = Studio::new();
    let set = |knob: &str, value: &str| {
        let mut wanted = Wanted::new();
        wanted.request.sets.push((knob.to_owned(), value.to_owned()));
        wanted
    };
    let scene = |edit: fn(&mut Value), name: &str| {
        let mut wanted = Wanted::new();
        wanted.scene = studio.edited("cornell-point", name, edit);
        wanted
    };
    let kernel = flawed("lib/met", "out.albedo = base;", "out.albedo = base * 0.5;");
    let document = studio.path("pipelines/reference.ron");
    std::fs::create_dir_all(studio.path("pipelines")).expect("a folder");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/reference.ron");
    let text = std::fs::read_to_string(shipped).expect("the pipeline");
    let changed = text.replace("\"ao_end\": \"ao_distance *", "\"ao_end\": \"2 * ao_distance *");
    assert_ne!(text, changed);
    std::fs::write(document, changed).expect("the pipeline can be written");
    let plain = Wanted::new();
    let mut larger = plain.clone();
    larger.request.size = [8, 9];
    let mut moved = plain.clone();
    moved.scene.instances[6].to_world[3] += Vec4::X * 0.05;
    let mut turned = plain.clone();
    turned.scene.cameras[0].position.x += 0.05;
    let by = |library: Library| Wanted { library, ..plain.clone() };
    let wanted = [
        ("nothing", plain.clone()),
        ("seed", set("seed", "1")),
        ("scatterings", set("max_scatterings", "2")),
        ("gloss", set("diffuse_only", "false")),
        (
            "a colour",
            scene(|d| d["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][0] = json!(0.1), "a.glb"),
        ),
        ("a light", scene(|d| d["nodes"][9]["translation"][0] = json!(0.2), "b.glb")),
        ("a place", moved),
        ("the camera", turned),
        ("the size", larger),
        ("a kernel", by(kernel.library.clone())),
        ("a value of the pipeline", by(Library::new(vec![studio.path("")]).expect("a library"))),
    ];
    let cache = tempfile::tempdir().expect("a folder");
    for (count, (what, wanted)) in wanted.iter().enumerate() {
        let (made, _) = wanted.get(cache.path());
        assert_eq!(made.cached_samples, 0, "{what} is taken to be the same");
        assert_eq!(folders(cache.path()).len(), count + 1, "{what}");
    }
    // The control: where a scene lies and what it is called make no difference, nor what only makes frames larger.
    let same = scene(|_| (), "c.glb");
    assert_ne!(same.scene.files, plain.scene.files);
    let (first, _) = same.get(cache.path());
    assert_eq!(same.get(cache.path()).0.cached_samples, first.estimate.samples);
}

#[test]
fn what_is_broken_is_made_anew() {
    let tidy = tempfile::tempdir().expect("a folder");
    let wanted = Wanted::new();
    let (made, _) = wanted.get(tidy.path());
    let key = folders(tidy.path())[0].file_name().expect("a name").to_owned();
    type Damage = fn(&Path, &Path);
    let damages: [(&str, Damage); 9] = [
        ("the description is cut off", |json, _| truncate(json, 20)),
        ("it is empty", |json, _| truncate(json, 0)),
        ("it is gone", |json, _| std::fs::remove_file(json).expect("a file")),
        ("the pictures are cut off", |_, exr| truncate(exr, 700)),
        ("they are gone", |_, exr| std::fs::remove_file(exr).expect("a file")),
        ("some are missing", |_, exr| write(exr, &["color", "color_variance"])),
        ("of another format", |json, _| edit(json, "format", 1000)),
        ("more samples than there can be", |json, exr| rename(json, exr, u64::MAX)),
        ("half a batch", |json, exr| rename(json, exr, 40)),
    ];
    for (what, damage) in damages {
        let cache = tempfile::tempdir().expect("a folder");
        wanted.get(cache.path());
        let folder = cache.path().join(&key);
        damage(&folder.join("estimate.json"), &folder.join("estimate-32.exr"));
        let (again, batches) = wanted.get(cache.path());
        assert_eq!((again.cached_samples, batches), (0, 2), "{what}");
        assert_eq!(again.estimate.pictures, made.estimate.pictures, "{what}");
        // And kept again.
        assert_eq!(wanted.get(cache.path()).1, 0, "{what}");
    }
    // The control: an untouched copy is found.
    assert_eq!(wanted.get(tidy.path()).1, 0);
}

/// A cache that can't be written to is a problem of its own, said in words.
#[test]
fn a_cache_that_is_no_folder_is_said_to_be_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    std::fs::write(&file, "").expect("a file");
    let Wanted { scene, request, library, .. } = Wanted::new();
    let until = Until { samples: Some(32), ..Until::default() };
    let found = Cache::at(file).get(gpu(), &scene, &library, &request, &until, &mut |_| Ok(()));
    let problems = found.expect_err("no cache");
    assert!(problems.iter().any(|problem| problem.code == "cache-write"), "{problems:?}");
}

fn truncate(file: &Path, bytes: u64) {
    let file = std::fs::OpenOptions::new().write(true).open(file).expect("a file");
    file.set_len(bytes).expect("a shorter file");
}

fn write(exr: &Path, outputs: &[&str]) {
    let picture = Picture::new(8, 8, 4, vec![1.0; 4 * 8 * 8]).expect("a picture");
    let layers: Vec<_> = outputs.iter().map(|output| (*output, &picture)).collect();
    write_exr(exr, &layers).expect("a file");
}

fn edit(json: &Path, field: &str, value: u64) {
    let mut kept: Value = serde_json::from_slice(&std::fs::read(json).expect("a file")).expect("JSON");
    kept[field] = value.into();
    std::fs::write(json, kept.to_string()).expect("a file");
}

/// The same pictures are said to have that many samples.
fn rename(json: &Path, exr: &Path, samples: u64) {
    edit(json, "samples", samples);
    std::fs::rename(exr, exr.with_file_name(format!("estimate-{samples}.exr"))).expect("a file");
}
