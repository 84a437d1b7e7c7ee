//! A Lambert floor below lights of each kind, and below an emitting rectangle, point by point.

use super::flaws::flawed;
use super::shot::{Shot, mean, mean_where};
use super::stage::{Stage, directional, lamp, matt, point, quad, spot};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;
use voxgi::converge::Estimate;
use voxgi::scene::Scene;
use voxgi::scene::layout::{DOUBLE_SIDED, Light, Material};

const ALBEDO: DVec3 = DVec3::new(0.3, 0.5, 0.7);
/// The camera sees the square of twice that many metres a side, from half a metre above.
const HALF: f64 = 0.8;
const INTENSITY: DVec3 = DVec3::new(3.0, 2.0, 1.0);

/// A floor of 4 m a side at height 0.
fn floor() -> Stage {
    Stage::new().surface(&quad(Vec3::ZERO, Vec3::X * 2.0, -Vec3::Z * 2.0), matt(ALBEDO.as_vec3()))
}

fn seen(stage: Stage) -> Scene {
    stage.seen_along(DVec3::Y * 0.5, -DVec3::Y, HALF)
}

/// The mean over a quarter of the picture (bit 0: right, bit 1: below) of what points of the floor have.
fn quarter(of: usize, value: &dyn Fn(DVec3) -> f64) -> f64 {
    const STEPS: u32 = 128;
    let at = |i: u32, far: usize| (f64::from(i) + 0.5) / f64::from(STEPS) - if far == 0 { 1.0 } else { 0.0 };
    let points =
        (0..STEPS * STEPS).map(|i| DVec3::new(at(i % STEPS, of & 1), 0.0, at(i / STEPS, of >> 1)) * HALF);
    points.map(value).sum::<f64>() / f64::from(STEPS * STEPS)
}

/// Sees that each quarter has the irradiance that `truth` says, `color` apart, and not that of a mistake.
fn compare(
    found: &Estimate,
    color: DVec3,
    truth: &dyn Fn(DVec3) -> f64,
    mistakes: &[(&str, &dyn Fn(DVec3) -> f64)],
) {
    let size = found.pictures["direct"].width();
    for of in 0..4 {
        let chosen = |x: u32, y: u32| usize::from(x >= size / 2) + 2 * usize::from(y >= size / 2) == of;
        let radiance = |irradiance: &dyn Fn(DVec3) -> f64| ALBEDO / PI * color * quarter(of, irradiance);
        let wrong: Vec<_> = mistakes.iter().map(|(name, mistake)| (*name, radiance(mistake))).collect();
        mean_where(found, "direct", chosen).expect(&format!("quarter {of}"), radiance(truth), &wrong);
    }
}

fn below(light: Light) -> Estimate {
    Shot::of(&seen(floor().light(light))).samples(128).take()
}

#[test]
fn a_point_light_falls_off_with_the_squared_distance() {
    let place = DVec3::new(0.3, 1.0, -0.4);
    let cosine = |p: DVec3| place.y / p.distance(place);
    let found = below(point(place.as_vec3(), INTENSITY.as_vec3()));
    compare(
        &found,
        INTENSITY,
        &|p| cosine(p) / p.distance_squared(place),
        &[
            ("falls off with the distance", &|p| cosine(p) / p.distance(place)),
            ("no cosine", &|p| 1.0 / p.distance_squared(place)),
            ("albedo in place of albedo / π", &|p| PI * cosine(p) / p.distance_squared(place)),
            ("power in place of intensity", &|p| cosine(p) / (4.0 * PI * p.distance_squared(place))),
        ],
    );
}

#[test]
fn a_spot_has_the_published_cone() {
    let place = DVec3::new(0.2, 1.0, 0.1);
    let axis = DVec3::new(-0.2, -1.0, 0.1).normalize();
    let [inner, outer] = [15f64, 40.0].map(|angle| angle.to_radians().cos());
    let light = spot(place.as_vec3(), axis.as_vec3(), INTENSITY.as_vec3(), [15.0, 40.0]);
    let part =
        move |p: DVec3| (((p - place).normalize().dot(axis) - outer) / (inner - outer)).clamp(0.0, 1.0);
    let even = move |p: DVec3| place.y / p.distance(place).powi(3);
    compare(
        &below(light),
        INTENSITY,
        &|p| even(p) * part(p).powi(2),
        &[
            ("not squared", &|p| even(p) * part(p)),
            ("smooth in place of squared", &|p| even(p) * part(p).powi(2) * (3.0 - 2.0 * part(p))),
            ("a sharp rim", &|p| if part(p) > 0.0 { even(p) } else { 0.0 }),
        ],
    );
}

#[test]
fn a_directional_light_follows_the_cosine() {
    let direction = DVec3::new(1.0, -2.0, 0.5).normalize();
    let found = below(directional(direction.as_vec3(), INTENSITY.as_vec3()));
    compare(
        &found,
        INTENSITY,
        &|_| -direction.y,
        &[("no cosine", &|_| 1.0), ("no π", &|_| -direction.y * PI)],
    );
}

/// Lambert's formula: irradiance from a polygon of radiance 1, in order around `up`.
fn polygon(corners: &[DVec3], point: DVec3, up: DVec3) -> f64 {
    let to = |i: usize| (corners[i % corners.len()] - point).normalize();
    let edge = |i: usize| to(i).dot(to(i + 1)).acos() * to(i).cross(to(i + 1)).normalize().dot(up);
    (0..corners.len()).map(edge).sum::<f64>().abs() * 0.5
}

