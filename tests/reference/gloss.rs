//! Glossy surfaces against glTF's metallic-roughness model (glTF 2.0, appendix B.3), written anew in double precision:
//! value by
//! value, lit by a directional light, which has no noise; and summed over all directions, in an even sky.
//!
//! One scene has 16 plates in a plane: four roughnesses by four metalnesses, seen by parallel rays.

use super::flaws::flawed;
use super::shot::{Mean, Shot, mean_where};
use super::stage::{Stage, directional, matt, quad};
use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};
use voxgi::converge::Estimate;
use voxgi::scene::Scene;
use voxgi::scene::environment::Environment;
use voxgi::scene::layout::Material;

const BASE: DVec3 = DVec3::new(0.9, 0.5, 0.1);
const ROUGHNESSES: [f64; 4] = [0.2, 0.4, 0.7, 1.0];
const METALNESSES: [f64; 4] = [0.0, 0.3, 0.7, 1.0];

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Flaw {
    None,
    /// α is roughness, not its square.
    Linear,
    /// Shadowed on the way in or out, not both.
    OneShadow,
    /// What is mirrored is scattered too.
    Doubled,
    /// Fresnel's share at the surface's normal.
    Normal,
    /// What metal reflects dims the dielectric beside it.
    Dimmed,
}

const FLAWS: [Flaw; 5] = [Flaw::Linear, Flaw::OneShadow, Flaw::Doubled, Flaw::Normal, Flaw::Dimmed];

#[derive(Clone, Copy)]
struct Gloss {
    roughness: f64,
    metallic: f64,
    flaw: Flaw,
}

impl Gloss {
    fn alpha(&self) -> f64 {
        if self.flaw == Flaw::Linear { self.roughness } else { self.roughness.powi(2) }
    }

    /// Schlick's, of the coat and of the metal.
    fn fresnel(&self, v: DVec3, h: DVec3) -> [DVec3; 2] {
        let cosine = if self.flaw == Flaw::Normal { v.y } else { v.dot(h) };
        [DVec3::splat(0.04), BASE].map(|f0| f0 + (1.0 - f0) * (1.0 - cosine.abs()).powi(5))
    }

    /// Smith's shadowing in one direction, by the tangent of its angle.
    fn shadow(&self, cosine: f64) -> f64 {
        let tangent = (1.0 / (cosine * cosine) - 1.0).max(0.0);
        2.0 / (1.0 + (1.0 + self.alpha().powi(2) * tangent).sqrt())
    }

    fn shadows(&self, v: DVec3, l: DVec3) -> f64 {
        let one = if self.flaw == Flaw::OneShadow { 1.0 } else { self.shadow(l.y) };
        self.shadow(v.y) * one
    }

    /// Of the dielectric's base below the coat.
    fn diffuse(&self, v: DVec3, h: DVec3) -> DVec3 {
        let lost = match self.flaw {
            Flaw::Doubled => DVec3::ZERO,
            Flaw::Dimmed => self.share(v, h),
            _ => self.fresnel(v, h)[0],
        };
        (1.0 - lost) * BASE * (1.0 - self.metallic) / PI
    }

    /// What is mirrored by a facet: a mixture of dielectric and metal.
    fn share(&self, v: DVec3, h: DVec3) -> DVec3 {
        let [coat, metal] = self.fresnel(v, h);
        coat * (1.0 - self.metallic) + metal * self.metallic
    }

    /// Reflected radiance to irradiance; y is the normal.
    fn value(&self, v: DVec3, l: DVec3) -> DVec3 {
        let h = (v + l).normalize();
        let a2 = self.alpha().powi(2);
        let d = a2 / (PI * (h.y * h.y * (a2 - 1.0) + 1.0).powi(2));
        self.diffuse(v, h) + self.share(v, h) * (d * self.shadows(v, l) / (4.0 * v.y * l.y))
    }

