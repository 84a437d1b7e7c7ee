//! Are the standard errors right? Runs with other seeds differ as the variances say, over pixels and as whole pictures; errors
//! fall with the number of samples; the same seed gives the same bits, however the samples are spread over frames.
//!
//! On the Cornell box in few pixels, and where tails would take too many runs to tell, on a room with a large lamp.

use super::flaws::flawed;
use super::shot::{Shot, mean};
use super::stage::{self, Stage, matt, quad, room};
use glam::{DVec3, Vec3};
use std::path::Path;
use voxgi::converge::Estimate;
use voxgi::scene::environment::Environment;
use voxgi::scene::{self, Scene};

const SEEDS: u64 = 16;

fn cornell() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box.glb");
    scene::load(&path).expect("a scene of this repository")
}

/// Grey walls of 2 m, and a lamp of 1.2 m below the ceiling, out of sight: no sample is much brighter than others, and no pixel
/// has most of the noise, as it has at the rim of what is bright.
fn tame() -> Scene {
    let lamp = quad(Vec3::Y * 0.8, Vec3::X * 0.6, Vec3::Z * 0.6);
    Stage::new()
        .surface(&room(), matt(Vec3::splat(0.5)))
        .surface(&lamp, stage::lamp(Vec3::ONE))
        .seen_from(DVec3::new(0.0, -0.5, 0.8), DVec3::new(0.1, -0.8, -1.0))
}

fn shot(scene: &Scene, batch: u64, samples: u64) -> Shot<'_> {
    Shot::of(scene).size([12, 12]).set("batch", batch).samples(samples)
}

fn seeds(shot: &Shot<'_>) -> Vec<Estimate> {
    (0..SEEDS).map(|seed| shot.clone().set("seed", 100 + seed).take()).collect()
}

/// By pixel, in one channel: the variance over runs, and the mean of the variances that the runs say they have.
fn variances(runs: &[Estimate], output: &str) -> Vec<[f64; 2]> {
    let of = |name: &str| -> Vec<Vec<f64>> {
        let picture = |run: &Estimate| {
            let picture = &run.pictures[name];
            let channel = if picture.channels() == 1 { 0 } else { 1 };
            picture.texels().map(|texel| f64::from(texel[channel])).collect()
        };
        runs.iter().map(picture).collect()
    };
    let (means, said) = (of(output), of(&format!("{output}_variance")));
    let count = runs.len() as f64;
    let pixel = |p: usize| {
        let mean = means.iter().map(|run| run[p]).sum::<f64>() / count;
        let spread = means.iter().map(|run| (run[p] - mean).powi(2)).sum::<f64>() / (count - 1.0);
        [spread, said.iter().map(|run| run[p]).sum::<f64>() / count]
    };
    (0..means[0].len()).map(pixel).collect()
}

/// The quotient of the sums of both, with its standard error: pixels are independent.
fn quotient(pixels: &[[f64; 2]]) -> [f64; 2] {
    let sum = |i: usize| pixels.iter().map(|p| p[i]).sum::<f64>();
    let quotient = sum(0) / sum(1);
    let squares = pixels.iter().map(|p| (p[0] - quotient * p[1]).powi(2)).sum::<f64>();
    [quotient, squares.sqrt() / sum(1)]
}

/// 99.8 % of sums of 15 squared normal deviates lie between these.
const CHI_SQUARE: std::ops::Range<f64> = 3.48..37.7;

/// The variance of the picture's mean over runs, in units of what the runs say, times the degrees of freedom.
fn chi_square(runs: &[Estimate], output: &str) -> f64 {
    let means: Vec<_> = runs.iter().map(|run| mean(run, output)).collect();
    let count = means.len() as f64;
    let center = means.iter().map(|m| m.value.y).sum::<f64>() / count;
    let squares: f64 = means.iter().map(|m| (m.value.y - center).powi(2)).sum();
    squares / (means.iter().map(|m| m.error.y.powi(2)).sum::<f64>() / count)
}

fn variances_are_what_runs_differ_by(batch: u64, batches: u64) {
    let scene = tame();
    let runs = seeds(&shot(&scene, batch, batch * batches).set("ao_distance", 1.0));
    for output in ["color", "direct", "indirect", "ambient_occlusion"] {
        let [quotient, error] = quotient(&variances(&runs, output));
        let chi_square = chi_square(&runs, output);
        println!("{batch} × {batches} {output}: {quotient:.3} ± {error:.3}; {chi_square:.1} of 15");
        assert!((quotient - 1.0).abs() < 3.0 * error, "{output}: {quotient} ± {error}");
        // Divided by the number of batches, not by one less.
        let biased = batches as f64 / (batches as f64 - 1.0);
        assert!((quotient * biased - 1.0).abs() > 3.0 * error * biased, "{output}: {quotient} ± {error}");
        assert!(CHI_SQUARE.contains(&chi_square), "{output}: {chi_square}");
    }
}

