//! Wrong and hostile files: each gives a problem that names the place, and none a panic.

use crate::documents::{TRIANGLE, data_uri, document, floats, load, load_bytes, triangle};
use proptest::prelude::*;
use serde_json::{Value, json};
use voxgi::problem::{Kind, Problems};
use voxgi::scene::generate::{CornellLight, cornell_box};

/// The document with the value at `pointer` replaced; the last name of the pointer may be new.
fn with(mut document: Value, pointer: &str, value: Value) -> Value {
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    match document.pointer_mut(parent).unwrap() {
        Value::Array(list) => list[name.parse::<usize>().unwrap()] = value,
        parent => parent[name] = value,
    }
    document
}

fn indexed(index: u8) -> Value {
    document(&[
        ("POSITION", floats(&TRIANGLE), 5126, "VEC3", 3),
        ("indices", vec![0, 1, index], 5121, "SCALAR", 3),
    ])
}

fn refused(document: &Value, code: &str, place: &str) {
    let problems: Problems = load(document).map(|scene| scene.triangles.len()).expect_err(place);
    let found = problems.iter().any(|p| p.code == code && p.message.contains(place) && p.kind == Kind::Input);
    assert!(found, "no {code} at {place} in {problems}");
    assert_eq!(problems.exit_code(), 2);
}

