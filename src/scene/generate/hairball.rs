//! A ball of hair: very many thin triangles that share their vertices, spread over the whole scene.
//!
//! Each strand begins on a sphere in the middle, outwards, and walks on in steps of equal length, along a direction
//! that turns smoothly by chance and away from the ball's surface. It is a ribbon, [`WIDTH`] wide: two triangles for a step.
//! Only operations that IEEE 754 rounds exactly are used, so that all machines make the same bytes.

use super::glb::{Corner, Document};
use fastrand::Rng;
use glam::DVec3;
use gltf::json::Material;

/// Ribbons.
pub const STRANDS: u32 = 2560;
/// Steps of a ribbon.
pub const STEPS: u32 = 200;
pub const TRIANGLES: u32 = 2 * STRANDS * STEPS;
/// Radius of the ball in metres: nothing is farther from the middle.
pub const RADIUS: f64 = 1.0;
/// Of a ribbon, in metres: each triangle is 25 times as long.
pub const WIDTH: f64 = 0.0008;
const STEP: f64 = 0.02;
/// Of the sphere on which strands begin, in metres.
const CORE: f64 = 0.3;
/// Where they begin to turn back, in metres from the middle.
const TURN: f64 = 0.85;
const SEED: u64 = 0x0068_6169_7262_616c;

/// The file.
pub fn make() -> Vec<u8> {
    let mut random = Rng::with_seed(SEED);
    let mut vertices = Vec::with_capacity((2 * STRANDS * (STEPS + 1)) as usize);
    let mut triangles = Vec::with_capacity(TRIANGLES as usize);
    for strand in 0..STRANDS {
        grow(&mut random, &mut vertices);
        let first = strand * 2 * (STEPS + 1);
        for a in (0..STEPS).map(|step| first + 2 * step) {
            triangles.extend([[a, a + 1, a + 2], [a + 2, a + 1, a + 3]]);
        }
    }
    let mut document = Document::default();
    document.root.asset.generator = Some("voxgi".to_owned());
    let material = document.material(Material::default());
    document.triangles("hair", &vertices, &triangles, material);
    document.into_bytes()
}

/// Adds the vertices of a strand: both edges of the ribbon at each end of each step.
fn grow(random: &mut Rng, vertices: &mut Vec<Corner>) {
    let mut direction = in_ball(random).normalize_or(DVec3::X);
    let mut place = direction * CORE;
    let mut side = direction.any_orthonormal_vector();
    let mut bend = DVec3::ZERO;
    for _ in 0..=STEPS {
        let normal = side.cross(direction).as_vec3();
        let edges = [0.5, -0.5].map(|half| place + side * (half * WIDTH));
        vertices.extend(edges.map(|edge| Corner { position: edge.as_vec3(), normal }));
        bend = 0.9 * bend + 0.1 * in_ball(random);
        let outside = (place.length() - TURN).max(0.0) / (RADIUS - TURN);
        direction = (direction + bend - place * outside).normalize_or(direction);
        place += STEP * direction;
        side = (side - direction * side.dot(direction)).normalize_or(direction.any_orthonormal_vector());
    }
}

/// Evenly spread over the ball of radius 1.
fn in_ball(random: &mut Rng) -> DVec3 {
    loop {
        let point = DVec3::from_array(std::array::from_fn(|_| 2.0 * random.f64() - 1.0));
        if point.length_squared() <= 1.0 {
            return point;
        }
    }
}
