//! Primitives: vertices with position, normal and one set of texture coordinates, and triangles over them.
//!
//! Lists are read once for each distinct set of accessors, however many primitives or nodes use them. Vertices without
//! normals are not shared: each triangle gets three of its own, with its face normal.

use super::accessor::{floats, indices};
use super::file::File;
use super::notes::{Fault, Notes};
use crate::scene::layout::Vertex;
use glam::Vec3;
use gltf::json::accessor::Accessor;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, mesh::Mesh};
use std::collections::HashMap;
use std::rc::Rc;

/// Most vertices of a scene: 32 million, 1 GiB.
const MOST_VERTICES: usize = 1 << 25;

/// Corners of triangles, as indices into all vertices of the scene.
pub type Corners = Rc<Vec<[u32; 3]>>;

/// Accessors of position, normal, texture coordinates.
type Attributes = (usize, Option<usize>, Option<usize>);

#[derive(Default)]
pub struct Meshes {
    pub vertices: Vec<Vertex>,
    /// First vertex and number of vertices of attributes with normals.
    shared: HashMap<Attributes, (u32, u32)>,
    parts: HashMap<(Attributes, Option<usize>, u32), Corners>,
}

impl Meshes {
    /// The triangles of one primitive; `None` if it has none or is faulty. `uv_set`: the set of texture coordinates that
    /// the material uses.
    pub fn part(
        &mut self,
        file: &File,
        mesh: &Mesh,
        at: (usize, usize),
        uv_set: Option<u32>,
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
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let Some(positions) = attribute(Semantic::Positions) else {
            notes.lack("primitive without positions", "left out");
            return None;
        };
        let normals = attribute(Semantic::Normals);
        let uvs = uv_set.and_then(|set| attribute(Semantic::TexCoords(set)));
        let key = (positions.value(), normals.map(|i| i.value()), uvs.map(|i| i.value()));
        let part_key = (key, primitive.indices.map(|i| i.value()), mode.as_gl_enum());
        if let Some(part) = self.parts.get(&part_key) {
            return Some(Rc::clone(part));
        }
        let part = if let Some(normals) = normals {
            let (first, count) = match self.shared.get(&key) {
                Some(range) => *range,
                None => {
                    let vertices = read_vertices(file, &pointer, positions, Some(normals), uvs, notes)?;
                    let range = notes.catch(&pointer, self.append(&vertices))?;
                    self.shared.insert(key, range);
                    range
                }
            };
            let mut corners = corners(file, &pointer, primitive, mode, count, notes)?;
            corners.iter_mut().flatten().for_each(|corner| *corner += first);
            self.mend_normals(&corners, notes);
            corners
        } else {
            let vertices = read_vertices(file, &pointer, positions, None, uvs, notes)?;
            let corners = corners(file, &pointer, primitive, mode, vertices.len() as u32, notes)?;
            let flat: Vec<Vertex> =
                corners.iter().flat_map(|corner| flat_triangle(&vertices, *corner)).collect();
            let (first, count) = notes.catch(&pointer, self.append(&flat))?;
            (first..first + count).step_by(3).map(|a| [a, a + 1, a + 2]).collect()
        };
        let part = Rc::new(part);
        self.parts.insert(part_key, Rc::clone(&part));
        Some(part)
    }

    /// First and number of the new vertices.
    fn append(&mut self, vertices: &[Vertex]) -> Result<(u32, u32), Fault> {
        let first = self.vertices.len();
        if vertices.len() > MOST_VERTICES - first {
            return Err(Fault::new("gltf-size", format!("the scene has more than {MOST_VERTICES} vertices")));
        }
        self.vertices.extend_from_slice(vertices);
        Ok((first as u32, vertices.len() as u32))
    }

    /// Gives vertices without a usable normal (marked by a zero one) that of their triangles, area-weighted.
    fn mend_normals(&mut self, corners: &[[u32; 3]], notes: &mut Notes) {
        let unusable = |vertex: &Vertex| vertex.normal == Vec3::ZERO;
        let mut sums: HashMap<u32, Vec3> = HashMap::new();
        for triangle in corners {
            let [a, b, c] = triangle.map(|i| self.vertices[i as usize]);
            for (i, vertex) in triangle.iter().zip([a, b, c]) {
                if unusable(&vertex) {
                    let normal = (b.position - a.position).cross(c.position - a.position);
                    *sums.entry(*i).or_insert(Vec3::ZERO) += normal;
                }
            }
        }
        for (i, sum) in sums {
            notes.lack("vertex normal without a direction", "computed from its triangles");
            self.vertices[i as usize].normal = unit(sum);
        }
    }
}