#[test]
fn places_are_named() {
    let position = "/meshes/0/primitives/0/attributes/POSITION";
    let nan = document(&[("POSITION", floats(&[f32::NAN; 9]), 5126, "VEC3", 3)]);
    let primitive = "/meshes/0/primitives/0";
    let light = json!({"extensions": {"KHR_lights_punctual": {"light": 0}}, "mesh": 0});
    let spot =
        json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"innerConeAngle": 1.0}}]}});
    let huge = json!([3e38, 3e38, 0, 0, 3e38, 3e38, 0, 0, 0, 0, 1, 0, 3e38, 0, 0, 1]);
    let vast = |children: &[u32]| json!({"scale": [1e20, 1e20, 1e20], "children": children, "mesh": 0});
    for (document, code, place) in [
        // References
        (with(triangle(), position, json!(7)), "gltf-reference", position),
        (with(triangle(), "/accessors/0/bufferView", json!(7)), "gltf-reference", position),
        (with(triangle(), "/bufferViews/0/buffer", json!(7)), "gltf-reference", position),
        (with(triangle(), "/nodes/0/mesh", json!(7)), "gltf-reference", "/nodes/0/mesh"),
        (with(triangle(), "/nodes/0/camera", json!(7)), "gltf-reference", "/nodes/0/camera"),
        (with(triangle(), "/nodes/0/children", json!([7])), "gltf-reference", "/nodes/0/children/0"),
        (with(triangle(), "/scenes/0/nodes", json!([7])), "gltf-reference", "/scenes/0/nodes/0"),
        (with(triangle(), "/scene", json!(7)), "gltf-reference", "/scene"),
        (with(triangle(), "/meshes/0/primitives/0/material", json!(7)), "gltf-reference", primitive),
        (
            with(triangle(), "/nodes/0", light.clone()),
            "gltf-reference",
            "/nodes/0/extensions/KHR_lights_punctual",
        ),
        (indexed(3), "gltf-index", "/meshes/0/primitives/0/indices"),
        // Lengths that lie
        (with(triangle(), "/accessors/0/count", json!(4)), "gltf-length", position),
        (with(triangle(), "/accessors/0/byteOffset", json!(4)), "gltf-length", position),
        (with(triangle(), "/accessors/0/byteOffset", json!(u64::MAX)), "gltf-length", position),
        (with(triangle(), "/accessors/0/count", json!(u64::MAX)), "gltf-size", position),
        (with(triangle(), "/bufferViews/0/byteLength", json!(u64::MAX)), "", position),
        (with(triangle(), "/bufferViews/0/byteOffset", json!(u64::MAX)), "gltf-length", position),
        (with(triangle(), "/bufferViews/0/byteStride", json!(0)), "gltf-accessor", position),
        (with(triangle(), "/buffers/0/byteLength", json!(37)), "gltf-length", "/buffers/0"),
        (with(triangle(), "/buffers/0/byteLength", json!(20)), "gltf-length", position),
        (
            with(
                triangle(),
                "/accessors/0",
                json!({"componentType": 5126, "type": "VEC3", "count": 1u64 << 40}),
            ),
            "gltf-size",
            position,
        ),
        // Kinds and values
        (with(triangle(), "/accessors/0/type", json!("VEC2")), "gltf-accessor", position),
        (with(triangle(), "/accessors/0/type", json!("VEC9")), "gltf-accessor", position),
        (with(triangle(), "/accessors/0/componentType", json!(1)), "gltf-accessor", position),
        (
            with(indexed(2), "/accessors/1/componentType", json!(5120)),
            "gltf-accessor",
            "/primitives/0/indices",
        ),
        (with(triangle(), "/meshes/0/primitives/0/mode", json!(9)), "gltf-value", primitive),
        (nan, "gltf-value", position),
        (with(triangle(), "/nodes/0/scale", json!([1e39, 1, 1])), "gltf-value", "/nodes/0"),
        (with(triangle(), "/nodes/0/matrix", huge), "gltf-value", "/nodes"),
        (with(triangle(), "/nodes", json!([vast(&[1]), vast(&[2]), vast(&[])])), "gltf-value", "/nodes/2"),
        (with(triangle(), "/nodes/0/rotation", json!([0, 0, 0, 0])), "gltf-value", "/nodes/0"),
        (with(triangle(), "/nodes/0/matrix", json!(vec![1; 16])), "gltf-value", "/nodes/0"),
        (
            with(triangle(), "/materials", json!([{"emissiveFactor": [-1, 0, 0]}])),
            "gltf-value",
            "/materials/0/emissiveFactor",
        ),
        (
            with(with(triangle(), "/nodes/0", light), "/extensions", spot),
            "gltf-light",
            "/extensions/KHR_lights_punctual/lights/0",
        ),
        (
            with(triangle(), "/extensionsRequired", json!(["KHR_draco_mesh_compression"])),
            "gltf-extension",
            "/extensionsRequired/0",
        ),
        // Paths
        (with(triangle(), "/buffers/0/uri", json!("../../etc/passwd")), "gltf-uri", "/buffers/0"),
        (with(triangle(), "/buffers/0/uri", json!("/etc/passwd")), "gltf-uri", "/buffers/0"),
        (with(triangle(), "/buffers/0/uri", json!("%2e%2e/%2e%2e/etc/passwd")), "gltf-uri", "/buffers/0"),
        (with(triangle(), "/buffers/0/uri", json!("gone.bin")), "gltf-file", "/buffers/0"),
        (with(triangle(), "/buffers/0/uri", json!(".")), "gltf-file", "/buffers/0"),
    ] {
        if code.is_empty() {
            // A view may promise more than there is, as long as nobody asks for it.
            assert!(load(&document).is_ok());
        } else {
            refused(&document, code, place);
        }
    }
}

#[test]
fn nodes_form_a_tree() {
    let nodes =
        |nodes: Value, roots: Value| with(with(triangle(), "/nodes", nodes), "/scenes/0/nodes", roots);
    let children = |list: &[u32]| json!({"children": list, "mesh": 0});
    refused(&nodes(json!([children(&[0])]), json!([0])), "gltf-nodes", "/nodes/0");
    refused(&nodes(json!([children(&[1]), children(&[0])]), json!([0])), "gltf-nodes", "own ancestor");
    let two = json!([children(&[2]), children(&[2]), children(&[])]);
    refused(&nodes(two, json!([0, 1])), "gltf-nodes", "/nodes/1/children/0");
    refused(
        &nodes(json!([children(&[1, 1]), children(&[])]), json!([0])),
        "gltf-nodes",
        "/nodes/0/children/1",
    );
    refused(&nodes(json!([children(&[])]), json!([0, 0])), "gltf-nodes", "listed twice");
    refused(&nodes(json!([children(&[1]), children(&[])]), json!([1])), "gltf-nodes", "no root");
}

