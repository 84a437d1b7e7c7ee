//! A closed room whose walls all emit E and reflect ρ: radiance E / (1 − ρ) everywhere, E Σ ρᵏ up to n scatterings.

use super::flaws::flawed;
use super::shot::{Shot, mean};
use super::stage::{Stage, matt, quad, room};
use glam::{DVec3, Vec3};
use voxgi::scene::Scene;
use voxgi::scene::layout::Material;

const EMISSION: f64 = 0.5;
/// By channel.
const ALBEDO: DVec3 = DVec3::new(0.2, 0.5, 0.8);

fn furnace() -> Scene {
    let material = Material { emission: Vec3::splat(EMISSION as f32), ..matt(ALBEDO.as_vec3()) };
    Stage::new().surface(&room(), material).seen_from(DVec3::new(0.3, -0.2, 0.1), DVec3::new(0.5, 0.6, -0.7))
}

/// All light that was scattered up to `n` times.
fn partial(n: i32) -> DVec3 {
    (0..=n).map(|k| EMISSION * ALBEDO.map(|a| a.powi(k))).sum()
}

fn endless() -> DVec3 {
    EMISSION / (1.0 - ALBEDO)
}

#[test]
fn a_furnace_is_evenly_bright() {
    let scene = furnace();
    let found = Shot::of(&scene).take();
    let mistakes = [
        ("reflectance times π", EMISSION / (1.0 - ALBEDO * std::f64::consts::PI)),
        ("no emission of what is seen", endless() - EMISSION),
        ("light stops after 8 scatterings", partial(8)),
    ];
    mean(&found, "color").expect("color", endless(), &mistakes);
    mean(&found, "direct").expect("direct", partial(1), &[("two scatterings", partial(2))]);
    let indirect = endless() - partial(1);
    mean(&found, "indirect").expect("indirect", indirect, &[("less one scattering", endless() - partial(2))]);
}

#[test]
fn scatterings_are_counted() {
    let scene = furnace();
    for n in [1, 2, 4] {
        let found = Shot::of(&scene).set("max_scatterings", n).samples(256).take();
        let mistakes = [("one less", partial(n - 1)), ("one more", partial(n + 1))];
        mean(&found, "color").expect(&format!("up to {n}"), partial(n), &mistakes);
    }
}

/// Kernels with mistakes that renderers have had.
#[test]
fn a_flawed_furnace_is_noticed() {
    let scene = furnace();
    let flaws = [
        ("paths/trace", "throughput / max(survival, 1e-30)", "throughput"),
        ("paths/trace", "select(1.0 / (1.0 + ratio * ratio), 0.0, own <= 0.0)", "1.0"),
        ("paths/trace", "hit.t * hit.t / max(cosine, 1e-20)", "hit.t * hit.t"),
        ("lib/met", "if front || (materials", "if !front || (materials"),
    ];
    for (kernel, from, to) in flaws {
        let wrong = flawed(kernel, from, to);
        let found = mean(&Shot::of(&scene).by(&wrong.library).samples(256).take(), "color");
        println!("`{to}` for `{from}`: {:.4} ± {:.4}", found.value, found.error);
        assert!(!found.agrees(endless()), "`{to}` for `{from}` in {kernel} passes");
    }
}

/// Below a wide ceiling at height h nothing lies in the directions that leave it out of reach R: a share (h / R)² of them,
/// weighted by their cosines.
#[test]
fn openness_below_a_ceiling() {
    let ceiling = quad(Vec3::Y * 0.55, Vec3::X * 10.0, Vec3::Z * 10.0);
    // Small, since rays begin above it by a part of its size.
    let floor = quad(Vec3::ZERO, Vec3::X * 0.25, -Vec3::Z * 0.25);
    let scene = Stage::new().surface(&floor, matt(Vec3::ONE)).surface(&ceiling, matt(Vec3::ONE)).seen_along(
        DVec3::Y * 0.25,
        -DVec3::Y,
        0.2,
    );
    // A twentieth of 20 m: R is 1 m.
    let found = Shot::of(&scene).set("ao_distance", 0.05).take();
    let mistakes = [
        ("not weighted by the cosine", DVec3::splat(0.55)),
        ("closed instead of open", DVec3::splat(1.0 - 0.3025)),
    ];
    mean(&found, "ambient_occlusion").expect("openness", DVec3::splat(0.3025), &mistakes);
}
