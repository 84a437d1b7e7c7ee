//! What surfaces have beside positions: colours, tangents, images of metalness and roughness.

use crate::documents::{TRIANGLE, data_uri, document, floats, load};
use glam::{Vec3, Vec4};
use serde_json::json;
use std::io::Cursor;
use voxgi::scene::Scene;
use voxgi::scene::features::{Feature, features};

fn feature(scene: &Scene, name: &str) -> Feature {
    features(scene).into_iter().find(|(found, _)| *found == name).unwrap().1
}

#[test]
fn colours_of_every_kind() {
    let colors = [1.0, 0.0, 0.5, 0.25, 1.0, 0.0, 0.0, 0.75, 1.0];
    let fractions = |most: f64| colors.map(|c: f64| (c * most).round());
    let bytes: Vec<u8> = fractions(255.0).iter().map(|c| *c as u8).collect();
    let words: Vec<u8> = fractions(65535.0).iter().flat_map(|c| (*c as u16).to_le_bytes()).collect();
    let plain: Vec<u8> = floats(&colors.map(|c| c as f32));
    for (list, component) in [(bytes, 5121), (words, 5123), (plain, 5126)] {
        let mut document = document(&[
            ("POSITION", floats(&TRIANGLE), 5126, "VEC3", 3),
            ("COLOR_0", list, component, "VEC3", 3),
        ]);
        document["accessors"][1]["normalized"] = json!(component != 5126);
        let scene = load(&document).unwrap();
        for (extra, color) in scene.vertex_extras.iter().zip(colors.chunks_exact(3)) {
            let [r, g, b, a] = extra.unpacked_color();
            let off = [r, g, b].into_iter().zip(color).map(|(c, wanted)| (f64::from(c) - wanted).abs());
            assert!(off.fold(0.0, f64::max) < 0.003 && a == 1.0, "{component}: {r} {g} {b} {a}");
        }
        assert_eq!(feature(&scene, "scene.vertex_colors"), Feature::Flag(true));
    }
}

/// Alpha counts, what is beyond 1 does not; and white says nothing.
#[test]
fn colours_with_alpha_and_white_ones() {
    let coloured = |list: [f32; 12]| {
        load(&document(&[
            ("POSITION", floats(&TRIANGLE), 5126, "VEC3", 3),
            ("COLOR_0", floats(&list), 5126, "VEC4", 3),
        ]))
        .unwrap()
    };
    let scene = coloured([1., 1., 1., 0.5, 7., -1., 0.25, 1., 1., 1., 1., 1.]);
    let found: Vec<_> = scene.vertex_extras.iter().map(|extra| extra.unpacked_color()).collect();
    assert_eq!(found, [[1., 1., 1., 0.5], [1., 0., 0.25, 1.], [1.; 4]]);
    let white = coloured([1.0; 12]);
    assert!(white.vertex_extras.is_empty());
    assert_eq!(feature(&white, "scene.vertex_extras"), Feature::Flag(false));
}

#[test]
fn sparse_indices_and_stitched_strips() {
    let row: Vec<f32> = (0..5).flat_map(|i| [i as f32, (i % 2) as f32, 0.]).collect();
    let mut sparse = document(&[
        ("POSITION", floats(&row), 5126, "VEC3", 5),
        ("indices", vec![0, 1, 1], 5121, "SCALAR", 3),
        ("EXTRA", vec![2, 4], 5121, "SCALAR", 2),
    ]);
    let attributes = &mut sparse["meshes"][0]["primitives"][0]["attributes"];
    attributes.as_object_mut().unwrap().remove("EXTRA");
    // Element 2 becomes 4.
    sparse["accessors"][1]["sparse"] = json!({
        "count": 1, "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 2, "byteOffset": 1},
    });
    let scene = load(&sparse).unwrap();
    let xs = |scene: &Scene| -> Vec<[f32; 3]> {
        let x = |corner: u32| scene.vertices[corner as usize].position.x;
        scene.triangles.iter().map(|t| [x(t.a), x(t.b), x(t.c)]).collect()
    };
    assert_eq!(xs(&scene), [[0., 1., 4.]]);
    let mut strip = document(&[
        ("POSITION", floats(&row), 5126, "VEC3", 5),
        ("indices", vec![0, 1, 2, 2, 3, 3, 4, 1], 5121, "SCALAR", 8),
    ]);
    strip["meshes"][0]["primitives"][0]["mode"] = json!(5);
    // The windings go on alternating over the triangles that are none.
    assert_eq!(xs(&load(&strip).unwrap()), [[0., 1., 2.], [3., 1., 4.]]);
}