    /// Its integral times the cosine of `l`: the mirrored part over half vectors as dense as D times their cosine, the
    /// diffuse part over directions as dense as their cosine.
    fn albedo(&self, v: DVec3) -> DVec3 {
        const STEPS: u32 = 256;
        let mut sum = DVec3::ZERO;
        for i in 0..STEPS * STEPS {
            let [a, b] = [i / STEPS, i % STEPS].map(|i| (f64::from(i) + 0.5) / f64::from(STEPS));
            // Denser in the tail of half vectors, where one cell would be most of it.
            let (tail, weight) = (a.powi(3), 3.0 * a * a);
            let around = |cosine: f64| {
                let sine = (1.0 - cosine * cosine).sqrt();
                DVec3::new(sine * (TAU * b).cos(), cosine, sine * (TAU * b).sin())
            };
            let a2 = self.alpha().powi(2);
            let h = around((tail / (tail + a2 * (1.0 - tail))).sqrt());
            let l = 2.0 * v.dot(h) * h - v;
            if l.y > 0.0 && v.dot(h) > 0.0 {
                sum += self.share(v, h) * (self.shadows(v, l) * v.dot(h) / (v.y * h.y) * weight);
            }
            let l = around((1.0 - a).sqrt());
            sum += self.diffuse(v, (v + l).normalize()) * PI;
        }
        sum / f64::from(STEPS * STEPS)
    }
}

fn gloss(roughness: usize, metallic: usize, flaw: Flaw) -> Gloss {
    Gloss { roughness: ROUGHNESSES[roughness], metallic: METALNESSES[metallic], flaw }
}

/// All plates with their models.
fn plates(flaw: Flaw) -> impl Iterator<Item = ([usize; 2], Gloss)> {
    (0..16).map(move |i| ([i % 4, i / 4], gloss(i % 4, i / 4, flaw)))
}

/// A unit vector at an angle from y, and around y from z towards x.
fn direction(degrees: f64, around: f64) -> DVec3 {
    let ((sine, cosine), (x, z)) = (degrees.to_radians().sin_cos(), around.to_radians().sin_cos());
    DVec3::new(sine * x, cosine, sine * z)
}

/// Plates of 1 m, seen from the direction `v` whose x is 0: 4 × 4 plates fill the picture.
fn scene(v: DVec3) -> Scene {
    let mut stage = Stage::new();
    for ([column, row], Gloss { roughness, metallic, .. }) in plates(Flaw::None) {
        let middle = Vec3::new(column as f32 - 1.5, 0.0, row as f32 - 1.5);
        let material =
            Material { metallic: metallic as f32, roughness: roughness as f32, ..matt(BASE.as_vec3()) };
        stage = stage.surface(&quad(middle, Vec3::X * 0.5, -Vec3::Z * 0.5), material);
    }
    let mut scene = stage.seen_along(v * 5.0, -v, 2.0);
    // The plane is foreshortened upwards: rays as much denser there.
    scene.cameras[0].up *= v.y;
    scene
}

/// The plate's pixels but those at its rim.
fn plate(found: &Estimate, [column, row]: [usize; 2]) -> Mean {
    let within = |at: u32, plate: usize| at / 4 == plate as u32 && matches!(at % 4, 1 | 2);
    mean_where(found, "direct", |x, y| within(x, column) && within(y, row))
}

/// Angles from the normal of the view and of the light, and around it between them, degrees.
const PAIRS: [(f64, (f64, f64)); 3] = [(20.0, (30.0, 150.0)), (60.0, (55.0, 180.0)), (75.0, (40.0, 60.0))];

/// Single precision of D near its peak, where small differences are squared.
const EXACT: f64 = 3e-4;

fn lit(v: DVec3, l: DVec3) -> Scene {
    let mut scene = scene(v);
    scene.lights.push(directional(-l.as_vec3(), Vec3::ONE));
    scene
}

fn glossy(scene: &Scene) -> Shot<'_> {
    Shot::of(scene).set("diffuse_only", "false")
}

