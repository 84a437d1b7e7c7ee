//! The commands as a user's program sees them: JSON, files, exit codes.

use crate::bench::root;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use voxgi::library::{Library, Shelf};

fn voxgi(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_voxgi")).args(arguments).output().expect("the program")
}

fn cornell() -> String {
    root("scenes/cornell-point.glb").display().to_string()
}

fn json(output: &Output) -> Value {
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{told}");
    serde_json::from_slice(&output.stdout).expect("one JSON object on standard output")
}

/// Where a field is, and whether its value is of the right type.
type Field = (&'static str, fn(&Value) -> bool);

/// Fields that are missing or of another type than `expected` says.
fn misfits(record: &Value, expected: &[Field]) -> Vec<String> {
    let wrong = expected.iter().filter(|(path, fits)| !record.pointer(path).is_some_and(fits));
    wrong.map(|(path, _)| (*path).to_owned()).collect()
}

const RECORD: [Field; 17] = [
    ("/schema", Value::is_u64),
    ("/pipeline", Value::is_string),
    ("/scene", Value::is_string),
    ("/width", Value::is_u64),
    ("/height", Value::is_u64),
    ("/adapter/name", Value::is_string),
    ("/adapter/driver", Value::is_string),
    ("/clock", Value::is_string),
    ("/frame_ms", Value::is_f64),
    ("/stages", |stages| stages.as_array().is_some_and(|list| list.len() > 10)),
    ("/stages/0/path", Value::is_string),
    ("/counters", Value::is_object),
    ("/memory/peak_bytes", Value::is_u64),
    ("/memory/without_reuse_bytes", Value::is_u64),
    ("/memory/kept_bytes", Value::is_u64),
    ("/outputs", Value::is_object),
    ("/warnings", Value::is_array),
];

#[test]
fn render_writes_pictures_and_a_record() {
    let folder = tempfile::tempdir().expect("a folder");
    let (scene, out) = (cornell(), folder.path().display().to_string());
    let output = voxgi(&[
        "render",
        &scene,
        "-p",
        "cones",
        "--size",
        "32x24",
        "--set",
        "resolution=16",
        "--frames",
        "2",
        "--change",
        "camera",
        "--out",
        &out,
        "--json",
    ]);
    let mut record = json(&output);
    assert_eq!(misfits(&record, &RECORD), [""; 0]);
    assert_eq!((&record["width"], &record["height"]), (&32.into(), &24.into()));
    let stages = record["stages"].as_array().expect("stages");
    let count = |status: &str| stages.iter().filter(|stage| stage["status"] == status).count();
    assert!(count("run") > 0 && count("kept") > 0 && count("dropped") > 0);
    assert_eq!(count("run") + count("kept") + count("dropped"), stages.len());
    for stage in stages {
        let ran = stage["status"] == "run";
        assert!(ran || stage["reason"].as_str().is_some_and(|reason| !reason.is_empty()), "{stage}");
        assert!(!ran || stage["gpu_ms"].is_f64(), "{stage}");
    }
    let written: Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("record.json")).expect("a record"))
            .expect("JSON");
    assert_eq!(written, record);

    let outputs = record["outputs"].as_object().expect("outputs");
    for name in ["color", "direct", "indirect", "ambient_occlusion", "albedo", "normal", "depth", "display"] {
        assert!(outputs.contains_key(name), "{name}");
    }
    for path in outputs.values() {
        picture_is_whole(Path::new(path.as_str().expect("a path")));
    }

    codes_of_linear_light(folder.path());

    // The control: a field taken away, or a number that is a text, is noticed.
    record["memory"].as_object_mut().expect("memory").remove("kept_bytes");
    record["width"] = "32".into();
    assert_eq!(misfits(&record, &RECORD), ["/width", "/memory/kept_bytes"]);
}

/// PNG decodes; EXR is linear float that says its primaries: Rec. 709.
fn picture_is_whole(path: &Path) {
    let shown = path.display();
    if path.extension().is_some_and(|extension| extension == "png") {
        let (width, height) = image_size(path);
        assert_eq!((width, height), (32, 24), "{shown}");
        return;
    }
    let layers = voxgi::picture::read_exr(path).expect("an EXR file");
    assert!(layers.iter().all(|(_, picture)| (picture.width(), picture.height()) == (32, 24)), "{shown}");
    let reader = exr::prelude::MetaData::read_from_file(path, true).expect("an EXR header");
    let primaries = reader.headers[0].shared_attributes.chromaticities.expect("chromaticities");
    let found = [primaries.red, primaries.green, primaries.blue, primaries.white].map(|c| [c.x(), c.y()]);
    assert_eq!(found, [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]], "{shown}");
}

