//! Primitives: vertices, and triangles over them.
//!
//! Lists are read once for each distinct set of accessors, however many primitives or nodes use them. Two kinds of
//! primitives have vertices of their own: those without normals, where each triangle gets three with its face normal,
//! and those whose tangents are made.

use super::corners::corners;
use super::file::File;
use super::lookup::{Needs, NormalMap};
use super::notes::{Fault, Notes};
use super::tangents::with_tangents;
use super::vertices::{self, Attributes, Vertices};
use crate::scene::layout::{Vertex, VertexExtra};
use glam::Vec3;
use gltf::json::mesh::{Mesh, Mode, Primitive};
use gltf::json::validation::Checked;
use rustc_hash::FxHashMap;
use std::collections::HashMap;
use std::rc::Rc;

/// Most vertices of a scene: 32 million, 1 GiB, and as much again where they have extras.
const MOST_VERTICES: usize = 1 << 25;

/// Corners of triangles, as indices into all vertices of the scene.
pub type Corners = Rc<Vec<[u32; 3]>>;

/// What a part is made of: attributes, indices, mode, and what its tangents are made for, if they are.
type PartKey = (Attributes, Option<usize>, u32, Option<(usize, [u32; 6])>);

#[derive(Default)]
pub struct Meshes {
    /// All so far; extras reach as far as the last vertex that has one.
    vertices: Vertices,
    /// First vertex and number of vertices of attributes that parts share.
    shared: HashMap<Attributes, (u32, u32)>,
    parts: HashMap<PartKey, Corners>,
    /// What was read last, since one mesh's primitives often share their attributes.
    latest: Option<(Attributes, Rc<Vertices>)>,
}

impl Meshes {
    /// The triangles of one primitive; `None` if it has none or is faulty.
    pub fn part(
        &mut self,
        file: &File,
        mesh: &Mesh,
        at: (usize, usize),
        needs: &Needs,
        notes: &mut Notes,
    ) -> Option<Corners> {
        let pointer = format!("/meshes/{}/primitives/{}", at.0, at.1);
        let primitive = mesh.primitives.get(at.1)?;
        let Checked::Valid(mode) = primitive.mode else {
            notes.fault(pointer, Fault::new("gltf-value", "the mode is none of 0 to 6"));
            return None;
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            notes.lack("primitive of points or lines", "left out");
            return None;
        }
        let attributes = Attributes::of(primitive, needs, notes)?;
        let mapped =
            needs.normal_map.filter(|m| attributes.tangents.is_none() && attributes.uvs[m.place].is_some());
        let key =
            (attributes, primitive.indices.map(|i| i.value()), mode.as_gl_enum(), mapped.map(space_key));
        if let Some(part) = self.parts.get(&key) {
            return Some(Rc::clone(part));
        }
        let part = if attributes.normals.is_some() && mapped.is_none() {
            self.shared_part(file, &pointer, primitive, mode, &attributes, notes)?
        } else {
            self.own_part(file, &pointer, primitive, mode, (&attributes, mapped), notes)?
        };
        let part = Rc::new(part);
        self.parts.insert(key, Rc::clone(&part));
        Some(part)
    }

    fn shared_part(
        &mut self,
        file: &File,
        pointer: &str,
        primitive: &Primitive,
        mode: Mode,
        attributes: &Attributes,
        notes: &mut Notes,
    ) -> Option<Vec<[u32; 3]>> {
        let (first, count) = match self.shared.get(attributes) {
            Some(range) => *range,
            None => {
                let vertices = vertices::read(file, pointer, attributes, notes)?;
                let range = notes.catch(pointer, self.append(&vertices))?;
                self.shared.insert(*attributes, range);
                range
            }
        };
        let mut corners = corners(file, pointer, primitive, mode, count, notes)?;
        corners.iter_mut().flatten().for_each(|corner| *corner += first);
        mend_normals(&mut self.vertices.plain, &corners, notes);
        Some(corners)
    }

