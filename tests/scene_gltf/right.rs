//! What the loader makes of right glTF files, against numbers worked out by hand.

use crate::documents::{TRIANGLE, data_uri, document, floats, load, triangle};
use glam::{UVec4, Vec3, Vec4};
use serde_json::json;
use voxgi::scene::layout::{DOUBLE_SIDED, UNLIT};
use voxgi::scene::{Lens, Scene};

/// Corners of all triangles in the world, in order.
fn world(scene: &Scene) -> Vec<[Vec3; 3]> {
    let place = |instance: u32, corner: u32| {
        let p = scene.vertices[corner as usize].position;
        let [x, y, z, w] = scene.instances[instance as usize].to_world;
        (x * p.x + y * p.y + z * p.z + w).truncate()
    };
    scene.triangles.iter().map(|t| [t.a, t.b, t.c].map(|corner| place(t.instance, corner))).collect()
}

fn lacks(scene: &Scene) -> Vec<String> {
    scene.lacks.iter().map(ToString::to_string).collect()
}

#[test]
fn a_bare_triangle() {
    let scene = load(&triangle()).unwrap();
    assert_eq!(world(&scene), [[Vec3::ZERO, Vec3::X, Vec3::Y]]);
    assert!(scene.vertices.iter().all(|vertex| vertex.normal == Vec3::Z));
    assert_eq!((scene.bounds.min, scene.bounds.max), (Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)));
    assert_eq!((scene.name.as_str(), scene.files.len(), scene.cameras.len()), ("scene", 1, 1));
    assert_eq!(scene.cameras[0].name, "default");
    // glTF's default material.
    let material = &scene.materials[scene.instances[0].material as usize];
    assert_eq!((material.base_color, material.metallic, material.roughness), (Vec3::ONE, 1.0, 1.0));
    assert_eq!(lacks(&scene), [""; 0]);
}

