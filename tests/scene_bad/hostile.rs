//! Files that ask for more than they should: made here, since some are large and all are small to describe.

use crate::process::{load, run};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

/// What must become of a file: it loads, or the first problem has this code and these words.
enum Wanted {
    Loads,
    Refused(&'static str, &'static str),
}
use Wanted::{Loads, Refused};

/// A file `scene.gltf` of this document, in a folder of its own together with `others`, ends as it should.
fn document(name: &str, document: &Value, others: &[(&str, &[u8])], wanted: &Wanted) {
    content(name, "scene.gltf", document.to_string().as_bytes(), others, wanted);
}

fn content(name: &str, file: &str, bytes: &[u8], others: &[(&str, &[u8])], wanted: &Wanted) {
    let folder = tempfile::tempdir().unwrap();
    for (file, bytes) in others {
        fs::write(folder.path().join(file), bytes).unwrap();
    }
    fs::write(folder.path().join(file), bytes).unwrap();
    ends(name, &folder.path().join(file), wanted);
}

fn ends(name: &str, path: &Path, wanted: &Wanted) {
    let outcome = load(path);
    println!("{name}: {:?}, {} MiB, {:?}", outcome.time, outcome.kib >> 10, outcome.problems().first());
    let loads = outcome.harmless(&path.to_string_lossy());
    match wanted {
        Loads => assert!(loads, "{name}: {:?}", outcome.problems()),
        Refused(code, words) => {
            let problems = outcome.problems();
            let (found, message) = problems.first().unwrap_or_else(|| panic!("{name} loads"));
            assert!(found == code && message.contains(words), "{name}: {found}: {message}");
        }
    }
}

/// One triangle, in `buffer.bin`.
fn triangle() -> Value {
    json!({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "buffer.bin", "byteLength": 36}],
    })
}