#[test]
fn reflection_is_the_published_model() {
    let mut passed = [16; FLAWS.len()];
    for (view, light) in PAIRS {
        let (v, l) = (direction(view, 0.0), direction(light.0, light.1));
        let found = glossy(&lit(v, l)).samples(128).take();
        let agrees = |at, model: Gloss| plate(&found, at).agrees_within(model.value(v, l) * l.y, EXACT);
        for (at, model) in plates(Flaw::None) {
            let (found, truth) = (plate(&found, at), model.value(v, l) * l.y);
            assert!(agrees(at, model), "{at:?} {view} {light:?}: {found:?}, to be {truth:?}");
        }
        for (passed, flaw) in passed.iter_mut().zip(FLAWS) {
            *passed = plates(flaw).filter(|(at, model)| agrees(*at, *model)).count().min(*passed);
        }
    }
    println!("{FLAWS:?}: of 16 plates pass {passed:?}");
    assert!(passed.iter().all(|passed| *passed <= 8), "{FLAWS:?}: {passed:?}");
}

/// Light from l to v is what light from v to l is, apart from the cosines.
#[test]
fn reflection_is_reciprocal() {
    for (view, light) in PAIRS {
        // Only the angle between them counts: turned so that each in turn is the camera's.
        let there = [direction(view, 0.0), direction(light.0, light.1)];
        let back = [direction(light.0, 0.0), direction(view, light.1)];
        let shots = [there, back].map(|[v, l]| (glossy(&lit(v, l)).samples(128).take(), l.y));
        for (at, _) in plates(Flaw::None) {
            let [one, two] = [0, 1].map(|i| plate(&shots[i].0, at).value / shots[i].1);
            assert!((one / two - 1.0).abs().max_element() < EXACT, "{at:?} {view} {light:?}: {one} {two}");
        }
    }
}

fn in_even_sky(view: f64) -> Scene {
    let mut scene = scene(direction(view, 0.0));
    scene.environment = Some(Environment::constant(Vec3::ONE).expect("an environment"));
    scene
}

#[test]
fn an_even_sky_shows_all_that_is_reflected() {
    for view in [0.0, 70.0] {
        let v = direction(view, 0.0);
        let found = glossy(&in_even_sky(view)).samples(512).take();
        for (at, model) in plates(Flaw::None) {
            let (found, truth) = (plate(&found, at), model.albedo(v));
            println!("{at:?} at {view}°: {:.4} ± {:.4}, to be {truth:.4}", found.value, found.error);
            // Four pixels have few batches: four of their errors.
            let apart = (found.value - truth).abs();
            assert!(apart.cmple(4.0 * found.error + 1e-4).all(), "{at:?} {view}: {found:?}, to be {truth:?}");
            assert!(found.error.max_element() < 0.02);
            // No metal gives more than arrives. A coated base does at grazing angles, by the model's own rule: what
            // its coat lets
            // through is told from one half vector for the way in and the way out.
            let most = if model.metallic == 1.0 { 1.0 } else { 1.02 };
            assert!(truth.max_element() <= most, "{truth:?}");
        }
        for flaw in FLAWS {
            let wrong = plates(flaw).filter(|(at, model)| !plate(&found, *at).agrees(model.albedo(v)));
            assert!(view == 0.0 || wrong.count() > 1, "{flaw:?} passes at {view}");
        }
    }
}

/// Densities that are wrong give wrong weights; values alone would not show it.
#[test]
fn flawed_densities_are_noticed() {
    let view = 60.0;
    let scene = in_even_sky(view);
    let flaws = [
        (
            "out.density = mix(cosine_density, 0.5 * d * view_smith, r.glossy);",
            "out.density = cosine_density;",
        ),
        ("(1.0 - random.y) * (1.0 + stretched.y) - stretched.y", "1.0 - random.y"),
    ];
    for (from, to) in flaws {
        let wrong = flawed("lib/reflection", from, to);
        let found = glossy(&scene).by(&wrong.library).samples(256).take();
        let v = direction(view, 0.0);
        let noticed = plates(Flaw::None).filter(|(at, model)| {
            let (found, truth) = (plate(&found, *at), model.albedo(v));
            (found.value - truth).abs().cmpgt(6.0 * found.error + 1e-3).any()
        });
        assert!(noticed.count() > 2, "`{to}` for `{from}` passes");
    }
}