#[test]
fn indices_of_every_width() {
    let square = floats(&[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    let list = [0u8, 1, 2, 0, 2, 3];
    let wide = |width: usize| list.iter().flat_map(|i| [&[*i][..], &vec![0; width - 1]].concat()).collect();
    let expected =
        [[Vec3::ZERO, Vec3::X, Vec3::new(1., 1., 0.)], [Vec3::ZERO, Vec3::new(1., 1., 0.), Vec3::Y]];
    for (width, component) in [(1, 5121), (2, 5123), (4, 5125)] {
        let document = document(&[
            ("POSITION", square.clone(), 5126, "VEC3", 4),
            ("indices", wide(width), component, "SCALAR", 6),
        ]);
        assert_eq!(world(&load(&document).unwrap()), expected, "{component}");
    }
}

#[test]
fn strips_and_fans() {
    let row: Vec<f32> = (0..5).flat_map(|i| [i as f32, 0., 0.]).collect();
    for (mode, expected) in [
        // The windings that glTF's specification gives for each mode.
        (4, vec![[0, 1, 2]]),
        (5, vec![[0, 1, 2], [1, 3, 2], [2, 3, 4]]),
        (6, vec![[1, 2, 0], [2, 3, 0], [3, 4, 0]]),
    ] {
        let mut document = document(&[("POSITION", floats(&row), 5126, "VEC3", 5)]);
        document["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        let scene = load(&document).unwrap();
        let found: Vec<_> = world(&scene).iter().map(|t| t.map(|corner| corner.x as i32)).collect();
        assert_eq!(found, expected, "mode {mode}");
        assert_eq!(lacks(&scene).len(), usize::from(mode == 4), "two vertices are left over");
    }
}

#[test]
fn interleaved_quantized_and_sparse() {
    // Positions as normalized bytes, 8 apart: 127 is 1.
    let mut bytes = [0u8; 24];
    (bytes[8], bytes[17]) = (127, 127);
    let mut interleaved = document(&[("POSITION", bytes.to_vec(), 5120, "VEC3", 3)]);
    interleaved["accessors"][0]["normalized"] = json!(true);
    interleaved["bufferViews"][0]["byteStride"] = json!(8);
    interleaved["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    assert_eq!(world(&load(&interleaved).unwrap()), [[Vec3::ZERO, Vec3::X, Vec3::Y]]);
    // All zeros, but for elements 1 and 2.
    let mut sparse = document(&[
        ("POSITION", floats(&TRIANGLE[3..]), 5126, "VEC3", 3),
        ("indices", vec![0, 1, 2], 5121, "SCALAR", 3),
    ]);
    sparse["accessors"][0] = json!({"componentType": 5126, "type": "VEC3", "count": 3, "sparse": {
        "count": 2, "indices": {"bufferView": 1, "byteOffset": 1, "componentType": 5121}, "values": {"bufferView": 0},
    }});
    assert_eq!(world(&load(&sparse).unwrap()), [[Vec3::ZERO, Vec3::X, Vec3::Y]]);
}

#[test]
fn transforms_of_parents_and_mirrors() {
    let mut document = triangle();
    document["nodes"] = json!([
        {"translation": [10, 0, 0], "children": [1]},
        // Turned by 90° about z, after scaling.
        {"rotation": [0, 0, 0.5f32.sqrt(), 0.5f32.sqrt()], "scale": [2, 3, 1], "mesh": 0},
        {"matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1], "mesh": 0},
    ]);
    document["scenes"] = json!([{"nodes": [0, 2]}]);
    let scene = load(&document).unwrap();
    let expected = [
        [Vec3::new(10., 0., 0.), Vec3::new(10., 2., 0.), Vec3::new(7., 0., 0.)],
        [Vec3::new(5., 0., 0.), Vec3::new(4., 0., 0.), Vec3::new(5., 1., 0.)],
    ];
    for (found, expected) in world(&scene).iter().flatten().zip(expected.iter().flatten()) {
        assert!((*found - *expected).length() < 1e-5, "{found} {expected}");
    }
    assert_eq!(scene.instances.iter().map(|i| i.flip).collect::<Vec<_>>(), [1.0, -1.0]);
    assert_eq!(scene.vertices.len(), 3, "two nodes share one mesh");
}

/// Normals stay at right angles to what they are normal to, whatever the transform; pressed flat, they are normal to
/// the plane.
#[test]
fn normals_follow_the_surface() {
    for scale in [[1., 1., 1.], [2., 5., 0.5], [-2., 1., 3.], [1., 1., 0.]] {
        let slope = [0., 0., 0., 1., 0., 1., 0., 1., 2.];
        let mut document = document(&[("POSITION", floats(&slope), 5126, "VEC3", 3)]);
        document["nodes"][0]["scale"] = json!(scale);
        let scene = load(&document).unwrap();
        let [a, b, c] = world(&scene)[0];
        let n = scene.vertices[0].normal;
        let [x, y, z] = scene.instances[0].normal_to_world;
        let normal: Vec4 = x * n.x + y * n.y + z * n.z;
        let normal = normal.truncate().normalize();
        let face = (b - a).cross(c - a).normalize() * scene.instances[0].flip;
        assert!((normal - face).length() < 1e-5, "{scale:?}: {normal} {face}");
    }
}

#[test]
fn materials() {
    let mut document = triangle();
    document["meshes"][0]["primitives"][0]["material"] = json!(0);
    document["materials"] = json!([
        {
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.1, 0.2, 0.3, 0.5], "metallicFactor": 0.25, "roughnessFactor": 0.75,
            },
            "emissiveFactor": [1, 0.5, 0], "alphaMode": "MASK", "alphaCutoff": 0.2, "doubleSided": true,
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}},
        },
        {"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0]}},
        {"alphaMode": "MASK"},
        {"alphaCutoff": 0.3},
    ]);
    let scene = load(&document).unwrap();
    let first = &scene.materials[0];
    assert_eq!(first.base_color, Vec3::new(0.1, 0.2, 0.3));
    assert_eq!(first.emission, Vec3::new(8.0, 4.0, 0.0));
    assert_eq!((first.metallic, first.roughness), (0.25, 0.75));
    assert_eq!(first.flags, DOUBLE_SIDED);
    // 0.5 × alpha ≥ 0.2 where alpha ≥ 0.4.
    assert!((first.alpha_cutoff - 0.4).abs() < 1e-6);
    assert!(scene.materials[1].alpha_cutoff > 1.0, "nothing is left of it");
    assert_eq!((scene.materials[2].alpha_cutoff, scene.materials[3].alpha_cutoff), (0.5, 0.0));
    // An unlit surface gives off its colour and reflects nothing.
    document["materials"][0]["extensions"] = json!({"KHR_materials_unlit": {}});
    let unlit = load(&document).unwrap().materials[0];
    assert_eq!((unlit.base_color, unlit.emission), (Vec3::ZERO, Vec3::new(0.1, 0.2, 0.3)));
    assert_eq!(unlit.flags, DOUBLE_SIDED | UNLIT);
}

#[test]
fn textures_that_are_used() {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 1, 2, 3, 4])
        .unwrap()
        .write_to(&mut png, image::ImageFormat::Png)
        .unwrap();
    let uvs = floats(&[0., 0., 1., 0., 0., f32::NAN]);
    let mut document =
        document(&[("POSITION", floats(&TRIANGLE), 5126, "VEC3", 3), ("TEXCOORD_0", uvs, 5126, "VEC2", 3)]);
    document["meshes"][0]["primitives"][0]["material"] = json!(0);
    document["images"] = json!([
        {"uri": data_uri(b"no image"), "name": "unused"},
        {"uri": data_uri(&png.into_inner()), "name": "used"},
    ]);
    document["samplers"] = json!([{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}]);
    document["textures"] = json!([{"source": 0}, {"source": 1}, {"source": 1, "sampler": 0}]);
    document["materials"] = json!([
        {
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 1}},
            "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 2}, "occlusionTexture": {"index": 0},
        },
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
    ]);
    let scene = load(&document).unwrap();
    assert_eq!(scene.images.iter().map(|image| image.name.as_str()).collect::<Vec<_>>(), ["used"]);
    assert_eq!(scene.texels.len(), 3);
    assert_eq!(scene.texels[0].to_le_bytes(), [255, 0, 0, 255]);
    assert_eq!(scene.texels[1].to_le_bytes(), [1, 2, 3, 4]);
    let (srgb, levels) = (1 << 5, 2 << 8);
    assert_eq!(scene.materials[0].base_color_image, UVec4::new(0, 2, 1, srgb | levels));
    let sampler = 1 | 2 << 2 | 1 << 4;
    assert_eq!(scene.materials[0].emission_image, UVec4::new(0, 2, 1, srgb | levels | sampler));
    assert_eq!(
        lacks(&scene),
        [
            "1 texture coordinate that is not finite is set to 0",
            "1 occlusion texture is not applied: occlusion is simulated"
        ]
    );
    assert_eq!((scene.vertices[1].u, scene.vertices[2].v), (1.0, 0.0));
}

