//! The Cornell box, from the data that the Cornell University Program of Computer Graphics published
//! (www.graphics.cornell.edu/online/box/data.html): geometry in millimetres, camera, measured reflectances and the
//! lamp's spectrum.
//!
//! Differences from the page: reflectances and emission are reduced to linear Rec. 709 (reflectances under D65,
//! emission as radiance over the CIE 1931 observer); the ceiling is four quads around the lamp, so that the lamp
//! lies in its plane without overlap.

use super::glb::Document;
use glam::DVec3;
use gltf::json::extensions::material::{EmissiveStrength, EmissiveStrengthFactor};
use gltf::json::extensions::scene::khr_lights_punctual::{KhrLightsPunctual, Light, Type};
use gltf::json::extensions::{material, scene};
use gltf::json::material::{EmissiveFactor, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf::json::validation::Checked::Valid;
use gltf::json::{self, Asset, Camera, Material, Node, camera};

/// What lights the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornellLight {
    /// The lamp's rectangle, as published.
    Area,
    /// A point light [`BELOW`] the middle of the rectangle, which is left dark. Its power is the lamp's: all
    /// directions together get what the lamp gives off.
    Point,
}

/// Distance of the point light from the lamp's plane, in millimetres.
pub const BELOW: f64 = 50.0;

const WHITE: [f32; 3] = [0.7385, 0.7358, 0.7400];
const GREEN: [f32; 3] = [0.0681, 0.3982, 0.0865];
const RED: [f32; 3] = [0.4937, 0.0490, 0.0512];
const LAMP: [f32; 3] = [0.78, 0.78, 0.78];
/// Radiance of the lamp: this colour times [`RADIANCE`] W/(sr·m²).
const EMISSION: [f32; 3] = [1.0, 0.5239, 0.1337];
const RADIANCE: f64 = 20.7286;

type Quad = [[f64; 3]; 4];

/// The lamp's rectangle in x and z, and the room's height.
const LAMP_X: [f64; 2] = [213.0, 343.0];
const LAMP_Z: [f64; 2] = [227.0, 332.0];
const HEIGHT: f64 = 548.8;

const FLOOR: Quad = [[552.8, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 559.2], [549.6, 0.0, 559.2]];
const BACK: Quad = [[549.6, 0.0, 559.2], [0.0, 0.0, 559.2], [0.0, HEIGHT, 559.2], [556.0, HEIGHT, 559.2]];
const RIGHT: Quad = [[0.0, 0.0, 559.2], [0.0, 0.0, 0.0], [0.0, HEIGHT, 0.0], [0.0, HEIGHT, 559.2]];
const LEFT: Quad = [[552.8, 0.0, 0.0], [549.6, 0.0, 559.2], [556.0, HEIGHT, 559.2], [556.0, HEIGHT, 0.0]];
const SHORT_TOP: Quad =
    [[130.0, 165.0, 65.0], [82.0, 165.0, 225.0], [240.0, 165.0, 272.0], [290.0, 165.0, 114.0]];
const TALL_TOP: Quad =
    [[423.0, 330.0, 247.0], [265.0, 330.0, 296.0], [314.0, 330.0, 456.0], [472.0, 330.0, 406.0]];

/// The box as a binary glTF file, in metres. It has a camera as published, named `cornell`.
pub fn cornell_box(light: CornellLight) -> Vec<u8> {
    let mut document = Document::default();
    document.root.asset = Asset {
        generator: Some("voxgi".to_owned()),
        copyright: Some(
            "Geometry and reflectances: data published by the Cornell University Program of Computer Graphics"
                .to_owned(),
        ),
        ..Asset::default()
    };
    let white = document.material(lambert("white", WHITE));
    let green = document.material(lambert("green", GREEN));
    let red = document.material(lambert("red", RED));
    let mut lamp = lambert("light", LAMP);
    if light == CornellLight::Area {
        lamp.emissive_factor = EmissiveFactor(EMISSION);
        let emissive_strength = EmissiveStrengthFactor(RADIANCE as f32);
        lamp.extensions = Some(material::Material {
            emissive_strength: Some(EmissiveStrength { emissive_strength }),
            ..Default::default()
        });
        document.root.extensions_used.push("KHR_materials_emissive_strength".to_owned());
    }
    let lamp = document.material(lamp);
    document.quads("floor", &[metres(FLOOR)], white);
    document.quads("ceiling", &ceiling().map(metres), white);
    document.quads("light", &[metres(overhead(LAMP_X, LAMP_Z))], lamp);
    document.quads("back_wall", &[metres(BACK)], white);
    document.quads("right_wall_green", &[metres(RIGHT)], green);
    document.quads("left_wall_red", &[metres(LEFT)], red);
    document.quads("short_block", &block(SHORT_TOP).map(metres), white);
    document.quads("tall_block", &block(TALL_TOP).map(metres), white);
    add_camera(&mut document);
    if light == CornellLight::Point {
        add_point_light(&mut document);
    }
    document.into_bytes()
}

