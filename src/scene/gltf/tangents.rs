//! Tangents of surfaces that come without: MikkTSpace, which glTF names and bakers of normal maps use.
//!
//! The corners of all triangles get tangents of their own; corners of one vertex that got the same one share a vertex
//! again. Tangents follow the coordinates that the map is looked up by, its transform included.

use super::lookup::NormalMap;
use super::vertices::Vertices;
use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3, Vec4};
use rustc_hash::FxHashMap;

/// The vertices of `corners` with tangents, and the corners as indices into them.
pub fn with_tangents(
    vertices: &Vertices,
    corners: &[[u32; 3]],
    map: &NormalMap,
) -> (Vertices, Vec<[u32; 3]>) {
    let mut surface = Surface { vertices, corners, map, tangents: vec![Vec4::ZERO; corners.len() * 3] };
    let Ok(()) = generate_tangents(&mut surface) else { return (vertices.clone(), corners.to_vec()) };
    let tangents = surface.tangents;
    let mut welded: FxHashMap<(u32, [u32; 4]), u32> = FxHashMap::default();
    let (mut sources, mut kept) = (Vec::new(), Vec::new());
    let mut corner_tangents = tangents.iter();
    let corners = corners.iter().map(|corner| {
        corner.map(|source| {
            let tangent = corner_tangents.next().copied().unwrap_or_default();
            // Adding 0 makes one number of the two zeros.
            let bits = (tangent + Vec4::ZERO).to_array().map(f32::to_bits);
            *welded.entry((source, bits)).or_insert_with(|| {
                sources.push(source);
                kept.push(tangent);
                sources.len() as u32 - 1
            })
        })
    });
    let corners = corners.collect();
    let mut own = vertices.gather(sources.into_iter());
    own.extras_mut().iter_mut().zip(kept).for_each(|(extra, tangent)| extra.tangent = tangent);
    (own, corners)
}

struct Surface<'a> {
    vertices: &'a Vertices,
    corners: &'a [[u32; 3]],
    map: &'a NormalMap,
    /// Of each triangle's three corners.
    tangents: Vec<Vec4>,
}

impl Surface<'_> {
    fn index(&self, face: usize, corner: usize) -> usize {
        self.corners[face][corner] as usize
    }
}

impl Geometry for Surface<'_> {
    fn num_faces(&self) -> usize {
        self.corners.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.vertices.plain[self.index(face, corner)].position.to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.vertices.plain[self.index(face, corner)].normal.to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let index = self.index(face, corner);
        let vertex = &self.vertices.plain[index];
        let uv = match self.map.place {
            0 => Vec2::new(vertex.u, vertex.v),
            _ => self.vertices.extras.get(index).map_or(Vec2::ZERO, |extra| extra.uv),
        };
        let [x, y, z] = self.map.transform;
        (x * uv.x + y * uv.y + z).to_array()
    }

    /// MikkTSpace has v point up and glTF down, and the map's green points up in both: the bitangent is the other way.
    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let Some([x, y, z, sign]) = space.map(|space| space.tangent_encoded()) else { return };
        let tangent = Vec3::new(x, y, z);
        if tangent.is_finite() && tangent != Vec3::ZERO {
            self.tangents[face * 3 + corner] = tangent.normalize_or_zero().extend(-sign);
        }
    }
}
