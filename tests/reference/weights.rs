//! The list of emitters: all that gives light and nothing else, with probabilities that sum to 1, and a table that gives them;
//! the densities in the hierarchy belong to them.

use super::stage::{Stage, directional, lamp, matt, point, quad, spot};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use voxgi::scene::Scene;
use voxgi::scene::bvh::{RECORD, words};
use voxgi::scene::emitters::{ENVIRONMENT, TRIANGLE, emitters};
use voxgi::scene::environment::Environment;
use voxgi::scene::layout::Emitter;

/// How likely each is chosen by an even choice of a row of the table, and of what the row says.
fn by_table(list: &[Emitter]) -> Vec<f64> {
    let mut chosen = vec![0.0; list.len()];
    for (index, row) in list.iter().enumerate() {
        chosen[index] += f64::from(row.threshold);
        chosen[row.other as usize] += 1.0 - f64::from(row.threshold);
    }
    chosen.into_iter().map(|sum| sum / list.len() as f64).collect()
}

/// What gives light in a scene, in powers of ten.
#[derive(Clone, Debug)]
struct Lit {
    lamps: Vec<(f32, f32)>,
    lights: Vec<(u8, f32)>,
    sky: Option<f32>,
}

fn lit() -> impl Strategy<Value = Lit> {
    let lamps = prop::collection::vec((-6f32..6.0, -2f32..2.0), 0..12);
    let lights = prop::collection::vec((0u8..3, -6f32..6.0), 0..6);
    (lamps, lights, prop::option::of(-6f32..6.0)).prop_map(|(lamps, lights, sky)| Lit { lamps, lights, sky })
}

fn scene(lit: &Lit) -> Scene {
    let floor = quad(Vec3::ZERO, Vec3::X * 5.0, -Vec3::Z * 5.0);
    let mut stage = Stage::new().surface(&floor, matt(Vec3::ONE));
    for (i, (radiance, size)) in lit.lamps.iter().enumerate() {
        let side = 10f32.powf(*size);
        let corners = quad(Vec3::Y * (i + 1) as f32, Vec3::X * side, Vec3::Z * side);
        stage = stage.surface(&corners, lamp(Vec3::splat(10f32.powf(*radiance))));
    }
    for (kind, power) in &lit.lights {
        let intensity = Vec3::splat(10f32.powf(*power));
        stage = stage.light(match kind {
            0 => point(Vec3::ONE, intensity),
            1 => spot(Vec3::ONE, -Vec3::Y, intensity, [10.0, 20.0]),
            _ => directional(-Vec3::Y, intensity),
        });
    }
    let mut scene = stage.seen_from(DVec3::Y, -DVec3::Y);
    scene.environment =
        lit.sky.map(|power| Environment::constant(Vec3::splat(10f32.powf(power))).expect("an environment"));
    scene
}

proptest! {
    #[test]
    fn the_table_gives_the_probabilities(lit in lit()) {
        let scene = scene(&lit);
        let list = emitters(&scene);
        let count = 2 * lit.lamps.len() + lit.lights.len() + usize::from(lit.sky.is_some());
        prop_assert_eq!(list.len(), count.max(1));
        if count == 0 {
            prop_assert_eq!(list[0].probability, 0.0);
            return Ok(());
        }
        let sum: f64 = list.iter().map(|e| f64::from(e.probability)).sum();
        prop_assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        for (row, chosen) in list.iter().zip(by_table(&list)) {
            prop_assert!((0.0..=1.0).contains(&row.threshold));
            prop_assert!((chosen - f64::from(row.probability)).abs() < 1e-6, "{chosen} {row:?}");
            // Nothing that gives light is never chosen.
            prop_assert!(f64::from(row.probability) >= 0.499 / count as f64);
        }
        // Kernels take the environment to be the last.
        let environments: Vec<_> = list.iter().map(|e| e.kind == ENVIRONMENT).collect();
        prop_assert_eq!(environments.iter().filter(|is| **is).count(), usize::from(lit.sky.is_some()));
        prop_assert!(lit.sky.is_none() || environments.last() == Some(&true));
        // Of a triangle, the hierarchy has the density by area.
        let words = words(&scene);
        let mut triangles = 0;
        for e in list.iter().filter(|e| e.kind == TRIANGLE) {
            let record = words.windows(16).step_by(RECORD).find(|record| {
                let place = [0, 1, 2, 4, 5, 6, 8, 9, 10].map(|i| record[i]);
                let corners: Vec<u32> =
                    [e.a, e.b, e.c].iter().flat_map(|c| c.to_array()).map(f32::to_bits).collect();
                place[..] == corners[..] && record[12] == e.instance
            });
            let density = f32::from_bits(record.expect("the triangle's record")[14]);
            let area = 0.5 * (e.b - e.a).as_dvec3().cross((e.c - e.a).as_dvec3()).length();
            prop_assert!((f64::from(density) * area / f64::from(e.probability) - 1.0).abs() < 1e-5);
            triangles += 1;
        }
        prop_assert_eq!(triangles, 2 * lit.lamps.len());
    }
}

/// Brighter emitters are chosen more often, and the table of another scene is noticed.
#[test]
fn power_counts() {
    let lamps = |bright: f32| Lit { lamps: vec![(0.0, 0.0), (bright, 0.0)], lights: Vec::new(), sky: None };
    let list = emitters(&scene(&lamps(2.0)));
    assert!(list[2].probability > 1.9 * list[0].probability, "{list:?}");
    let other = by_table(&emitters(&scene(&lamps(0.0))));
    assert!(list.iter().zip(other).any(|(e, p)| (f64::from(e.probability) - p).abs() > 0.05));
}
