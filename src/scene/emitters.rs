//! All that gives light, as kernels choose from it: emissive triangles, lights and the environment, each with the
//! probability of being chosen, and an alias table to choose by (Vose 1991).
//!
//! Half of the probability is even, half follows an estimate of the power that each sends into the scene. Positions are
//! metres from the centre of [`Scene::bounds`], as in [`super::bvh`].

use super::Scene;
use super::bvh::{area, corners};
use super::layout::{DIRECTIONAL, DOUBLE_SIDED, Emitter, Material, SPOT};
use crate::picture::srgb;
use glam::{UVec3, Vec3};
use std::f64::consts::PI;

pub const TRIANGLE: u32 = 3;
pub const ENVIRONMENT: u32 = 4;

/// The list; one emitter that is never chosen if nothing gives light.
pub fn emitters(scene: &Scene) -> Vec<Emitter> {
    let corners = corners(scene);
    let mut emitters = Vec::new();
    for (source, probability) in sources(scene, &corners) {
        emitters.push(Emitter { probability, ..made(scene, &corners, &source) });
    }
    alias(&mut emitters);
    if emitters.is_empty() {
        emitters.push(bytemuck::Zeroable::zeroed());
    }
    emitters
}

/// The triangles that emit, each with its probability.
pub(super) fn emitting(scene: &Scene, corners: &[[Vec3; 3]]) -> Vec<(usize, f32)> {
    let triangles = sources(scene, corners).into_iter().filter_map(|(source, probability)| match source {
        Source::Triangle(triangle) => Some((triangle, probability)),
        Source::Light(_) | Source::Environment => None,
    });
    triangles.collect()
}

enum Source {
    Triangle(usize),
    Light(usize),
    Environment,
}

fn luminance(color: Vec3) -> f64 {
    color.as_dvec3().dot(glam::DVec3::new(0.2126, 0.7152, 0.0722))
}

/// All that gives light, with probabilities that add up to 1.
fn sources(scene: &Scene, corners: &[[Vec3; 3]]) -> Vec<(Source, f32)> {
    let moves = scene.still_triangles < scene.triangles.len();
    let radius = 0.5 * scene.bounds.diagonal();
    let disk = PI * radius * radius;
    let mut sources: Vec<(Source, f64)> = Vec::new();
    let radiances: Vec<f64> = scene.materials.iter().map(|material| radiance(scene, material)).collect();
    for (index, triangle) in scene.triangles.iter().enumerate() {
        let material = scene.instances[triangle.instance as usize].material as usize;
        let area = if radiances[material] > 0.0 { area(&corners[index]) } else { 0.0 };
        // One that motion makes nothing of stays in the list, which is as long at all times.
        if area > 0.0 || (moves && radiances[material] > 0.0) {
            let sides = if scene.materials[material].flags & DOUBLE_SIDED == 0 { 1.0 } else { 2.0 };
            sources.push((Source::Triangle(index), PI * area * sides * radiances[material]));
        }
    }
    for (index, light) in scene.lights.iter().enumerate().filter(|(_, light)| light.intensity != Vec3::ZERO) {
        let angle = match light.kind {
            DIRECTIONAL => disk,
            SPOT => 2.0 * PI * (1.0 - 0.5 * f64::from(light.cos_outer + light.cos_inner)),
            _ => 4.0 * PI,
        };
        sources.push((Source::Light(index), angle * luminance(light.intensity)));
    }
    if let Some(environment) = &scene.environment
        && environment.mean() != Vec3::ZERO
    {
        sources.push((Source::Environment, PI * disk * luminance(environment.mean())));
    }
    let total: f64 = sources.iter().map(|(_, power)| power).sum();
    let even = 1.0 / sources.len() as f64;
    let probability = |power: f64| if total > 0.0 { 0.5 * (even + power / total) } else { even };
    sources.into_iter().map(|(source, power)| (source, probability(power) as f32)).collect()
}

/// Mean emission of a material, as luminance; 0 only if it emits nothing.
fn radiance(scene: &Scene, material: &Material) -> f64 {
    let reference = material.emission_image;
    let image = scene.images.iter().find(|image| reference.y > 0 && image.offset == reference.x);
    let mean = image.map_or(Vec3::ONE, |image| {
        let texels =
            (0..image.levels - 1).map(|level| (image.width >> level).max(1) * (image.height >> level).max(1));
        let last = scene.texels[(image.offset + texels.sum::<u32>()) as usize];
        let channel = |shift: u32| srgb::decode((last >> shift & 255) as f32 / 255.0).max(0.001);
        Vec3::new(channel(0), channel(8), channel(16))
    });
    luminance(material.emission * mean)
}

fn made(scene: &Scene, corners: &[[Vec3; 3]], source: &Source) -> Emitter {
    let zero: Emitter = bytemuck::Zeroable::zeroed();
    match *source {
        Source::Environment => Emitter { kind: ENVIRONMENT, ..zero },
        Source::Triangle(index) => {
            let ([a, b, c], triangle) = (corners[index], scene.triangles[index]);
            let vertices = UVec3::new(triangle.a, triangle.b, triangle.c);
            Emitter { a, b, c, kind: TRIANGLE, instance: triangle.instance, vertices, ..zero }
        }
        Source::Light(index) => {
            let light = &scene.lights[index];
            Emitter {
                a: (light.position.as_dvec3() - scene.bounds.center()).as_vec3(),
                b: light.direction,
                c: light.intensity,
                kind: light.kind,
                cos_outer: light.cos_outer,
                cos_inner: light.cos_inner,
                ..zero
            }
        }
    }
}

/// Fills `other` and `threshold`: of an even choice among all, one above its threshold means the other.
fn alias(emitters: &mut [Emitter]) {
    let count = emitters.len() as f64;
    let mut rest: Vec<f64> = emitters.iter().map(|e| f64::from(e.probability) * count).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..rest.len()).partition(|i| rest[*i] < 1.0);
    for (index, emitter) in emitters.iter_mut().enumerate() {
        (emitter.other, emitter.threshold) = (index as u32, 1.0);
    }
    while let (Some(low), Some(high)) = (small.pop(), large.last().copied()) {
        (emitters[low].other, emitters[low].threshold) = (high as u32, rest[low] as f32);
        rest[high] -= 1.0 - rest[low];
        if rest[high] < 1.0 {
            large.pop();
            small.push(high);
        }
    }
}