#[test]
fn variances_of_small_batches_are_right() {
    variances_are_what_runs_differ_by(16, 4);
}

#[test]
fn variances_of_large_batches_are_right() {
    variances_are_what_runs_differ_by(64, 3);
}

/// Were pixels not independent, sums over them would differ by more: seen where all pixels have the same light.
#[test]
fn pixels_that_share_their_randomness_are_noticed() {
    let floor = Stage::new().surface(&quad(Vec3::ZERO, Vec3::X, -Vec3::Z), matt(Vec3::ONE));
    let mut scene = floor.seen_along(DVec3::Y, -DVec3::Y, 0.5);
    scene.environment = Some(Environment::constant(Vec3::ONE).expect("an environment"));
    let shot = shot(&scene, 16, 64).size([8, 8]);
    let honest = chi_square(&seeds(&shot), "color");
    let flawed = flawed("paths/trace", "hash_2(pixel.x, pixel.y)", "7u");
    let shared = chi_square(&seeds(&shot.by(&flawed.library)), "color");
    println!("{honest:.1} of 15; of pixels that share their randomness {shared:.1}");
    assert!(CHI_SQUARE.contains(&honest) && shared > CHI_SQUARE.end, "{honest} {shared}");
}

/// Four times the samples halve the error, or better.
#[test]
fn errors_fall_with_the_number_of_samples() {
    let scene = tame();
    let spread = |batch: u64, samples: u64| {
        let shot = shot(&scene, batch, samples).size([16, 16]);
        let runs: Vec<_> = (0..4).map(|seed| shot.clone().set("seed", seed).take()).collect();
        variances(&runs, "color").iter().map(|p| p[0]).sum::<f64>().sqrt()
    };
    let [few, twice, many] = [32, 64, 128].map(|samples| spread(16, samples));
    println!("errors {few:.4}, {twice:.4}, {many:.4}");
    assert!(many / few < 0.55, "{few} {many}");
    assert!(twice / few > 0.55, "no control: {few} {twice}");
    // Samples of a batch are spread better than by chance.
    let scattered = spread(1, 32);
    println!("without batches {scattered:.4}");
    assert!(few < 0.9 * scattered, "{few} {scattered}");
}

#[test]
fn a_seed_is_a_picture() {
    let scene = cornell();
    let shot = shot(&scene, 64, 256);
    let [first, again, other] = [1, 1, 2].map(|seed| shot.clone().set("seed", seed).take());
    assert_eq!(first.pictures, again.pictures);
    for output in ["color", "direct", "indirect", "ambient_occlusion"] {
        assert_ne!(first.pictures[output], other.pictures[output], "{output}");
        let [a, b] = [&first, &other].map(|found| mean(found, output));
        let error = (a.error * a.error + b.error * b.error).map(f64::sqrt);
        assert!((a.value - b.value).abs().cmple(3.0 * error).all(), "{output}: {a:?} {b:?}");
    }
}

/// The largest difference of two pictures, as part of the brightest pixel.
fn apart(one: &Estimate, two: &Estimate, output: &str) -> f64 {
    let [one, two] = [one, two].map(|found| found.pictures[output].data());
    let brightest = one.iter().fold(0f32, |most, x| most.max(x.abs()));
    let most = one.iter().zip(two).fold(0f32, |most, (a, b)| most.max((a - b).abs()));
    f64::from(most / brightest)
}

/// Bands of rows draw the same samples in the same order. Frames of fewer samples draw the same in sums of their own, whose
/// rounding differs.
#[test]
fn samples_do_not_depend_on_how_frames_share_them() {
    let scene = cornell();
    let plain = shot(&scene, 64, 128);
    let found = plain.take();
    // 64 samples in each of 12 pixels of a row: five rows to a frame.
    let banded = plain.clone().set("samples_per_dispatch", 4096).take();
    assert_eq!(found.pictures, banded.pictures);
    for samples in [1, 4, 16] {
        let split = plain.clone().set("samples_per_frame", samples).take();
        for output in found.pictures.keys() {
            let apart = apart(&found, &split, output);
            assert!(apart < 2e-5, "{output}, {samples} samples a frame: {apart}");
        }
    }
    let other = apart(&found, &plain.clone().set("seed", 9).take(), "color");
    assert!(other > 1e-3, "no control: {other}");
    assert!(mean(&found, "color").value.cmpgt(DVec3::ZERO).all());
}