#[test]
fn lights_and_cameras_of_nodes() {
    let mut document = triangle();
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "color": [1, 0.5, 0.25], "intensity": 4},
        {"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 1.0}},
        {"type": "directional", "intensity": 3},
    ]}});
    let light = |i| json!({"KHR_lights_punctual": {"light": i}});
    // Turned by 90° about x: −z becomes +y.
    let up = json!([0.5f32.sqrt(), 0, 0, 0.5f32.sqrt()]);
    document["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.25}}]);
    document["nodes"] = json!([
        {"translation": [1, 2, 3], "extensions": light(0)},
        {"rotation": up, "scale": [5, 5, 5], "extensions": light(1)},
        {"extensions": light(2)},
        {"name": "eye", "camera": 0, "translation": [0, 0, 9], "rotation": up},
    ]);
    document["scenes"] = json!([{"nodes": [0, 1, 2, 3]}]);
    let scene = load(&document).unwrap();
    let [point, spot, sun] = scene.lights[..] else { panic!("three lights") };
    assert_eq!(
        (point.kind, point.position, point.intensity),
        (0, Vec3::new(1., 2., 3.), Vec3::new(4., 2., 1.))
    );
    assert_eq!((spot.kind, spot.intensity), (1, Vec3::ONE));
    assert!((spot.direction - Vec3::Y).length() < 1e-6);
    assert!((spot.cos_inner - 0.5f32.cos()).abs() < 1e-6 && (spot.cos_outer - 1f32.cos()).abs() < 1e-6);
    assert_eq!((sun.kind, sun.direction, sun.intensity), (2, Vec3::NEG_Z, Vec3::splat(3.0)));
    let camera = &scene.cameras[0];
    let lens = Lens::Perspective { vertical_fov: 1.0 };
    assert_eq!((camera.name.as_str(), camera.lens, camera.near), ("eye", lens, 0.25));
    assert!((camera.forward.as_vec3() - Vec3::Y).length() < 1e-6);
    assert!((camera.up.as_vec3() - Vec3::Z).length() < 1e-6);
}

