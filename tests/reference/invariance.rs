//! The Cornell box 10 km away, a thousand times as large, or mirrored, is the same picture.
//!
//! A thousand times as large, only the rounding of f32 differs: the samples are the same, and few paths part. 10 km away f32
//! places the camera and the middle of the scene within 1 mm, of half a metre: rims move by some hundredths of a pixel, and
//! with them single pixels; means of quarters of the picture by less than 1 %.

use super::files::Studio;
use super::shot::{Mean, Shot, mean_where};
use glam::DVec3;
use serde_json::json;
use voxgi::converge::Estimate;
use voxgi::scene::Scene;

const OUTPUTS: [&str; 4] = ["color", "direct", "indirect", "ambient_occlusion"];

fn shot(scene: &Scene) -> Estimate {
    Shot::of(scene).size([24, 24]).samples(128).take()
}

/// Means over the quarters of the picture; bit 0: right, bit 1: below.
fn quarters(found: &Estimate, output: &str) -> [Mean; 4] {
    [0, 1, 2, 3].map(|of| mean_where(found, output, |x, y| u32::from(x >= 12) + 2 * u32::from(y >= 12) == of))
}

/// Whether two independent means are of one thing, whose truths differ by `tolerance` at most, relative.
fn alike(one: &Mean, two: &Mean, tolerance: f64) -> bool {
    let error = (one.error * one.error + two.error * two.error).map(f64::sqrt);
    (one.value - two.value).abs().cmple(3.0 * error + tolerance * one.value).all()
}

#[test]
fn ten_kilometres_away_it_is_the_same() {
    let studio = Studio::new();
    let here = shot(&studio.placed("cornell-box", "here.glb", json!({})));
    let away = |z: f64| json!({ "translation": [10000.0, -10000.0, z] });
    let there = shot(&studio.placed("cornell-box", "there.glb", away(10000.0)));
    for output in OUTPUTS {
        let (here, there) = (quarters(&here, output), quarters(&there, output));
        println!("{output}: {:.4?}\n{:.4?}", here.map(|m| m.value), there.map(|m| m.value));
        assert!(here.iter().zip(&there).all(|(a, b)| alike(a, b, 0.01)), "{output}: {here:?} {there:?}");
    }
    // Quarters are not alike.
    let [first, .., last] = quarters(&here, "color");
    assert!(!alike(&first, &last, 0.01));
}

#[test]
fn a_thousand_times_as_large_it_is_the_same() {
    let studio = Studio::new();
    let small = shot(&studio.placed("cornell-box", "small.glb", json!({})));
    let large =
        shot(&studio.placed("cornell-box", "large.glb", json!({ "scale": [1000.0, 1000.0, 1000.0] })));
    for output in OUTPUTS {
        for (a, b) in quarters(&small, output).iter().zip(&quarters(&large, output)) {
            let apart = ((a.value - b.value) / a.value).abs().max_element();
            println!("{output}: {apart:.1e}");
            assert!(apart < 1e-3 && alike(a, b, 0.0), "{output}: {a:?} {b:?}");
        }
    }
    let [small, large] = [&small, &large].map(|found| {
        let depth = found.pictures["depth"].data();
        depth.iter().map(|d| f64::from(*d)).sum::<f64>()
    });
    assert!((large / small / 1000.0 - 1.0).abs() < 1e-4, "{small} {large}");
}

/// Left is right, and what is a front stays one, although the corners of triangles go around the other way.
#[test]
fn mirrored_it_is_the_mirror_image() {
    let studio = Studio::new();
    let plain = shot(&studio.placed("cornell-box", "plain.glb", json!({})));
    let mirrored = studio.edited("cornell-box", "mirrored.glb", |document| {
        for node in document["nodes"].as_array_mut().expect("nodes") {
            if node["camera"].is_null() {
                node["scale"] = json!([-1, 1, 1]);
            } else {
                node["translation"][0] = json!(-0.278);
            }
        }
    });
    let mirrored = shot(&mirrored);
    for output in OUTPUTS {
        let ([a, b, c, d], image) = (quarters(&plain, output), quarters(&mirrored, output));
        let swapped = [b, a, d, c];
        assert!(swapped.iter().zip(&image).all(|(a, b)| alike(a, b, 0.0)), "{output}: {swapped:?} {image:?}");
    }
    let [left, ..] = quarters(&plain, "indirect");
    let [image, ..] = quarters(&mirrored, "indirect");
    assert!(!alike(&left, &image, 0.0) && image.value.cmpgt(DVec3::ZERO).all());
}