#[cfg(unix)]
#[test]
fn links_do_not_lead_out() {
    let outside = tempfile::tempdir().unwrap();
    std::fs::write(outside.path().join("secret.bin"), floats(&TRIANGLE)).unwrap();
    let inside = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(outside.path(), inside.path().join("link")).unwrap();
    let path = inside.path().join("scene.gltf");
    let document = with(triangle(), "/buffers/0/uri", json!("link/secret.bin"));
    std::fs::write(&path, document.to_string()).unwrap();
    let problems = voxgi::scene::load(&path).map(|_| ()).unwrap_err();
    assert!(
        problems.iter().any(|problem| problem.message.contains("out of the scene's folder")),
        "{problems}"
    );
}

/// The squares of their components are too small for f32.
#[test]
fn tiny_normals_get_unit_length() {
    for length in [1e-45_f32, 1e-40, 1e-23, 1e19, 3e38] {
        let normals = floats(&[[length, length, 0.]; 3].concat());
        let lists = [("POSITION", floats(&TRIANGLE), 5126, "VEC3", 3), ("NORMAL", normals, 5126, "VEC3", 3)];
        let normal = load(&document(&lists)).unwrap().vertices[0].normal;
        assert!((normal.length() - 1.0).abs() < 1e-6 && normal.x == normal.y, "{length}: {normal}");
    }
}