fn corners() -> Vec<u8> {
    [0_f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn with(pointer: &str, value: Value) -> Value {
    let mut document = triangle();
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    match document.pointer_mut(parent).unwrap() {
        Value::Array(list) => list[name.parse::<usize>().unwrap()] = value,
        parent => parent[name] = value,
    }
    document
}

#[test]
fn a_triangle_loads() {
    document("triangle", &triangle(), &[("buffer.bin", &corners())], &Loads);
}

#[test]
fn numbers_that_types_cut() {
    let bin: &[(&str, &[u8])] = &[("buffer.bin", &corners())];
    let wide = 1_u64 << 32;
    for (pointer, value) in [
        ("/nodes/0/mesh", json!(wide)),
        ("/scenes/0/nodes", json!([wide])),
        ("/scene", json!(wide)),
        ("/accessors/0/bufferView", json!(wide)),
        ("/bufferViews/0/buffer", json!(4294967296.0)),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(wide)),
        ("/accessors/0/componentType", json!(wide + 5126)),
        ("/meshes/0/primitives/0/mode", json!(wide + 4)),
        ("/nodes/0/children", json!([wide])),
        ("/textures", json!([{"source": u32::MAX}])),
    ] {
        let place = if pointer == "/textures" { "/textures/0/source" } else { pointer };
        document(pointer, &with(pointer, value), bin, &Refused("gltf-json", place));
    }
    // Elsewhere numbers may be as large as they like.
    document("extras", &with("/extras", json!({"index": wide, "scene": [1e300]})), bin, &Loads);
    document("range", &with("/nodes/0/extras", json!(u64::MAX)), bin, &Loads);
}

#[test]
fn texts_that_are_hardly_json() {
    let brackets = |open: &str, many: usize| open.repeat(many);
    let depth = Refused("gltf-json", "recursion limit");
    let start = r#"{"asset": {"version": "2.0"}, "extras": "#;
    content("100 MB of brackets", "a.gltf", brackets("[", 100 << 20).as_bytes(), &[], &depth);
    content(
        "brackets in extras",
        "a.gltf",
        format!("{start}{}", brackets("[", 1 << 20)).as_bytes(),
        &[],
        &depth,
    );
    content(
        "objects in extras",
        "a.gltf",
        format!("{start}{}", brackets("{\"a\":", 1 << 20)).as_bytes(),
        &[],
        &depth,
    );
    let twice = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0, "extras": {"a": 1, "a": 2}}]}"#;
    content(
        "a name twice",
        "a.gltf",
        twice.as_bytes(),
        &[],
        &Refused("gltf-json", "/nodes/0/extras/a is there twice"),
    );
    let twice = twice.replace(
        "\"extras\": {\"a\": 1, \"a\": 2}",
        "\"attributes\": {\"POSITION\": 1, \"\\u0050OSITION\": 2}",
    );
    content("a name twice, escaped", "a.gltf", twice.as_bytes(), &[], &Refused("gltf-json", "twice"));
    let far = r#"{"asset": {"version": "2.0"}, "nodes": [{"scale": [1e400, 1, 1]}]}"#;
    content("a number beyond all", "a.gltf", far.as_bytes(), &[], &Refused("gltf-json", "out of range"));
    let text = format!(r#"{{"asset": {{"version": "{}"}}}}"#, "9".repeat(10 << 20));
    content("a long version", "a.gltf", text.as_bytes(), &[], &Refused("gltf-version", "…"));
    let text =
        format!(r#"{{"asset": {{"version": "2.0"}}, "extensionsRequired": ["{}"]}}"#, "x".repeat(10 << 20));
    content("a long extension", "a.gltf", text.as_bytes(), &[], &Refused("gltf-extension", "…"));
    let long = with("/buffers/0/uri", json!("x/".repeat(5000)));
    document("a long file name", &long, &[], &Refused("gltf-file", "…"));
    content("only rubbish", "a.glb", &[0x67; 1 << 20], &[], &Refused("gltf-json", ""));
}

/// Documents of which little text makes much memory.
#[test]
fn many_small_things() {
    let start = r#"{"asset": {"version": "2.0"}, "#;
    for list in ["nodes", "materials", "accessors", "scenes", "meshes", "extras"] {
        let text = format!("{start}\"{list}\": [{}{{}}]}}", "{},".repeat(10 << 20));
        content(list, "a.gltf", text.as_bytes(), &[], &Refused("gltf-size", "MiB"));
    }
    let text = format!("{start}\"scenes\": [{{}}], \"extras\": [{}0]}}", "0,".repeat(8 << 20));
    content(
        "numbers, to be tidied",
        "a.gltf",
        text.as_bytes(),
        &[],
        &Refused("gltf-json", "missing field `nodes`"),
    );
    let extension = |i: usize| json!({"extensions": {format!("X_{i}"): {}}});
    let mut many = triangle();
    many["materials"] = (0..20_000).map(extension).collect();
    many["meshes"][0]["primitives"] =
        (0..20_000).map(|i| json!({"attributes": {"POSITION": 0}, "material": i})).collect();
    document("20,000 extensions", &many, &[("buffer.bin", &corners())], &Loads);
}

/// Lists without content, or used over and over.
#[test]
fn lists_without_content() {
    let bin: &[(&str, &[u8])] = &[("buffer.bin", &corners())];
    let zeros = |count: u64, kind: &str| json!({"componentType": 5126, "type": kind, "count": count});
    let size = Refused("gltf-size", "/meshes/0/primitives/0");
    for count in [1 << 24, 1 << 25, 1 << 40, u64::MAX] {
        document("positions of nothing", &with("/accessors/0", zeros(count, "VEC3")), &[bin[0]], &size);
        let mut indexed = triangle();
        indexed["accessors"] = json!([
            triangle()["accessors"][0].clone(),
            {"componentType": 5125, "type": "SCALAR", "count": count},
        ]);
        indexed["meshes"][0]["primitives"][0]["indices"] = json!(1);
        for mode in [4, 5, 6] {
            indexed["meshes"][0]["primitives"][0]["mode"] = json!(mode);
            document("indices of nothing", &indexed, bin, &size);
        }
    }
    // Each just small enough: they add up, in memory or in time.
    let most = 3 << 20;
    let mut many = triangle();
    many["accessors"] = (0..500).map(|_| zeros(most, "VEC3")).collect();
    many["meshes"][0]["primitives"] = (0..500).map(|i| json!({"attributes": {"POSITION": i}})).collect();
    document("many lists", &many, bin, &Refused("gltf-size", ""));
    many["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5125, "type": "SCALAR", "count": 1}));
    many["meshes"][0]["primitives"] =
        (0..500).map(|i| json!({"attributes": {"POSITION": i}, "indices": 500})).collect();
    for list in many["accessors"].as_array_mut().unwrap().iter_mut().take(500) {
        list["count"] = json!(most / 2);
    }
    document("many lists that become nothing", &many, bin, &Refused("gltf-size", "too many times"));
    let mut placed = triangle();
    placed["nodes"] = json!(vec![json!({"mesh": 0}); 20_000]);
    placed["scenes"][0]["nodes"] = (0..20_000).collect();
    placed["meshes"][0]["primitives"] = json!(vec![json!({"attributes": {"POSITION": 0}}); 20_000]);
    document("400 million placings", &placed, bin, &Refused("gltf-size", ""));
    placed["meshes"][0]["primitives"] =
        json!(vec![json!({"attributes": {"POSITION": 0}, "mode": 1}); 20_000]);
    document("400 million placings of lines", &placed, bin, &Refused("gltf-size", ""));
    let sparse = |places: u64, index: u64| {
        json!({"componentType": 5126, "type": "VEC3", "count": 3, "sparse": {"count": places,
            "indices": {"bufferView": 0, "componentType": 5125, "byteOffset": index}, "values": {"bufferView": 0}}})
    };
    let place = "/meshes/0/primitives/0/attributes/POSITION";
    document("sparse, too many", &with("/accessors/0", sparse(4, 0)), bin, &Refused("gltf-length", place));
    document("sparse, beyond", &with("/accessors/0", sparse(1, 12)), bin, &Refused("gltf-reference", place));
    document("sparse, no end", &with("/accessors/0", sparse(u64::MAX, 0)), bin, &Refused("gltf-size", place));
}

#[test]
fn nodes_without_end() {
    let bin: &[(&str, &[u8])] = &[("buffer.bin", &corners())];
    let many = 100_000;
    let chain: Vec<Value> = (0..many)
        .map(|i| if i + 1 < many { json!({"children": [i + 1]}) } else { json!({"mesh": 0}) })
        .collect();
    document("a chain", &with("/nodes", chain.clone().into()), bin, &Loads);
    let mut ring = chain;
    ring[many - 1] = json!({"children": [0]});
    document("a ring", &with("/nodes", ring.into()), bin, &Refused("gltf-nodes", "ancestor"));
    let mut skinned = with("/skins", json!([{"joints": [0, 0], "skeleton": 0, "inverseBindMatrices": 0}]));
    skinned["nodes"][0]["skin"] = json!(0);
    document("a mesh that is its own joint", &skinned, bin, &Loads);
    for (name, transform) in [
        ("an infinite translation", json!({"translation": [1e39, 0, 0], "mesh": 0})),
        ("a vast translation", json!({"translation": [1e19, 0, 0], "mesh": 0})),
        ("a vast scale", json!({"scale": [1e38, 1e38, 1e38], "mesh": 0})),
        ("no rotation", json!({"rotation": [0, 0, 0, 0], "mesh": 0})),
    ] {
        document(name, &with("/nodes/0", transform), bin, &Refused("gltf-value", "/nodes"));
    }
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut bytes = corners();
        bytes[16..20].copy_from_slice(&bad.to_le_bytes());
        document(
            "a wild position",
            &triangle(),
            &[("buffer.bin", &bytes)],
            &Refused("gltf-value", "position 1"),
        );
    }
}

/// Animations whose keys are shared, and many things that move by one of them.
#[test]
fn motion_without_end() {
    let keys: Vec<u8> = (0..100_000).flat_map(|i| (i as f32).to_le_bytes()).collect();
    let mut moved = triangle();
    let accessors = moved["accessors"].as_array_mut().unwrap();
    accessors.push(json!({"bufferView": 1, "componentType": 5126, "type": "SCALAR", "count": 100_000}));
    accessors.push(json!({"componentType": 5126, "type": "VEC3", "count": 100_000}));
    moved["bufferViews"].as_array_mut().unwrap().push(json!({"buffer": 1, "byteLength": keys.len()}));
    moved["buffers"].as_array_mut().unwrap().push(json!({"uri": "keys.bin", "byteLength": keys.len()}));
    let others: &[(&str, &[u8])] = &[("buffer.bin", &corners()), ("keys.bin", &keys)];
    let channel = |i: usize| json!({"sampler": 0, "target": {"node": i, "path": "translation"}});
    let animation = |count| json!([{"samplers": [{"input": 1, "output": 2}], "channels": (0..count).map(channel).collect::<Value>()}]);
    moved["animations"] = animation(1);
    document("a moving triangle", &moved, others, &Loads);
    let many = 5_000;
    moved["nodes"] = json!(vec![json!({"mesh": 0}); many]);
    moved["scenes"][0]["nodes"] = (0..many).collect();
    moved["animations"] = animation(many);
    document(
        "5,000 moving triangles of 100,000 keys",
        &moved,
        others,
        &Refused("gltf-size", "/animations/0"),
    );
    let mut nodes = vec![json!({"mesh": 0}); many];
    nodes[0]["children"] = (1..many).collect();
    moved["nodes"] = nodes.into();
    moved["scenes"][0]["nodes"] = json!([0]);
    moved["animations"] = animation(1);
    document("5,000 triangles on a moving node", &moved, others, &Loads);
}

#[test]
fn files_elsewhere() {
    let secret = tempfile::tempdir().unwrap();
    fs::write(secret.path().join("secret.bin"), corners()).unwrap();
    let absolute = secret.path().join("secret.bin").to_string_lossy().into_owned();
    let up = "../".repeat(20);
    for uri in [
        absolute.clone(),
        format!("file://{absolute}"),
        format!("{up}{absolute}"),
        format!("{}{absolute}", "%2E%2e%2F".repeat(20)),
        format!("./a/../{up}{absolute}"),
        absolute.replace('/', "%2f"),
        absolute.replace('/', "\\"),
        "..%00/buffer.bin".to_owned(),
        "C:buffer.bin".to_owned(),
        "https://example.com/buffer.bin".to_owned(),
        String::new(),
        "data:application/octet-stream;base64,%%%".to_owned(),
        "data:;base64,AAA=AAA=".to_owned(),
        "data:".to_owned(),
        format!("data:,{}%", "a".repeat(20 << 20)),
    ] {
        let short: String = uri.chars().take(60).collect();
        document(
            &short,
            &with("/buffers/0/uri", json!(uri)),
            &[("buffer.bin", &corners())],
            &Refused("gltf-uri", "/buffers/0"),
        );
    }
    for target in [absolute.as_str(), "/dev/zero", "/proc/self/mem", "."] {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(target, folder.path().join("buffer.bin")).unwrap();
        fs::write(folder.path().join("scene.gltf"), triangle().to_string()).unwrap();
        ends(target, &folder.path().join("scene.gltf"), &Refused("gltf-file", "/buffers/0"));
    }
    // One file of 8 MB, named a thousand times.
    let mut many = triangle();
    many["buffers"] = json!(vec![json!({"uri": "buffer.bin", "byteLength": 8 << 20}); 1000]);
    document(
        "a file a thousand times",
        &many,
        &[("buffer.bin", &vec![0; 8 << 20])],
        &Refused("gltf-size", "/buffers/"),
    );
}

/// A PNG of one bit a texel, so that a small file has many.
fn png(side: u32) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, side, side);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&vec![0; side.div_ceil(8) as usize * side as usize]).unwrap();
    writer.finish().unwrap();
    file
}

