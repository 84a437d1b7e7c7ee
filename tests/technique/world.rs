//! A scene as the oracle sees it: triangles in double precision, and rays.
//!
//! Only loading is the program's; everything after it is written anew.

use glam::{DMat3, DVec3};
use std::path::Path;
use voxgi::scene::{self, layout};

/// A triangle of one colour.
pub struct Facet {
    pub corners: [DVec3; 3],
    /// Unit length, out of the front.
    pub normal: DVec3,
    /// What the file gives for the corners, to shade with.
    pub normals: [DVec3; 3],
    pub area: f64,
    pub albedo: DVec3,
    /// Radiance that leaves the front.
    pub emission: DVec3,
    /// Which object it is part of.
    pub object: usize,
}

pub enum Light {
    Point { position: DVec3, intensity: DVec3 },
    Spot { position: DVec3, direction: DVec3, intensity: DVec3, cos_inner: f64, cos_outer: f64 },
    Directional { direction: DVec3, irradiance: DVec3 },
}

pub struct World {
    pub facets: Vec<Facet>,
    pub lights: Vec<Light>,
    camera: scene::Camera,
}

/// A point of a surface, seen from one side.
#[derive(Clone, Copy)]
pub struct Hit {
    pub point: DVec3,
    /// To shade with, on the side from where it is seen. It can differ from the triangle's: the published left wall
    /// of the Cornell box is no plane, and its two triangles share normals that are 0.6° off each.
    pub normal: DVec3,
    /// The triangle's own, on the same side.
    pub plane: DVec3,
    pub facet: usize,
    pub front: bool,
}

/// Rays start this far from surfaces, metres. The Cornell box is half a metre wide.
const OFF: f64 = 1e-7;

impl World {
    pub fn load(path: &Path) -> Self {
        let scene = scene::load(path).expect("the scene can be loaded");
        let facets = scene.triangles.iter().map(|triangle| {
            let instance = &scene.instances[triangle.instance as usize];
            let material = &scene.materials[instance.material as usize];
            assert_eq!(material.base_color_image[0], 0, "this oracle knows no images");
            let [x, y, z, w] = instance.to_world.map(|column| column.truncate().as_dvec3());
            let to_world = DMat3::from_cols(x, y, z);
            let vertices = [triangle.a, triangle.b, triangle.c].map(|i| scene.vertices[i as usize]);
            let corners = vertices.map(|vertex| to_world * vertex.position.as_dvec3() + w);
            let normal_to_world = to_world.inverse().transpose();
            let doubled = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            Facet {
                corners,
                normal: doubled.normalize_or_zero() * f64::from(instance.flip),
                normals: vertices.map(|vertex| normal_to_world * vertex.normal.as_dvec3()),
                area: doubled.length() * 0.5,
                albedo: material.base_color.as_dvec3(),
                emission: material.emission.as_dvec3(),
                object: triangle.instance as usize,
            }
        });
        let facets = facets.collect();
        let lights = scene.lights.iter().map(light).collect();
        Self { facets, lights, camera: scene.cameras[0].clone() }
    }

    /// What is seen through the point (x, y) of a square picture of `size` pixels a side, (0, 0) its upper left
    /// corner. The renderer has one sample a pixel, at its centre: `x + 0.5`.
    pub fn seen(&self, x: f64, y: f64, size: u32) -> Option<Hit> {
        let tan = self.camera.lens.half_height();
        let [right, down] = [x, y].map(|at| (2.0 * at / f64::from(size) - 1.0) * tan);
        let direction = self.camera.forward + right * self.camera.right - down * self.camera.up;
        self.nearest(self.camera.position, direction.normalize())
    }

    /// Visible emission of what is seen.
    pub fn emission(&self, hit: &Hit) -> DVec3 {
        if hit.front { self.facets[hit.facet].emission } else { DVec3::ZERO }
    }

    pub fn albedo(&self, hit: &Hit) -> DVec3 {
        self.facets[hit.facet].albedo
    }

    /// The first surface along a ray.
    pub fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let crossings = self.facets.iter().enumerate().filter_map(|(i, f)| {
            crossing(&f.corners, origin, direction).filter(|c| c[0] > OFF).map(|c| (i, c))
        });
        let (facet, [t, u, v]) = crossings.min_by(|a, b| a.1[0].total_cmp(&b.1[0]))?;
        let front = self.facets[facet].normal.dot(direction) < 0.0;
        let [a, b, c] = self.facets[facet].normals;
        let side = if front { 1.0 } else { -1.0 };
        let normal = (a * (1.0 - u - v) + b * u + c * v).normalize() * side;
        let plane = self.facets[facet].normal * side;
        Some(Hit { point: origin + t * direction, normal, plane, facet, front })
    }

    /// Whether nothing lies between a point of a surface and `distance` along `direction`.
    pub fn open(&self, from: DVec3, direction: DVec3, distance: f64) -> bool {
        let blocks = |[t, ..]: [f64; 3]| t > OFF && t < distance - OFF;
        !self.facets.iter().any(|f| crossing(&f.corners, from, direction).is_some_and(blocks))
    }
}

fn light(light: &layout::Light) -> Light {
    let (position, direction) = (light.position.as_dvec3(), light.direction.as_dvec3());
    let intensity = light.intensity.as_dvec3();
    match light.kind {
        layout::POINT => Light::Point { position, intensity },
        layout::SPOT => Light::Spot {
            position,
            direction,
            intensity,
            cos_inner: f64::from(light.cos_inner),
            cos_outer: f64::from(light.cos_outer),
        },
        _ => Light::Directional { direction, irradiance: intensity },
    }
}

/// Where a ray crosses a triangle: in lengths of `direction`, and the weights of the second and the third corner
/// (Möller and Trumbore 1997).
fn crossing([a, b, c]: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<[f64; 3]> {
    let (ab, ac) = (*b - *a, *c - *a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() < 1e-14 {
        return None;
    }
    let from_a = origin - *a;
    let u = from_a.dot(p) / determinant;
    let q = from_a.cross(ab);
    let v = direction.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| [ac.dot(q) / determinant, u, v])
}