#[test]
fn what_is_lacking_is_said() {
    let mut document = triangle();
    let positions = document["accessors"][0].clone();
    document["accessors"] = json!([positions, positions]);
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(1);
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_1"] = json!(1);
    document["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 0}]);
    document["meshes"][0]["primitives"][0]["material"] = json!(0);
    let glass = json!({"extensions": {"KHR_materials_transmission": {}, "KHR_materials_sheen": {}}, "alphaMode": "BLEND"});
    document["materials"] = json!([glass, glass, glass]);
    let mut second = document["meshes"][0]["primitives"][0].clone();
    second["material"] = json!(1);
    let mut points = triangle()["meshes"][0]["primitives"][0].clone();
    points["mode"] = json!(0);
    let first = document["meshes"][0]["primitives"][0].clone();
    document["meshes"][0]["primitives"] = json!([first, second, points]);
    document["animations"] =
        json!([{"channels": [{"sampler": 0, "target": {"path": "weights"}}], "samplers": []}]);
    let mut found = lacks(&load(&document).unwrap());
    found.sort();
    assert_eq!(
        found,
        [
            "1 animation of something that is no node is not played",
            "1 primitive of points or lines is left out",
            "2 morphed primitives are drawn at rest",
            "2 second sets of vertex colours are left out",
            "2 translucent materials are rendered opaque",
            "2 transmissive materials are rendered opaque",
            "2 uses of KHR_materials_sheen are left out",
        ]
    );
}

/// What moves and can't be played is said: tracks of a node with a matrix, channels that move no node.
#[test]
fn motion_that_is_not_played_is_said() {
    let times = floats(&[0., 1.]);
    let values = floats(&[0., 0., 0., 5., 0., 0.]);
    let mut document = document(&[
        ("POSITION", floats(&TRIANGLE), 5126, "VEC3", 3),
        ("times", times, 5126, "SCALAR", 2),
        ("values", values, 5126, "VEC3", 2),
    ]);
    document["meshes"][0]["primitives"][0]["attributes"] = json!({"POSITION": 0});
    let channel = json!({"sampler": 0, "target": {"node": 0, "path": "translation"}});
    let pointer = json!({"sampler": 0, "target": {"path": "pointer"}});
    let sampler = json!({"input": 1, "output": 2});
    document["animations"] = json!([{"channels": [channel, pointer], "samplers": [sampler]}]);
    let scene = load(&document).unwrap();
    assert_eq!(lacks(&scene), ["1 animation of something that is no node is not played"]);
    assert_eq!((scene.still_triangles, scene.motion.duration()), (0, 1.0), "the other channel is played");
    document["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1]);
    document["animations"][0]["channels"] = json!([channel]);
    let scene = load(&document).unwrap();
    assert_eq!(lacks(&scene), ["1 animation of a node that has a matrix is not played"]);
    assert_eq!((scene.still_triangles, scene.motion.duration()), (1, 0.0));
    assert_eq!(world(&scene)[0][0], Vec3::new(3.0, 0.0, 0.0));
}

/// Right by the specification, though unusual.
#[test]
fn unusual_documents() {
    let mut no_scenes = triangle();
    no_scenes.as_object_mut().unwrap().remove("scenes");
    assert_eq!(load(&no_scenes).unwrap().triangles.len(), 1);
    let mut no_nodes = triangle();
    no_nodes["scenes"] = json!([{}]);
    assert_eq!(load(&no_nodes).unwrap().triangles.len(), 0);
    let mut floats = triangle();
    floats["accessors"][0]["count"] = json!(3.0);
    assert_eq!(load(&floats).unwrap().triangles.len(), 1);
    let mut second = triangle();
    second["scenes"] = json!([{"nodes": []}, {"nodes": [0]}]);
    second["scene"] = json!(1);
    assert_eq!(load(&second).unwrap().triangles.len(), 1);
    let mut deep = triangle();
    let count = 100_000;
    let nodes: Vec<_> = (0..count)
        .map(|i| if i + 1 < count { json!({"children": [i + 1]}) } else { json!({"mesh": 0}) })
        .collect();
    deep["nodes"] = json!(nodes);
    assert_eq!(load(&deep).unwrap().triangles.len(), 1);
}
