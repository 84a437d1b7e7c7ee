//! Light from the environment: a Lambert surface in it, and what the camera sees of it, against sums over all
//! directions in
//! double precision.

use super::flaws::flawed;
use super::shot::{Mean, Shot, mean};
use super::stage::{Stage, matt, quad};
use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};
use voxgi::picture::{Picture, write_exr};
use voxgi::scene::Scene;
use voxgi::scene::environment::Environment;

const ALBEDO: DVec3 = DVec3::new(0.3, 0.5, 0.7);
const WIDTH: usize = 16;
const HEIGHT: usize = 8;
const TURN: f64 = 0.7;

/// A surface that faces `normal`, seen along it.
fn facing(normal: DVec3) -> Scene {
    let right = normal.any_orthonormal_vector();
    let up = normal.cross(right);
    Stage::new()
        .surface(&quad(Vec3::ZERO, right.as_vec3(), up.as_vec3()), matt(ALBEDO.as_vec3()))
        .seen_along(normal, -normal, 0.5)
}

#[test]
fn an_even_sky_gives_a_surface_its_albedo() {
    let radiance = DVec3::new(2.0, 1.0, 0.5);
    let mut scene = facing(DVec3::new(0.6, 0.5, -0.6).normalize());
    scene.environment = Some(Environment::constant(radiance.as_vec3()).expect("an environment"));
    let mistakes = [("times π", ALBEDO * radiance * PI), ("half of the sky", ALBEDO * radiance * 0.5)];
    mean(&Shot::of(&scene).take(), "color").expect("an even sky", ALBEDO * radiance, &mistakes);
}

/// Radiances by row and column: unlike in every direction, and one that outshines the others.
fn texel(row: usize, column: usize) -> DVec3 {
    let wave = |k: f64| 1.0 + (k * column as f64 + 0.9 * row as f64).sin();
    let sun = if (row, column) == (2, 5) { 40.0 } else { 0.0 };
    DVec3::new(wave(1.3) + sun, wave(0.7) * row as f64 / 4.0 + sun, wave(2.1) + 0.5 * sun)
}

fn sky() -> Environment {
    pictured(texel)
}

fn pictured(texel: Texels) -> Environment {
    let texels = (0..WIDTH * HEIGHT).flat_map(|i| texel(i / WIDTH, i % WIDTH).as_vec3().to_array());
    let picture = Picture::new(WIDTH as u32, HEIGHT as u32, 3, texels.collect()).expect("a picture");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sky.exr");
    write_exr(&path, &[("", &picture)]).expect("a file");
    let mut sky = Environment::read(&path, 1.0).expect("an environment");
    sky.turn = TURN as f32;
    sky
}

/// Of a row and a column.
type Texels = fn(usize, usize) -> DVec3;

/// Bilinear between the middles of texels; around the horizon, not over the poles.
fn radiance(texel: Texels, direction: DVec3, turn: f64) -> DVec3 {
    let around = (direction.x.atan2(-direction.z) - turn) / TAU + 0.5;
    let column = around.rem_euclid(1.0) * WIDTH as f64 - 0.5;
    let row = direction.y.clamp(-1.0, 1.0).acos() / PI * HEIGHT as f64 - 0.5;
    let part = |dy: f64, dx: f64| {
        let [y, x] = [row.floor() + dy, column.floor() + dx];
        let weight = (1.0 - (row - y).abs()) * (1.0 - (column - x).abs());
        texel(y.clamp(0.0, HEIGHT as f64 - 1.0) as usize, x.rem_euclid(WIDTH as f64) as usize) * weight
    };
    part(0.0, 0.0) + part(0.0, 1.0) + part(1.0, 0.0) + part(1.0, 1.0)
}

/// The sky's light on a surface that faces `normal`.
fn irradiance(texel: Texels, normal: DVec3, turn: f64) -> DVec3 {
    const STEPS: usize = 800;
    let step = PI / STEPS as f64;
    let mut sum = DVec3::ZERO;
    for down in (0..STEPS).map(|i| (i as f64 + 0.5) * step) {
        for around in (0..2 * STEPS).map(|i| (i as f64 + 0.5) * step) {
            let direction = DVec3::new(down.sin() * around.sin(), down.cos(), -down.sin() * around.cos());
            sum += radiance(texel, direction, turn) * normal.dot(direction).max(0.0) * down.sin();
        }
    }
    sum * step * step
}