const MIDDLE: Vec3 = Vec3::new(0.2, 1.2, -0.3);
const SIDES: [Vec3; 2] = [Vec3::new(0.5, 0.2, 0.0), Vec3::new(0.0, -0.1, 0.4)];

/// A rectangle whose front is below.
fn rectangle() -> [[Vec3; 3]; 2] {
    quad(MIDDLE, SIDES[0], SIDES[1])
}

#[test]
fn an_emitting_rectangle_follows_lamberts_formula() {
    let scene = seen(floor().surface(&rectangle(), lamp(INTENSITY.as_vec3())));
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[r, u]| (MIDDLE + SIDES[0] * r + SIDES[1] * u).as_dvec3());
    let normal = SIDES[0].cross(SIDES[1]).as_dvec3();
    let toward = |p: DVec3| (p - MIDDLE.as_dvec3()).normalize();
    compare(
        &Shot::of(&scene).take(),
        INTENSITY,
        &|p| polygon(&corners, p, DVec3::Y),
        &[
            ("as far away as its middle", &|p| {
                let d = MIDDLE.as_dvec3() - p;
                4.0 * normal.dot(toward(p)).abs() * d.normalize().y / d.length_squared()
            }),
            ("no π in the albedo", &|p| PI * polygon(&corners, p, DVec3::Y)),
            ("one of its two triangles", &|p| polygon(&corners[..3], p, DVec3::Y)),
        ],
    );
}

/// Emission leaves the front only, unless the material is double-sided; seen or as light, both ways.
#[test]
fn emission_leaves_the_front() {
    let corners = rectangle().map(|[a, b, c]| [a, c, b]);
    let turned = Shot::of(&seen(floor().surface(&corners, lamp(INTENSITY.as_vec3())))).samples(128).take();
    assert_eq!(mean(&turned, "color").value, DVec3::ZERO);
    let both = Material { flags: DOUBLE_SIDED, ..lamp(INTENSITY.as_vec3()) };
    let front = Shot::of(&seen(floor().surface(&rectangle(), lamp(INTENSITY.as_vec3())))).take();
    let back = Shot::of(&seen(floor().surface(&corners, both))).take();
    let [front, back] = [front, back].map(|found| mean(&found, "direct"));
    let apart = (front.value - back.value).abs();
    assert!(apart.cmple(3.0 * (front.error + back.error)).all() && front.value.x > 0.0, "{front:?} {back:?}");
    for (material, truth) in [(both, INTENSITY), (lamp(INTENSITY.as_vec3()), DVec3::ZERO)] {
        let above = MIDDLE.as_dvec3() + DVec3::Y;
        let scene = Stage::new().surface(&rectangle(), material).seen_along(above, -DVec3::Y, 0.2);
        mean(&Shot::of(&scene).samples(128).take(), "color").expect("from above", truth, &[]);
    }
}

/// Two unit squares, 1 m apart: the share of one's light that arrives at the other.
fn form_factor() -> f64 {
    let root = 2f64.sqrt();
    let inner = (4.0 / 3.0f64).ln() * 0.5 + 2.0 * root * (1.0 / root).atan() - 2.0 * 1f64.atan();
    2.0 / PI * inner
}

#[test]
fn parallel_plates_have_their_form_factor() {
    let (x, z) = (Vec3::X * 0.5, Vec3::Z * 0.5);
    let scene = Stage::new()
        .surface(&quad(Vec3::ZERO, x, -z), matt(ALBEDO.as_vec3()))
        .surface(&quad(Vec3::Y, x, z), lamp(INTENSITY.as_vec3()))
        .seen_along(DVec3::Y * 0.5, -DVec3::Y, 0.5);
    let radiance = |factor: f64| ALBEDO * INTENSITY * factor;
    let mistakes = [
        ("plates without end", radiance(1.0)),
        ("as from middle to middle", radiance(1.0 / PI)),
        ("no π in the albedo", radiance(PI * form_factor())),
    ];
    let found = Shot::of(&scene).take();
    mean(&found, "color").expect("plates", radiance(form_factor()), &mistakes);
    assert_eq!(mean(&found, "indirect").value, DVec3::ZERO, "the lamp reflects nothing");
}

/// A choice among so many emitters leaves few bits of a random number: one of them must not suffer for it.
#[test]
fn a_light_among_many_emitters_keeps_its_share() {
    const SIDE: u16 = 256;
    let at = |i: u16| f32::from(i) / f32::from(SIDE) - 0.5;
    // Below the floor, and facing down.
    let lamps = (0..SIDE).flat_map(|x| {
        (0..SIDE).map(move |z| {
            let a = Vec3::new(at(x), -0.5, at(z));
            [a, a + Vec3::X * 0.003, a + Vec3::Z * 0.003]
        })
    });
    let below = lamp(Vec3::splat(40.0));
    let stage = floor().light(directional(Vec3::NEG_Y, Vec3::ONE));
    let scene = seen(stage.surface(&lamps.collect::<Vec<_>>(), below));
    let shot = Shot::of(&scene).set("max_scatterings", 1);
    mean(&shot.take(), "color").expect("one of many", ALBEDO / PI, &[]);
    let coarse = flawed(
        "lib/emitters",
        "let rest = unit_of(column.y);",
        "let rest = floor(unit_of(column.y) * 256.0) / 256.0;",
    );
    let found = mean(&shot.by(&coarse.library).take(), "color");
    assert!(!found.agrees(ALBEDO / PI), "8 bits for the share: {found:?}");
}