/// A grey of each channel as a 1 × 1 image.
fn texel(color: [u8; 4]) -> String {
    let mut png = Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_raw(1, 1, color.to_vec()).unwrap();
    picture.write_to(&mut png, image::ImageFormat::Png).unwrap();
    data_uri(&png.into_inner())
}

#[test]
fn bounds_of_roughness_count_images() {
    let uvs = floats(&[0., 0., 1., 0., 0., 1.]);
    let mut document =
        document(&[("POSITION", floats(&TRIANGLE), 5126, "VEC3", 3), ("TEXCOORD_0", uvs, 5126, "VEC2", 3)]);
    document["meshes"][0]["primitives"][0]["material"] = json!(0);
    document["images"] = json!([{"uri": texel([9, 51, 102, 255])}]);
    document["textures"] = json!([{"source": 0}]);
    document["materials"] = json!([{"pbrMetallicRoughness": {
        "roughnessFactor": 0.5, "metallicFactor": 0.25, "metallicRoughnessTexture": {"index": 0},
    }}]);
    let scene = load(&document).unwrap();
    let close = |name: &str, wanted: f64| match feature(&scene, name) {
        Feature::Number(found) => assert!((found - wanted).abs() < 1e-6, "{name}: {found}"),
        other => panic!("{other:?}"),
    };
    close("scene.min_roughness", 0.5 * 51.0 / 255.0);
    close("scene.max_metallic", 0.25 * 102.0 / 255.0);
    assert_eq!(feature(&scene, "scene.roughness_textured"), Feature::Flag(true));
    assert_eq!(feature(&scene, "scene.textured"), Feature::Flag(false));
}

/// u grows along +x, and v, which points down, along −y: the bitangent, up on the map, is +y.
#[test]
fn tangents_follow_the_coordinates() {
    let normals = floats(&[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    for (uvs, tangent) in [
        ([0., 1., 1., 1., 0., 0.], Vec4::new(1., 0., 0., 1.)),
        // Mirrored along u.
        ([1., 1., 0., 1., 1., 0.], Vec4::new(-1., 0., 0., -1.)),
    ] {
        let mut document = document(&[
            ("POSITION", floats(&TRIANGLE), 5126, "VEC3", 3),
            ("NORMAL", normals.clone(), 5126, "VEC3", 3),
            ("TEXCOORD_0", floats(&uvs), 5126, "VEC2", 3),
        ]);
        document["meshes"][0]["primitives"][0]["material"] = json!(0);
        document["images"] = json!([{"uri": texel([128, 128, 255, 255])}]);
        document["textures"] = json!([{"source": 0}]);
        document["materials"] = json!([{"normalTexture": {"index": 0}}]);
        let scene = load(&document).unwrap();
        assert_eq!(scene.vertices.len(), 3);
        for extra in &scene.vertex_extras {
            assert!((extra.tangent - tangent).length() < 1e-6, "{}", extra.tangent);
            let bitangent = extra.tangent.w * Vec3::Z.cross(extra.tangent.truncate());
            assert!((bitangent - Vec3::Y).length() < 1e-6);
        }
        assert_eq!(feature(&scene, "scene.normal_mapped"), Feature::Flag(true));
    }
}
