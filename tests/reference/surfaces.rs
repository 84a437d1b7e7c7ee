//! Images on surfaces: holes for rays of all kinds, texels at their full size, normals.
//!
//! Everything lies on a sheet of 2 m a side with an image of 2 × 1 texels, not interpolated: a left half and a right half.

use super::shot::{Mean, Shot, mean_where};
use super::stage::{Stage, directional, lamp, matt, quad};
use glam::{DVec3, UVec4, Vec3};
use std::f64::consts::PI;
use voxgi::converge::Estimate;
use voxgi::scene::layout::Material;

type Texel = [u8; 4];

/// The image that [`Stage::imaged`] adds, as a material refers to it: one level, repeated, not interpolated.
fn image(srgb: bool) -> UVec4 {
    UVec4::new(0, 2, 1, 1 << 4 | u32::from(srgb) << 5 | 1 << 8)
}

/// A sheet at this height; the front is above.
fn sheet(height: f32) -> [[Vec3; 3]; 2] {
    quad(Vec3::Y * height, Vec3::X, -Vec3::Z)
}

/// The mean over a half of the picture.
fn half(found: &Estimate, output: &str, right: bool) -> Mean {
    let width = found.pictures[output].width();
    mean_where(found, output, |x, _| (x >= width / 2) == right)
}

/// From this height, straight down on the square of 1 m around the origin.
fn from_above(stage: Stage, height: f64) -> Estimate {
    Shot::of(&stage.seen_along(DVec3::Y * height, -DVec3::Y, 0.5)).take()
}

const HOLE: Texel = [255, 255, 255, 100];
const SOLID: Texel = [255, 255, 255, 150];

/// Holes are where alpha is less than ½.
fn masked(material: Material) -> Material {
    Material { base_color_image: image(true), alpha_cutoff: 0.5, ..material }
}

fn white() -> Material {
    matt(Vec3::ONE)
}

/// A sheet whose left half is a hole, over a floor, below the sun.
#[test]
fn a_hole_is_none_for_any_ray() {
    let grey = DVec3::new(0.2, 0.4, 0.6);
    let stage = || {
        Stage::new()
            .surface(&quad(Vec3::ZERO, Vec3::X, -Vec3::Z), matt(grey.as_vec3()))
            .imaged(&sheet(1.0), masked(white()), [HOLE, SOLID])
            .light(directional(-Vec3::Y, Vec3::splat(PI as f32)))
    };
    // Below the sheet, shadow rays alone meet it; above it, the camera's do too.
    let (below, above) = (from_above(stage(), 0.5), from_above(stage(), 2.0));
    half(&below, "direct", false).expect("lit through the hole", grey, &[("in its shadow", DVec3::ZERO)]);
    half(&below, "direct", true).expect("in its shadow", DVec3::ZERO, &[("lit", grey)]);
    half(&above, "direct", false).expect("seen through the hole", grey, &[("the sheet", DVec3::ONE)]);
    half(&above, "direct", true).expect("the sheet", DVec3::ONE, &[("the floor", grey)]);
}

/// A sheet emits where it is, not where its holes are: light chosen there comes from nowhere.
#[test]
fn holes_do_not_emit() {
    let radiance = DVec3::new(3.0, 2.0, 1.0);
    let down = sheet(1.0).map(|[a, b, c]| [a, c, b]);
    let floor = || Stage::new().surface(&quad(Vec3::ZERO, Vec3::X, -Vec3::Z), matt(Vec3::splat(0.5)));
    let found = from_above(floor().imaged(&down, masked(lamp(radiance.as_vec3())), [HOLE, SOLID]), 0.5);
    // The solid half alone, without an image.
    let solid = quad(Vec3::new(0.5, 1.0, 0.0), Vec3::X * 0.5, Vec3::Z);
    let truth = from_above(floor().surface(&solid, lamp(radiance.as_vec3())), 0.5);
    let whole = from_above(floor().surface(&down, lamp(radiance.as_vec3())), 0.5);
    for right in [false, true] {
        let [found, truth, whole] = [&found, &truth, &whole].map(|found| half(found, "direct", right));
        let error = (found.error * found.error + truth.error * truth.error).map(f64::sqrt);
        println!("{:.4} ± {:.4}, to be {:.4}", found.value, found.error, truth.value);
        assert!((found.value - truth.value).abs().cmple(3.0 * error).all(), "{found:?} {truth:?}");
        assert!(
            (found.value - whole.value).abs().cmpgt(3.0 * (error + whole.error)).any(),
            "{found:?} {whole:?}"
        );
    }
}

/// Stored colours are sRGB-coded; each half of the picture has a texel's own colour, no mean of both.
#[test]
fn texels_are_seen_at_their_full_size() {
    let texels = [[188, 64, 10, 255], [255, 128, 30, 255]];
    let material = Material { base_color_image: image(true), ..white() };
    let stage = Stage::new()
        .imaged(&sheet(0.0), material, texels)
        .light(directional(-Vec3::Y, Vec3::splat(PI as f32)));
    let found = from_above(stage, 1.0);
    // IEC 61966-2-1.
    let decoded = |code: u8| match f64::from(code) / 255.0 {
        low if low <= 0.04045 => low / 12.92,
        high => ((high + 0.055) / 1.055).powf(2.4),
    };
    let color = |[r, g, b, _]: Texel, of: fn(&dyn Fn(u8) -> f64, u8) -> f64| {
        DVec3::from_array([r, g, b].map(|code| of(&decoded, code)))
    };
    let linear = |_: &dyn Fn(u8) -> f64, code: u8| f64::from(code) / 255.0;
    let truths = texels.map(|texel| color(texel, |decoded, code| decoded(code)));
    for right in [false, true] {
        let [own, other] = if right { [truths[1], truths[0]] } else { truths };
        let mistakes = [
            ("the mean of both texels", (own + other) / 2.0),
            ("not decoded", color(texels[usize::from(right)], linear)),
        ];
        half(&found, "direct", right).expect("a texel", own, &mistakes);
    }
}

/// A map tilts the normal along the tangent, to x on the left and away from it on the right.
#[test]
fn mapped_normals_shade() {
    let texels = [[200, 160, 220, 255], [55, 160, 220, 255]];
    let material = Material { normal_image: image(false), ..white() };
    let light = DVec3::new(0.5, 1.0, 0.2).normalize();
    let stage = Stage::new()
        .imaged(&sheet(0.0), material, texels)
        .light(directional(-light.as_vec3(), Vec3::splat(PI as f32)));
    let found = from_above(stage, 1.0);
    // Tangent x, bitangent normal × tangent = −z, normal y.
    let normal = |[x, y, z, _]: Texel| {
        let [x, y, z] = [x, y, z].map(|code| 2.0 * f64::from(code) / 255.0 - 1.0);
        DVec3::new(x, z, -y).normalize()
    };
    for right in [false, true] {
        let own = normal(texels[usize::from(right)]);
        let shade = |normal: DVec3| DVec3::splat(normal.dot(light).max(0.0));
        let mistakes = [
            ("the plane's normal", shade(DVec3::Y)),
            ("the other way", shade(own * DVec3::new(-1.0, 1.0, 1.0))),
            ("bitangent turned around", shade(own * DVec3::new(1.0, 1.0, -1.0))),
        ];
        half(&found, "direct", right).expect("a tilted normal", shade(own), &mistakes);
    }
}