#[test]
fn a_pictured_sky_lights_as_it_is() {
    let normal = DVec3::new(0.6, 0.3, -0.7).normalize();
    let mut scene = facing(normal);
    scene.environment = Some(sky());
    let truth = |normal, turn| ALBEDO / PI * irradiance(texel, normal, turn);
    let mistakes = [
        ("not turned", truth(normal, 0.0)),
        ("turned the other way", truth(normal, -TURN)),
        ("upside down", truth(normal * DVec3::new(1.0, -1.0, 1.0), TURN)),
    ];
    let right = truth(normal, TURN);
    mean(&Shot::of(&scene).take(), "color").expect("a pictured sky", right, &mistakes);
    let wrong =
        flawed("lib/environment_choice", "probability / solid_angle", "probability / (4.0 * PI) * 128.0");
    let found = mean(&Shot::of(&scene).by(&wrong.library).take(), "color");
    assert!(!found.agrees(right), "texels of the same solid angle: {found:?}");
}

fn sun(row: usize, column: usize) -> DVec3 {
    DVec3::splat(if (row, column) == (3, 9) { 1e5 } else { 0.1 })
}

/// Chosen by what texels are themselves: running sums along each row, then over the rows by solid angle.
fn chosen_by_itself(sky: &mut Environment, texel: Texels) {
    let angle = |row: usize| (row as f64 / HEIGHT as f64 * PI).cos();
    let first_row = sky.first_row();
    let (mut above, mut rows) = (0.0, Vec::new());
    for row in 0..HEIGHT {
        let mut sum = 0.0;
        let sums: Vec<f64> = (0..WIDTH)
            .map(|column| {
                sum += texel(row, column).y;
                sum
            })
            .collect();
        for (column, so_far) in sums.into_iter().enumerate() {
            sky.texels[row * WIDTH + column].w = (so_far / sum) as f32;
        }
        above += sum * (angle(row) - angle(row + 1));
        rows.push(above);
    }
    for (row, so_far) in rows.into_iter().enumerate() {
        sky.texels[first_row + row].x = (so_far / above) as f32;
    }
}

/// What a texel is, lies in its neighbours too: where these are not chosen for it, its light comes as rare sparks.
#[test]
fn a_small_sun_is_no_noise() {
    let normal = DVec3::new(0.6, 0.3, -0.7).normalize();
    let right = ALBEDO / PI * irradiance(sun, normal, TURN);
    let mut scene = facing(normal);
    scene.environment = Some(pictured(sun));
    let taken = |scene: &Scene| mean(&Shot::of(scene).set("max_scatterings", 1).take(), "color");
    let calm = |found: &Mean| found.error.x < 1.5e-3 * right.x;
    let found = taken(&scene);
    println!("{found:?}, to be {right:?}");
    assert!(found.agrees(right) && calm(&found), "{found:?} {right:?}");
    chosen_by_itself(scene.environment.as_mut().expect("a sky"), sun);
    let found = taken(&scene);
    println!("chosen by itself: {found:?}");
    assert!(!calm(&found), "{found:?}");
}

/// A scene without a triangle.
#[test]
fn the_camera_sees_the_sky() {
    let mut scene = Stage::new().seen_from(DVec3::ZERO, DVec3::new(0.4, 0.1, -0.9));
    scene.environment = Some(sky());
    let camera = scene.cameras[0].clone();
    let seen = |turn: f64| -> DVec3 {
        let at = |i: usize| (i as f64 + 0.5) / 128.0 - 1.0;
        let ray = |i: usize| camera.forward + at(i % 256) * camera.right - at(i / 256) * camera.up;
        (0..256 * 256).map(|i| radiance(texel, ray(i).normalize(), turn)).sum::<DVec3>() / 65536.0
    };
    let mistakes = [("not turned", seen(0.0)), ("turned the other way", seen(-TURN))];
    let found = Shot::of(&scene).take();
    let direct = mean(&found, "direct");
    // The sum over 256² directions has an error of its own.
    assert!(direct.agrees_within(seen(TURN), 1e-3), "{direct:?} {:?}", seen(TURN));
    assert!(mistakes.iter().all(|(_, wrong)| !direct.agrees_within(*wrong, 1e-3)), "{direct:?} {mistakes:?}");
    assert_eq!(mean(&found, "ambient_occlusion").value, DVec3::ONE);
}
