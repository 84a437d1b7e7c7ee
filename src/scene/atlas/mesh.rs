//! Meshes as they are unwrapped: what several instances share once, without what does not matter to their shape.

use crate::scene::Scene;
use glam::{DVec3, Vec3};
use rustc_hash::FxHashMap;

/// A mesh in its own space, its corners joined by where they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// From the middle of the box around it, in units of the box's largest side.
    pub positions: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// The largest side, in units of its own space.
    pub unit: f64,
}

/// The triangles of one instance, which follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    pub instance: usize,
    pub mesh: usize,
    /// The scene's number of its first triangle.
    pub first: usize,
}

impl Mesh {
    /// Of triangles given by their corners.
    pub fn new(triangles: impl Iterator<Item = [Vec3; 3]>) -> Self {
        let corners: Vec<[Vec3; 3]> = triangles.collect();
        let all = || corners.iter().flatten().map(|p| p.as_dvec3());
        let Some((low, high)) = all().fold(None, |bounds: Option<(DVec3, DVec3)>, p| {
            Some(bounds.map_or((p, p), |(low, high)| (low.min(p), high.max(p))))
        }) else {
            return Self::default();
        };
        let (middle, unit) = ((low + high) / 2.0, (high - low).max_element());
        // What has no extent is a point, whatever its unit.
        let per_unit = if unit > 0.0 { unit.recip() } else { 0.0 };
        let mut mesh = Self { unit, ..Self::default() };
        let mut numbers: FxHashMap<[u32; 3], u32> = FxHashMap::default();
        for triangle in &corners {
            mesh.triangles.push(triangle.map(|corner| {
                let p = ((corner.as_dvec3() - middle) * per_unit).as_vec3().to_array();
                // Zero has two signs.
                *numbers.entry(p.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                    mesh.positions.push(p);
                    (mesh.positions.len() - 1) as u32
                })
            }));
        }
        mesh
    }

    /// Corners of a triangle.
    pub fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|corner| DVec3::from(self.positions[corner as usize].map(f64::from)))
    }

    pub fn area(&self) -> f64 {
        let area = |[a, b, c]: [DVec3; 3]| 0.5 * (b - a).cross(c - a).length();
        self.triangles.iter().map(|triangle| area(self.corners(*triangle))).sum()
    }
}

/// The scene's meshes, those of the same shape and size once, and which instance has which.
pub fn meshes(scene: &Scene) -> (Vec<Mesh>, Vec<Run>) {
    let mut meshes: Vec<Mesh> = Vec::new();
    // By the vertices of the triangles: instances of a mesh have the same ones.
    let mut known: FxHashMap<Vec<[u32; 3]>, usize> = FxHashMap::default();
    let mut runs = Vec::new();
    let mut first = 0;
    for run in scene.triangles.chunk_by(|a, b| a.instance == b.instance) {
        let vertices: Vec<[u32; 3]> = run.iter().map(|t| [t.a, t.b, t.c]).collect();
        let mesh = *known.entry(vertices).or_insert_with_key(|vertices| {
            let position = |vertex: u32| scene.vertices[vertex as usize].position;
            meshes.push(Mesh::new(vertices.iter().map(|corners| corners.map(position))));
            meshes.len() - 1
        });
        runs.push(Run { instance: run[0].instance as usize, mesh, first });
        first += run.len();
    }
    (meshes, runs)
}