/// Some unit vector where there is no direction, as in a triangle without area.
fn unit(v: Vec3) -> Vec3 {
    let v = v.as_dvec3();
    v.try_normalize().map_or(Vec3::Z, |unit| unit.as_vec3())
}

fn flat_triangle(vertices: &[Vertex], corner: [u32; 3]) -> [Vertex; 3] {
    let [a, b, c] = corner.map(|i| vertices[i as usize]);
    let [p, q, r] = [a, b, c].map(|vertex| vertex.position.as_dvec3());
    let normal = (q - p).cross(r - p).try_normalize().map_or(Vec3::Z, |unit| unit.as_vec3());
    [a, b, c].map(|vertex| Vertex { normal, ..vertex })
}

/// Vertices with unit normals, or zero ones where there is no direction.
fn read_vertices(
    file: &File,
    pointer: &str,
    positions: Index<Accessor>,
    normals: Option<Index<Accessor>>,
    uvs: Option<Index<Accessor>>,
    notes: &mut Notes,
) -> Option<Vec<Vertex>> {
    let attributes = format!("{pointer}/attributes");
    let positions = notes.catch(format_args!("{attributes}/POSITION"), floats::<3>(file, positions))?;
    if let Some(bad) = positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        let fault = Fault::new("gltf-value", format!("position {bad} is not finite"));
        notes.fault(format_args!("{attributes}/POSITION"), fault);
        return None;
    }
    let list = normals.map(|normals| floats::<3>(file, normals)).transpose();
    let normals = notes.catch(format_args!("{attributes}/NORMAL"), list)?;
    let list = uvs.map(|uvs| floats::<2>(file, uvs)).transpose();
    let uvs = notes.catch(format_args!("{attributes}/TEXCOORD"), list)?;
    for (name, length) in
        [("NORMAL", normals.as_ref().map(Vec::len)), ("TEXCOORD", uvs.as_ref().map(Vec::len))]
    {
        if length.is_some_and(|length| length != positions.len()) {
            let message = format!("has another number of elements than the {} positions", positions.len());
            notes.fault(format_args!("{attributes}/{name}"), Fault::new("gltf-length", message));
            return None;
        }
    }
    let vertex = |(i, position): (usize, &[f32; 3])| {
        let normal = normals.as_ref().map_or(Vec3::ZERO, |normals| Vec3::from(normals[i]));
        let [u, v] = uvs.as_ref().map_or([0.0; 2], |uvs| uvs[i]);
        let normal = if normal.is_finite() { normal.normalize_or_zero() } else { Vec3::ZERO };
        Vertex { position: Vec3::from(*position), u, normal, v }
    };
    let mut vertices: Vec<Vertex> = positions.iter().enumerate().map(vertex).collect();
    for vertex in vertices.iter_mut().filter(|vertex| !(vertex.u.is_finite() && vertex.v.is_finite())) {
        (vertex.u, vertex.v) = (0.0, 0.0);
        notes.lack("texture coordinate that is not finite", "set to 0");
    }
    Some(vertices)
}

/// Triangles as indices below `count`.
fn corners(
    file: &File,
    pointer: &str,
    primitive: &Primitive,
    mode: Mode,
    count: u32,
    notes: &mut Notes,
) -> Option<Vec<[u32; 3]>> {
    let list = match primitive.indices {
        Some(accessor) => notes.catch(format_args!("{pointer}/indices"), indices(file, accessor))?,
        None => (0..count).collect(),
    };
    if let Some(place) = list.iter().position(|index| *index >= count) {
        let index = list[place];
        let message = format!("index {index} (element {place}) is beyond the {count} vertices");
        notes.fault(format_args!("{pointer}/indices"), Fault::new("gltf-index", message));
        return None;
    }
    if mode == Mode::Triangles && list.len() % 3 != 0 || list.len() < 3 {
        notes.lack("incomplete triangle", "left out");
    }
    let corners = match mode {
        Mode::TriangleStrip => {
            let odd = |i: usize| i % 2;
            let triangles = list.windows(3).enumerate();
            triangles.map(|(i, w)| [w[0], w[1 + odd(i)], w[2 - odd(i)]]).collect()
        }
        Mode::TriangleFan => {
            let rim = list.get(1..).unwrap_or_default();
            rim.windows(2).map(|w| [w[0], w[1], list[0]]).collect()
        }
        _ => list.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    };
    Some(corners)
}