/// The PNG of a linear output is the sRGB code of what its EXR holds.
fn codes_of_linear_light(folder: &Path) {
    let linear = voxgi::picture::read_exr(&folder.join("color.exr")).expect("an EXR file").remove(0).1;
    let coded = image::open(folder.join("color.png")).expect("a PNG file").to_rgb8();
    let code = |x: f32| {
        let x = x.clamp(0.0, 1.0);
        255.0 * if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
    };
    let mut lit = 0;
    for (texel, pixel) in linear.texels().zip(coded.pixels()) {
        for (x, found) in texel.iter().zip(pixel.0) {
            assert!((code(*x) - f32::from(found)).abs() <= 1.0, "{x} is coded as {found}");
            lit += usize::from(*x > 0.01 && *x < 0.9);
        }
    }
    assert!(lit > 100, "the picture is too dark or too bright to tell");
}

fn image_size(path: &Path) -> (u32, u32) {
    let picture = image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    (picture.width(), picture.height())
}

#[test]
fn exit_codes_tell_bad_input_from_failure() {
    let scene = cornell();
    let code = |arguments: &[&str]| voxgi(arguments).status.code();
    let small = ["--size", "8x8", "--set", "resolution=16"];
    let render =
        |more: &[&str]| code(&[&["render", scene.as_str(), "-p", "volume"], &small[..], more].concat());
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("color.png").display().to_string();
    assert_eq!(render(&["--output", &format!("color={file}")]), Some(0));
    assert!(Path::new(&file).is_file());
    assert_eq!(render(&["--set", "resolution=1025"]), Some(2));
    assert_eq!(render(&["--output", "colour=x.png"]), Some(2));
    assert_eq!(render(&["--no-such-option"]), Some(2));
    assert_eq!(code(&["render", &scene, "-p", "no-such-pipeline"]), Some(2));
    assert_eq!(code(&["render", "no-such-scene.glb", "-p", "volume"]), Some(2));
    assert_eq!(render(&["--adapter", "no such adapter"]), Some(1));
    assert_eq!(render(&["--output", "color=no-such-folder/color.png"]), Some(2));
    let taken = folder.path().join("taken.png");
    std::fs::create_dir(&taken).expect("a folder");
    assert_eq!(render(&["--output", &format!("color={}", taken.display())]), Some(1));
    let refused = voxgi(&["check", "no-such-pipeline", "--json"]);
    let problems: Value = serde_json::from_slice(&refused.stdout).expect("JSON on failure, too");
    assert_eq!(problems["problems"][0]["code"], "unknown-pipeline");
}

#[test]
fn check_tells_and_draws_the_graph() {
    let folder = tempfile::tempdir().expect("a folder");
    let [dot, svg] = ["graph.dot", "graph.svg"].map(|name| folder.path().join(name).display().to_string());
    let checked =
        json(&voxgi(&["check", "cones", "--scene", &cornell(), "--dot", &dot, "--svg", &svg, "--json"]));
    let stages = checked["pipelines"][0]["stages"].as_array().expect("stages");
    assert!(stages.len() > 10 && stages.iter().all(|s| s["status"] == "run" || s["reason"].is_string()));
    let all = json(&voxgi(&["check", "--json"]));
    let names = Library::default().list(Shelf::Pipelines);
    assert_eq!(all["pipelines"].as_array().map(Vec::len), Some(names.len()));

    let dot = std::fs::read_to_string(dot).expect("a graph");
    assert!(dot.starts_with("digraph") && dot.matches('{').count() == dot.matches('}').count());
    let svg = std::fs::read_to_string(svg).expect("a picture");
    assert_eq!(well_formed(&svg), Ok(()));
    // The control.
    let end = svg.rfind("</").expect("an end");
    assert!(well_formed(&svg[..end]).is_err());
    assert!(well_formed("<svg><g></svg></g>").is_err() && well_formed("<svg a=1/>").is_err());
    assert!(well_formed("<svg>a & b</svg>").is_err() && well_formed("<svg a=\"b\">&amp;</svg>").is_ok());
}