fn lambert(name: &str, [r, g, b]: [f32; 3]) -> Material {
    Material {
        name: Some(name.to_owned()),
        pbr_metallic_roughness: PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor([r, g, b, 1.0]),
            metallic_factor: StrengthFactor(0.0),
            roughness_factor: StrengthFactor(1.0),
            ..Default::default()
        },
        ..Default::default()
    }
}

fn metres(quad: Quad) -> [DVec3; 4] {
    quad.map(|corner| DVec3::from_array(corner) * 1e-3)
}

/// A rectangle in the ceiling's plane that faces down.
fn overhead([x0, x1]: [f64; 2], [z0, z1]: [f64; 2]) -> Quad {
    [[x1, HEIGHT, z0], [x1, HEIGHT, z1], [x0, HEIGHT, z1], [x0, HEIGHT, z0]]
}

/// The ceiling with a hole for the lamp.
fn ceiling() -> [Quad; 4] {
    let (x, z) = ([0.0, 556.0], [0.0, 559.2]);
    [
        overhead(x, [z[0], LAMP_Z[0]]),
        overhead(x, [LAMP_Z[1], z[1]]),
        overhead([x[0], LAMP_X[0]], LAMP_Z),
        overhead([LAMP_X[1], x[1]], LAMP_Z),
    ]
}

/// The top of a block and its sides, straight down to the floor.
fn block(top: Quad) -> [Quad; 5] {
    let down = |[x, _, z]: [f64; 3]| [x, 0.0, z];
    let side = |i: usize| {
        let (a, b) = (top[i], top[(i + 1) % 4]);
        [a, down(a), down(b), b]
    };
    [top, side(0), side(1), side(2), side(3)]
}

/// At 278 273 −800, looking along +z: glTF's cameras look along −z, so the node is turned half round y.
fn add_camera(document: &mut Document) {
    // A film of 25 mm behind a focal length of 35 mm.
    let angle = 2.0 * (0.5f64 * 0.025 / 0.035).atan();
    let camera = document.root.push(Camera {
        name: Some("cornell".to_owned()),
        orthographic: None,
        perspective: Some(camera::Perspective {
            aspect_ratio: Some(1.0),
            yfov: angle as f32,
            zfar: Some(10.0),
            znear: 0.01,
            extensions: None,
            extras: None,
        }),
        type_: Valid(camera::Type::Perspective),
        extensions: None,
        extras: None,
    });
    document.root.push(Node {
        camera: Some(camera),
        name: Some("camera".to_owned()),
        translation: Some([0.278, 0.273, -0.8]),
        rotation: Some(json::scene::UnitQuaternion([0.0, 1.0, 0.0, 0.0])),
        ..Node::default()
    });
}

fn add_point_light(document: &mut Document) {
    let [width, depth] = [LAMP_X, LAMP_Z].map(|[low, high]| (high - low) * 1e-3);
    // The lamp gives off π L A, a point light 4 π I.
    let intensity = RADIANCE * width * depth / 4.0;
    let light = document.root.push(Light {
        color: EMISSION,
        extensions: None,
        extras: None,
        intensity: intensity as f32,
        name: Some("light".to_owned()),
        range: None,
        spot: None,
        type_: Valid(Type::Point),
    });
    let middle = |[low, high]: [f64; 2]| (low + high) * 0.5;
    let place = [middle(LAMP_X), HEIGHT - BELOW, middle(LAMP_Z)];
    document.root.push(Node {
        extensions: Some(scene::Node {
            khr_lights_punctual: Some(KhrLightsPunctual { light }),
            ..Default::default()
        }),
        name: Some("point_light".to_owned()),
        translation: Some(place.map(|x| (x * 1e-3) as f32)),
        ..Node::default()
    });
    document.root.extensions_used.push("KHR_lights_punctual".to_owned());
}
