//! Direct light of point, spot and directional lights, in every pixel, against the closed form.

use super::integrator::{Flaw, Integrator};
use super::program::{SIZE, color, pixels, render, shipped};
use super::scenes::Studio;
use super::world::{Hit, World};
use glam::DVec3;
use std::path::Path;
use voxgi::picture::Picture;

/// How far around a point the light must be the same for it to be no edge of a shadow, metres: texels of the
/// light maps are up to 2 mm wide on these walls, and each look blends four, 1.5 of them off the surface.
const EDGE: f64 = 0.006;

/// How a picture agrees with the oracle.
#[derive(Debug, Default)]
struct Agreement {
    /// Pixels that agree: lit within the tolerance, or exactly black in the shadow.
    lit: u32,
    shadowed: u32,
    /// At the edges of shadows: not compared.
    edges: u32,
    wrong: Vec<([u32; 2], DVec3, DVec3)>,
    worst: f64,
}

/// Albedo and normal are half floats in the G-buffer, each component off by up to 2⁻¹² of 1; the rest is single
/// precision. An error of the normal moves the cosine, and so counts against what would be lit at a cosine of 1.
const TOLERANCE: f64 = 1e-3;

fn agreement(world: &World, flaw: Flaw, picture: &Picture) -> Agreement {
    let oracle = Integrator { world, flaw };
    let honest = Integrator { world, flaw: Flaw::None };
    let facing = Integrator { world, flaw: Flaw::NoCosine };
    let mut found = Agreement::default();
    for pixel in pixels() {
        let [x, y] = pixel.map(|i| f64::from(i) + 0.5);
        let Some(hit) = world.seen(x, y, SIZE) else { continue };
        if is_edge(&honest, &hit) {
            found.edges += 1;
            continue;
        }
        let (seen, expected) = (color(picture, pixel), oracle.direct(&hit));
        let error = ((seen - expected).abs() / facing.direct(&hit).max(DVec3::splat(1e-12))).max_element();
        match expected == DVec3::ZERO {
            true if seen == DVec3::ZERO => found.shadowed += 1,
            false if error < TOLERANCE => {
                found.lit += 1;
                found.worst = found.worst.max(error);
            }
            _ => found.wrong.push((pixel, seen, expected)),
        }
    }
    found
}

/// Whether a shadow's edge, or the surface's, is near.
fn is_edge(oracle: &Integrator, hit: &Hit) -> bool {
    let lit = |hit: &Hit| oracle.direct(hit) != DVec3::ZERO;
    let (across, along) = hit.plane.any_orthonormal_pair();
    let around = (0..8).map(|i| f64::from(i) * std::f64::consts::FRAC_PI_4);
    let mut near = around.map(|angle| EDGE * (angle.cos() * across + angle.sin() * along));
    let here = lit(hit);
    // A little off the surface, since walls that are no planes bend away from their triangles.
    let lift = 0.02 * EDGE * hit.plane;
    near.any(|step| lit(&Hit { point: hit.point + step + lift, ..*hit }) != here)
}

fn check(name: &str, scene: &Path) {
    let world = World::load(scene);
    let [direct] = render(scene, "cones", "--set resolution=16 --set bounces=1", ["direct"]);
    let found = agreement(&world, Flaw::None, &direct);
    let Agreement { lit, shadowed, edges, worst, .. } = found;
    println!(
        "{name}: lit {lit}, shadowed {shadowed}, edges {edges}, wrong {:?}, worst {worst:.5}",
        found.wrong
    );
    assert!(found.wrong.is_empty(), "{:?}", found.wrong);
    assert!(lit > 500 && shadowed > 300 && edges < 300, "both light and shadow are compared");
    for flaw in Flaw::ALL {
        let wrong = agreement(&world, flaw, &direct).wrong.len();
        println!("  {flaw:?}: wrong {wrong}");
        assert!(wrong > 100 || (flaw, name) == (Flaw::LinearFalloff, "directional"), "{flaw:?} is noticed");
    }
}

#[test]
fn a_point_light_gives_what_the_closed_form_says() {
    check("point", &shipped("scenes/cornell-point.glb"));
}

#[test]
fn a_spot_light_gives_what_the_closed_form_says() {
    let light = "Spot(position: (0.4, 0.5, 0.1), direction: (-0.3, -1, 0.6), intensity: (1, 2, 3), \
                 inner_degrees: 15, outer_degrees: 40)";
    let studio = Studio::new();
    check("spot", &studio.cornell_under("spot", light));
}

#[test]
fn a_directional_light_gives_what_the_closed_form_says() {
    let light = "Directional(direction: (0.4, -0.5, 1), irradiance: (3, 2, 1))";
    let studio = Studio::new();
    check("directional", &studio.cornell_under("directional", light));
}