/// Whether tags nest, attributes are quoted and nothing stands bare that XML reserves.
fn well_formed(xml: &str) -> Result<(), String> {
    let mut open: Vec<&str> = Vec::new();
    let mut roots = 0;
    let mut rest = xml;
    while let Some(start) = rest.find('<') {
        plain(&rest[..start])?;
        let end = start + rest[start..].find('>').ok_or("a tag without end")?;
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        if tag.starts_with(['?', '!']) {
            continue;
        }
        if let Some(name) = tag.strip_prefix('/') {
            if open.pop() != Some(name.trim()) {
                return Err(format!("</{name}> closes another tag"));
            }
            continue;
        }
        let body = tag.strip_suffix('/').unwrap_or(tag);
        let (name, attributes) = body.split_once(char::is_whitespace).unwrap_or((body, ""));
        let pieces: Vec<&str> = attributes.split('"').collect();
        let (outside, inside): (Vec<_>, Vec<_>) = pieces.iter().enumerate().partition(|(i, _)| i % 2 == 0);
        let quoted = pieces.len() % 2 == 1
            && outside[..outside.len() - 1].iter().all(|(_, text)| text.trim().ends_with('='))
            && outside.last().is_none_or(|(_, text)| text.trim().is_empty());
        if !quoted {
            return Err(format!("<{tag}> has an attribute without quotes"));
        }
        inside.iter().try_for_each(|(_, text)| plain(text))?;
        roots += usize::from(open.is_empty());
        if body == tag {
            open.push(name);
        }
    }
    plain(rest)?;
    if open.is_empty() && roots == 1 { Ok(()) } else { Err(format!("{roots} roots, open: {open:?}")) }
}

/// Whether each `&` of a text begins an entity.
fn plain(text: &str) -> Result<(), String> {
    let entities = ["amp;", "lt;", "gt;", "quot;", "apos;", "#"];
    match text.split('&').skip(1).find(|after| !entities.iter().any(|entity| after.starts_with(entity))) {
        None => Ok(()),
        Some(after) => Err(format!("a bare `&` before {after:?}")),
    }
}

#[test]
fn kernels_and_devices_list_all_there_are() {
    let listed = json(&voxgi(&["kernels", "--json"]));
    let listed: Vec<&str> =
        listed["kernels"].as_array().expect("kernels").iter().filter_map(|k| k["name"].as_str()).collect();
    let mut folders = vec![root("kernels")];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path())
        {
            match path
                .strip_prefix(root("kernels"))
                .expect("below")
                .to_str()
                .and_then(|p| p.strip_suffix(".wgsl"))
            {
                Some(name) => files.push(name.to_owned()),
                None => folders.push(path),
            }
        }
    }
    files.sort();
    assert!(files.len() > 10);
    assert_eq!(listed, files);

    let devices = json(&voxgi(&["devices", "--json"]));
    let adapters = devices["devices"].as_array().expect("adapters");
    assert!(!adapters.is_empty() && adapters.iter().all(|adapter| adapter["adapter"]["name"].is_string()));
}

/// What each missing effect would take, and in which stages: those that only it needs, and those that it changes.
#[test]
fn savings_name_the_effects_that_a_scene_lacks() {
    let scene = root("scenes/cornell-point.glb").display().to_string();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("color.png");
    let output = format!("color={}", file.display());
    let arguments = ["render", &scene, "-p", "cones", "--size", "24x24", "--set", "resolution=16"];
    let record = json(&voxgi(&[&arguments[..], &["--savings", "--json", "--output", &output]].concat()));
    let effects = record["effects"].as_array().expect("effects");
    let effect = |name: &str| effects.iter().find(|effect| effect["feature"] == name);
    let emissive = effect("scene.emissive").expect("no light comes from surfaces");
    for stage in ["storage/emitted", "voxelize/still", "trace/cones"] {
        assert!(emissive["stages"][stage].is_number(), "{stage}: {emissive}");
    }
    assert!(emissive["stages"].get("light_maps/light_depth[0]").is_none(), "light maps show no emission");
    assert!(emissive["saved_ms"].is_number() && emissive["spread"]["p90"].is_number(), "{emissive}");
    let masked = effect("scene.masked").expect("no holes");
    assert!(masked["stages"]["light_maps/light_depth[0]"].is_number(), "{masked}");
    assert!(effect("scene.double_sided").is_none(), "no kernel asks for it");
    let arguments = ["render", &scene, "-p", "cones", "--size", "24x24", "--set", "resolution=16"];
    let record = json(&voxgi(&[&arguments[..], &["--json", "--output", &output]].concat()));
    assert!(record.get("effects").is_none(), "nothing was asked for");
}