/// The triangle with `count` textured materials, each with an image of its own of the same file.
fn textured(count: usize) -> Value {
    let mut document = triangle();
    let list = |make: &dyn Fn(usize) -> Value| (0..count).map(make).collect::<Value>();
    document["images"] = list(&|_| json!({"uri": "image.png"}));
    document["textures"] = list(&|i| json!({"source": i}));
    document["materials"] = list(&|i| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}}));
    document["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5126, "type": "VEC2", "count": 3}));
    document["meshes"][0]["primitives"] =
        list(&|i| json!({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": i}));
    document
}

#[test]
fn pictures_that_swell() {
    let place = "/materials/0/pbrMetallicRoughness/baseColorTexture";
    let bomb = |name: &str, count: usize, image: &[u8], wanted: Wanted| {
        document(name, &textured(count), &[("buffer.bin", &corners()), ("image.png", image)], &wanted);
    };
    bomb("a plain picture", 1, &png(64), Loads);
    bomb("a large picture", 1, &png(4096), Loads);
    let mut vast = png(64);
    for (at, side) in [(16, 60_000_u32), (20, 60_000)] {
        vast[at..at + 4].copy_from_slice(&side.to_be_bytes());
    }
    bomb("a lie", 1, &vast, Refused("gltf-image", place));
    bomb("16384 texels a side", 1, &png(16384), Refused("gltf-size", place));
    bomb("fifty pictures", 50, &png(4096), Refused("gltf-size", "/materials/"));
    let mut cut = png(4096);
    cut.truncate(1000);
    bomb("a picture cut short", 1, &cut, Refused("gltf-image", place));
    bomb("no picture", 1, b"GIF89a", Loads);
    bomb("nothing", 1, b"", Refused("gltf-image", place));
    let jpeg =
        [0xff, 0xd8, 0xff, 0xc0, 0, 17, 8, 0xff, 0xff, 0xff, 0xff, 3, 1, 0x22, 0, 2, 0x11, 1, 3, 0x11, 1];
    bomb("a JPEG of 65535 texels a side", 1, &jpeg, Refused("gltf-image", place));
}

/// Texts of settings and pipelines that nest without end, or are endless.
#[test]
fn ron_without_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.ron");
    for open in ["(", "[", "{", "Some(", "Setting(gltf:", "/*"] {
        fs::write(&path, open.repeat(200_000 / open.len())).unwrap();
        ends(open, &path, &Refused("setting", ""));
        let mut command = Command::new(env!("CARGO_BIN_EXE_voxgi"));
        command.args(["check".as_ref(), path.as_os_str(), "--json".as_ref()]);
        assert!(!run(command).harmless("scene.ron"), "{open}");
    }
    fs::write(&path, format!("Setting(gltf: \"{}", "a".repeat(50 << 20))).unwrap();
    ends("a long setting", &path, &Refused("setting", "larger than 1 MiB"));
}