/// Corners of no triangle have normals too.
#[test]
fn normals_of_unused_vertices_have_unit_length() {
    let positions = floats(&[&TRIANGLE[..], &[5.; 3]].concat());
    let lists = [("POSITION", positions, 5126, "VEC3", 4), ("NORMAL", vec![0; 48], 5126, "VEC3", 4)];
    let mut document = document(&lists);
    document["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5121, "type": "SCALAR", "count": 3}));
    document["meshes"][0]["primitives"][0]["indices"] = json!(2);
    let vertices = load(&document).unwrap().vertices;
    assert!(vertices.len() == 4 && vertices.iter().all(|vertex| vertex.normal == glam::Vec3::Z));
}

/// Cameras and lights whose numbers f32 can't carry on with.
#[test]
fn vast_cameras_and_lights_are_refused() {
    let camera = |yfov: f64, znear: f64| json!([{"type": "perspective", "perspective": {"yfov": yfov, "znear": znear}}]);
    let lights = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    let seen = with(triangle(), "/nodes/0", json!({"mesh": 0, "camera": 0}));
    assert!(load(&with(seen.clone(), "/cameras", camera(1.0, 0.1))).is_ok());
    refused(&with(seen.clone(), "/cameras", camera(1e-40, 0.1)), "gltf-camera", "/cameras/0");
    refused(&with(seen.clone(), "/cameras", camera(1.0, 1e-42)), "gltf-camera", "/cameras/0");
    let parallel = |ymag: f64| {
        let lens = json!({"xmag": 1, "ymag": ymag, "znear": 0.1, "zfar": 10});
        json!([{"type": "orthographic", "orthographic": lens}])
    };
    assert!(load(&with(seen.clone(), "/cameras", parallel(1.0))).is_ok());
    refused(&with(seen.clone(), "/cameras", parallel(3.4e38)), "gltf-camera", "/cameras/0");
    let nodes = |node: Value| with(triangle(), "/nodes", json!([{"mesh": 0}, node]));
    let far = |node: Value| with(nodes(node), "/scenes/0/nodes", json!([0, 1]));
    let camera_far = far(json!({"camera": 0, "translation": [1e19, 0, 0]}));
    refused(&with(camera_far, "/cameras", camera(1.0, 0.1)), "gltf-camera", "/cameras/0");
    let light = json!({"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 1e19, 0]});
    refused(
        &with(far(light), "/extensions", lights),
        "gltf-light",
        "/extensions/KHR_lights_punctual/lights/0",
    );
}

/// A few bytes that ask for a lot: 20,000 nodes with 20,000 triangles each.
#[test]
fn small_files_stay_small() {
    let many = 20_000;
    let points: Vec<f32> = (0..many + 2).flat_map(|i| [i as f32, (i % 2) as f32, 0.]).collect();
    let mut document = document(&[("POSITION", floats(&points), 5126, "VEC3", many + 2)]);
    document["meshes"][0]["primitives"][0]["mode"] = json!(5);
    document["nodes"] = json!(vec![json!({"mesh": 0}); many]);
    document["scenes"][0]["nodes"] = json!((0..many).collect::<Vec<_>>());
    refused(&document, "gltf-size", "triangles");
}

#[test]
fn everything_wrong_is_reported() {
    let document = with(triangle(), "/nodes/0/camera", json!(7));
    let document = with(document, "/accessors/0/count", json!(4));
    let document = with(document, "/materials", json!([{"alphaMode": "NONE"}]));
    assert_eq!(load(&document).map(|_| ()).unwrap_err().iter().count(), 3);
}

#[test]
fn files_that_are_no_scene() {
    for (name, bytes, code) in [
        ("empty.gltf", &b""[..], "gltf-json"),
        ("empty.glb", b"", "gltf-json"),
        ("text.gltf", b"{", "gltf-json"),
        ("text.obj", b"v 0 0 0", "scene-kind"),
        ("head.glb", b"glTF\x02\0\0\0", "gltf-container"),
        ("one.glb", b"glTF\x01\0\0\0\x14\0\0\0", "gltf-container"),
        ("old.gltf", br#"{"asset": {"version": "1.0"}}"#, "gltf-version"),
    ] {
        let problems = load_bytes(name, bytes).map(|_| ()).expect_err(name);
        assert_eq!(problems.iter().next().unwrap().code, code, "{name}: {problems}");
    }
    let problems = voxgi::scene::load("no/such/file.glb".as_ref()).map(|_| ()).unwrap_err();
    assert_eq!((problems.iter().next().unwrap().code, problems.exit_code()), ("scene-file", 2));
}

/// All places of a document.
fn pointers(value: &Value, at: &str, list: &mut Vec<String>) {
    let children: Vec<(String, &Value)> = match value {
        Value::Object(map) => map.iter().map(|(name, value)| (name.clone(), value)).collect(),
        Value::Array(items) => items.iter().enumerate().map(|(i, value)| (i.to_string(), value)).collect(),
        _ => Vec::new(),
    };
    for (name, value) in children {
        let pointer = format!("{at}/{name}");
        pointers(value, &pointer, list);
        list.push(pointer);
    }
}

/// A document with something of everything.
fn rich() -> Value {
    let file = cornell_box(CornellLight::Point);
    let length = u32::from_le_bytes([file[12], file[13], file[14], file[15]]) as usize;
    let mut document: Value = serde_json::from_slice(&file[20..20 + length]).unwrap();
    document["buffers"][0]["uri"] = json!(data_uri(&file[28 + length..]));
    document
}

proptest! {
    /// One or two values replaced by others: it loads, or says why not.
    #[test]
    fn any_value_may_be_wrong(changes in prop::collection::vec((any::<prop::sample::Index>(), 0..14usize), 1..3)) {
        let values = [
            json!(0), json!(1), json!(-1), json!(3), json!(u32::MAX), json!(1u64 << 32), json!(u64::MAX),
            json!(1e39), json!(0.5), json!("x"), json!(null), json!([]), json!({}), json!([0, 0, 0]),
        ];
        let mut document = rich();
        for (place, value) in changes {
            let mut list = Vec::new();
            pointers(&document, "", &mut list);
            document = with(document, &list[place.index(list.len())], values[value].clone());
        }
        if let Err(problems) = load(&document) {
            prop_assert!(problems.iter().all(|problem| problem.kind == Kind::Input), "{}", problems);
        }
    }

    /// A binary file cut short or with flipped bytes: the same.
    #[test]
    fn any_byte_may_be_wrong(cut in 0..9000usize, flips in prop::collection::vec((0..9000usize, 1u8..), 0..4)) {
        let mut file = cornell_box(CornellLight::Area);
        file.truncate(cut.max(20));
        for (place, bits) in flips {
            let place = place % file.len();
            file[place] ^= bits;
        }
        if let Err(problems) = load_bytes("scene.glb", &file) {
            prop_assert!(problems.iter().all(|problem| problem.kind == Kind::Input), "{}", problems);
        }
    }
}