    /// `from`: what the vertices are read from, and the map that they get tangents for.
    fn own_part(
        &mut self,
        file: &File,
        pointer: &str,
        primitive: &Primitive,
        mode: Mode,
        from: (&Attributes, Option<NormalMap>),
        notes: &mut Notes,
    ) -> Option<Vec<[u32; 3]>> {
        let (attributes, mapped) = from;
        let read = match &self.latest {
            Some((key, vertices)) if key == attributes => Rc::clone(vertices),
            _ => Rc::new(vertices::read(file, pointer, attributes, notes)?),
        };
        self.latest = Some((*attributes, Rc::clone(&read)));
        let corners = corners(file, pointer, primitive, mode, read.plain.len() as u32, notes)?;
        // Corners of their own, twice over, and what making tangents takes.
        notes.catch(pointer, file.budget.pass(corners.len() as u64 * 3 * 400))?;
        let (mut vertices, mut corners) = match attributes.normals {
            Some(_) => {
                let mut vertices = Vertices::clone(&read);
                mend_normals(&mut vertices.plain, &corners, notes);
                (vertices, corners)
            }
            None => flat(&read, &corners),
        };
        if let Some(map) = mapped {
            (vertices, corners) = with_tangents(&vertices, &corners, &map);
        }
        let (first, _) = notes.catch(pointer, self.append(&vertices))?;
        corners.iter_mut().flatten().for_each(|corner| *corner += first);
        Some(corners)
    }

    /// First and number of the new vertices.
    fn append(&mut self, vertices: &Vertices) -> Result<(u32, u32), Fault> {
        let first = self.vertices.plain.len();
        if vertices.plain.len() > MOST_VERTICES - first {
            return Err(Fault::new("gltf-size", format!("the scene has more than {MOST_VERTICES} vertices")));
        }
        if !vertices.extras.is_empty() {
            self.vertices.fill_extras();
            self.vertices.extras.extend_from_slice(&vertices.extras);
        }
        self.vertices.plain.extend_from_slice(&vertices.plain);
        Ok((first as u32, vertices.plain.len() as u32))
    }

    /// Bytes that all vertices take.
    pub fn bytes(&self) -> usize {
        let extras = if self.vertices.extras.is_empty() { 0 } else { size_of::<VertexExtra>() };
        self.vertices.plain.len() * (size_of::<Vertex>() + extras)
    }

    /// All vertices, and as many extras or none.
    pub fn finish(mut self) -> (Vec<Vertex>, Vec<VertexExtra>) {
        if !self.vertices.extras.is_empty() {
            self.vertices.fill_extras();
        }
        // Corners of no triangle were not mended.
        let unused = self.vertices.plain.iter_mut().filter(|vertex| vertex.normal == Vec3::ZERO);
        unused.for_each(|vertex| vertex.normal = Vec3::Z);
        (self.vertices.plain, self.vertices.extras)
    }
}

fn space_key(map: NormalMap) -> (usize, [u32; 6]) {
    let [x, y, z] = map.transform;
    (map.place, [x.x, x.y, y.x, y.y, z.x, z.y].map(f32::to_bits))
}

/// Gives vertices without a usable normal (marked by a zero one) that of their triangles, area-weighted.
fn mend_normals(vertices: &mut [Vertex], corners: &[[u32; 3]], notes: &mut Notes) {
    let mut sums: FxHashMap<u32, Vec3> = FxHashMap::default();
    for triangle in corners {
        let [a, b, c] = triangle.map(|i| vertices[i as usize]);
        for (i, vertex) in triangle.iter().zip([a, b, c]) {
            if vertex.normal == Vec3::ZERO {
                let normal = (b.position - a.position).cross(c.position - a.position);
                *sums.entry(*i).or_insert(Vec3::ZERO) += normal;
            }
        }
    }
    for (i, sum) in sums {
        notes.lack("vertex normal without a direction", "computed from its triangles");
        let unit = sum.as_dvec3().try_normalize();
        // Some unit vector where there is no direction, as in a triangle without area.
        vertices[i as usize].normal = unit.map_or(Vec3::Z, |unit| unit.as_vec3());
    }
}

/// Three vertices for each triangle, with its normal.
fn flat(vertices: &Vertices, corners: &[[u32; 3]]) -> (Vertices, Vec<[u32; 3]>) {
    let mut own = vertices.gather(corners.iter().flatten().copied());
    for triangle in own.plain.chunks_exact_mut(3) {
        let [p, q, r] = [0, 1, 2].map(|corner: usize| triangle[corner].position.as_dvec3());
        let normal = (q - p).cross(r - p).try_normalize().map_or(Vec3::Z, |unit| unit.as_vec3());
        triangle.iter_mut().for_each(|vertex| vertex.normal = normal);
    }
    let count = own.plain.len() as u32;
    (own, (0..count).step_by(3).map(|a| [a, a + 1, a + 2]).collect())
}
