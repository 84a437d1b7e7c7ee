//! A sphere of albedo ½ around a point light of π W/sr, its radius 1 m: the light alone makes every point ½ bright, each
//! scattering adds half of what was there, all of it is exactly 1.
//!
//! The sphere is 8192 flat triangles whose area is 4π: then the mean over area of all light that arrives is that of the
//! sphere, for what 4π · π W the light sends is absorbed, half at a time. Triangles' middles are 0.1 % nearer to the light
//! than their corners, which bounds how far a mean over the picture, an even choice of directions, is off.

use super::shot::{Shot, mean};
use super::stage::{Stage, matt, point};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

const TESSELLATION: f64 = 1.5e-3;

/// Fronts inside, area 4π.
fn sphere() -> Vec<[Vec3; 3]> {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let mut triangles = Vec::new();
    for signs in 0..8 {
        let sign = |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let [a, b, c] = [x * sign(0), y * sign(1), z * sign(2)];
        triangles.push(if sign(0) * sign(1) * sign(2) > 0.0 { [a, c, b] } else { [a, b, c] });
    }
    for _ in 0..5 {
        let quarter = |[a, b, c]: [DVec3; 3]| {
            let [ab, bc, ca] = [a + b, b + c, c + a].map(DVec3::normalize);
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(quarter).collect();
    }
    let area: f64 = triangles.iter().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
    let scale = (4.0 * PI / area).sqrt();
    triangles.into_iter().map(|corners| corners.map(|p| (p * scale).as_vec3())).collect()
}

#[test]
fn a_sphere_around_a_point_light_is_exactly_1() {
    let scene = Stage::new()
        .surface(&sphere(), matt(Vec3::splat(0.5)))
        .light(point(Vec3::ZERO, Vec3::splat(PI as f32)))
        .seen_from(DVec3::new(0.1, 0.2, -0.1), DVec3::new(1.0, 0.3, 0.2));
    let found = Shot::of(&scene).take();
    for (output, truth) in [("color", 1.0), ("direct", 0.5), ("indirect", 0.5)] {
        let found = mean(&found, output);
        println!("{output}: {:.5} ± {:.5}", found.value.x, found.error.x);
        assert!(found.agrees_within(DVec3::splat(truth), TESSELLATION), "{output}: {found:?}");
        // Six scatterings in place of all.
        assert!(!found.agrees_within(DVec3::splat(truth * (1.0 - 1.0 / 64.0)), TESSELLATION), "{output}");
    }
}
