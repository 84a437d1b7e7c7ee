//! Light from far away: what is seen behind the scene, and what it brings to a surface.

use super::program::{SIZE, color, pixels, render};
use super::scenes::Studio;
use glam::DVec3;
use image::{ImageFormat, Rgb32FImage};
use std::f64::consts::PI;
use std::path::PathBuf;
use voxgi::picture::Picture;
use voxgi::scene;

const WIDTH: u32 = 16;
const HEIGHT: u32 = 8;

/// A triangle of 2 m in the plane y = 0, seen from above.
const FLOOR: [[f32; 3]; 3] = [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
const CAMERA: &str =
    r#"cameras: [(name: "above", eye: (0, 1.2, 2), look_at: (-0.3, 0, 0.2), fov_degrees: 80)]"#;

/// Radiance of a texel of the test picture: all of them differ.
fn texel(x: u32, y: u32) -> [f32; 3] {
    [0.25 + 0.5 * x as f32, 1.0 + 0.25 * y as f32, 0.125 * (x ^ y) as f32]
}

fn setting(studio: &Studio, name: &str, environment: &str) -> PathBuf {
    studio.triangles(&[FLOOR]);
    let picture = Rgb32FImage::from_fn(WIDTH, HEIGHT, |x, y| image::Rgb(texel(x, y)));
    let file = studio.path("sky.exr");
    picture.save_with_format(file, ImageFormat::OpenExr).expect("the sky can be written");
    studio.setting(name, &format!("gltf: \"triangles.glb\", {CAMERA}, environment: {environment}"))
}

/// The test picture in a direction, between its texels as bilinear filters are defined.
fn sky(direction: DVec3, turn: f64) -> DVec3 {
    let around = direction.x.atan2(-direction.z) - turn;
    let u = (around / (2.0 * PI) + 0.5).rem_euclid(1.0) * f64::from(WIDTH) - 0.5;
    let v = (direction.y.acos() / PI * f64::from(HEIGHT) - 0.5).clamp(0.0, f64::from(HEIGHT - 1));
    let at = |x: f64, y: f64| {
        let x = x.rem_euclid(f64::from(WIDTH)) as u32;
        DVec3::from(texel(x, (y as u32).min(HEIGHT - 1)).map(f64::from))
    };
    let (x, y) = (u.floor(), v.floor());
    let row = |y: f64| at(x, y).lerp(at(x + 1.0, y), u - x);
    row(y).lerp(row(y + 1.0), v - y)
}

/// Of the surface in a pixel; 0 for none.
fn distance(depth: &Picture, [x, y]: [u32; 2]) -> f32 {
    depth.texel(x, y).expect("the pixel lies in the picture")[0]
}

/// The largest difference, relative, between what is seen where there is no surface and `sky` in that direction.
fn behind(scene: &std::path::Path, picture: &Picture, depth: &Picture, turn: f64) -> f64 {
    let camera = &scene::load(scene).expect("the scene").cameras[0];
    let half = camera.lens.half_height();
    let mut worst = 0.0_f64;
    let mut seen = 0;
    for pixel in pixels().filter(|pixel| distance(depth, *pixel) == 0.0) {
        let [x, y] = pixel.map(|i| (2.0 * f64::from(i) + 1.0) / f64::from(SIZE) - 1.0);
        let direction = camera.forward + half * (x * camera.right - y * camera.up);
        let expected = sky(direction.normalize(), turn);
        worst = worst.max((color(picture, pixel) - expected).length() / expected.length());
        seen += 1;
    }
    assert!(seen > 500, "{seen} pixels show no surface");
    worst
}

#[test]
fn the_sky_behind_the_scene() {
    let studio = Studio::new();
    let options = "--set resolution=16 --set bounces=1";
    for (degrees, name) in [(0.0, "straight"), (50.0, "turned")] {
        let turned = format!("Picture(file: \"sky.exr\", turn_degrees: {degrees})");
        let scene = setting(&studio, name, &turned);
        let [direct, depth] = render(&scene, "cones", options, ["direct", "depth"]);
        let worst = behind(&scene, &direct, &depth, f64::to_radians(degrees));
        let wrong = behind(&scene, &direct, &depth, f64::to_radians(degrees + 5.0));
        println!("{name}: {worst:.6}, turned by 5° more {wrong:.6}");
        assert!(worst < 1e-4, "{worst}");
        assert!(wrong > 1e-2, "{wrong}");
    }
}

/// A plain under a sky of radiance 1 has the radiance of its albedo, ρ/π · π; nothing is left to be scattered twice.
#[test]
fn an_open_plain_under_an_even_sky() {
    let studio = Studio::new();
    let scene = setting(&studio, "even", "Constant(radiance: (1, 1, 1))");
    for hemisphere in ["hemisphere/six", "hemisphere/spiral"] {
        let options = format!("--set resolution=32 --set bounces=1 --part hemisphere={hemisphere}");
        let [direct, indirect, albedo, depth] =
            render(&scene, "cones", &options, ["direct", "indirect", "albedo", "depth"]);
        let on_it = pixels().filter(|pixel| distance(&depth, *pixel) > 0.0);
        let lit: Vec<[f64; 2]> = on_it
            .map(|p| [color(&direct, p).x / color(&albedo, p).x, color(&indirect, p).x / color(&albedo, p).x])
            .collect();
        let of = |i: usize, f: fn(f64, f64) -> f64, start: f64| lit.iter().map(|l| l[i]).fold(start, f);
        let (least, most) = (of(0, f64::min, f64::MAX), of(0, f64::max, 0.0));
        println!(
            "{hemisphere}: {} pixels, {least:.4} to {most:.4} of the albedo; indirect {:.4}",
            lit.len(),
            of(1, f64::max, 0.0)
        );
        assert!(lit.len() > 400);
        assert!(least > 0.97 && most <= 1.0 + 1e-5, "{least} to {most}");
        assert!(of(1, f64::max, 0.0) < 0.01);
    }
}
