//! Attributes of primitives, read into vertices.

use super::accessor::{colors, floats};
use super::file::File;
use super::lookup::Needs;
use super::notes::{Fault, Notes};
use crate::scene::layout::{Vertex, VertexExtra};
use glam::{Vec2, Vec3, Vec4};
use gltf::json::Index;
use gltf::json::accessor::Accessor;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;

/// The accessors that vertices are read from.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Attributes {
    positions: usize,
    pub normals: Option<usize>,
    pub uvs: [Option<usize>; 2],
    colors: Option<usize>,
    pub tangents: Option<usize>,
}

impl Attributes {
    /// Those of a primitive that its material has a use for; `None` without positions.
    pub fn of(primitive: &Primitive, needs: &Needs, notes: &mut Notes) -> Option<Self> {
        let attribute = |semantic| {
            primitive
                .attributes
                .get(&Checked::Valid(semantic))
                .map(|accessor: &Index<Accessor>| accessor.value())
        };
        let Some(positions) = attribute(Semantic::Positions) else {
            notes.lack("primitive without positions", "left out");
            return None;
        };
        let normals = attribute(Semantic::Normals);
        let uvs = needs.sets.map(|set| set.and_then(|set| attribute(Semantic::TexCoords(set))));
        if (0..2).any(|place| needs.sets[place].is_some() && uvs[place].is_none()) {
            notes.lack("primitive without texture coordinates for its material", "given one texel of it");
        }
        if attribute(Semantic::Colors(1)).is_some() {
            notes.lack("second set of vertex colours", "left out");
        }
        // Without normals, glTF has tangents ignored.
        let tangents = normals.and(needs.normal_map).and_then(|_| attribute(Semantic::Tangents));
        Some(Self { positions, normals, uvs, colors: attribute(Semantic::Colors(0)), tangents })
    }
}

/// Vertices, and as many extras or none.
#[derive(Clone, Default)]
pub struct Vertices {
    pub plain: Vec<Vertex>,
    pub extras: Vec<VertexExtra>,
}

impl Vertices {
    /// The vertices with these indices, one after another.
    pub fn gather(&self, indices: impl Iterator<Item = u32> + Clone) -> Self {
        let extras = indices.clone().filter_map(|index| self.extras.get(index as usize).copied());
        let extras = extras.collect();
        Self { plain: indices.map(|index| self.plain[index as usize]).collect(), extras }
    }

    /// Extras for all vertices.
    pub fn extras_mut(&mut self) -> &mut [VertexExtra] {
        self.fill_extras();
        &mut self.extras
    }

    /// Gives the vertices that have no extra one that says nothing.
    pub fn fill_extras(&mut self) {
        self.extras.resize(self.plain.len(), VertexExtra::NONE);
    }
}

/// Reads vertices with unit normals, or zero ones where there is no direction. `None`: faulty.
pub fn read(file: &File, pointer: &str, attributes: &Attributes, notes: &mut Notes) -> Option<Vertices> {
    let mut reader = Reader { file, pointer: format!("{pointer}/attributes"), length: None, notes };
    let [first_uv, second_uv] = attributes.uvs;
    let positions = reader.list("POSITION", Some(attributes.positions), floats::<3>)?.unwrap_or_default();
    let normals = reader.list("NORMAL", attributes.normals, floats::<3>)?;
    let uvs = reader.list("TEXCOORD", first_uv, floats::<2>)?;
    if let Some(bad) = positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        let fault = Fault::new("gltf-value", format!("position {bad} is not finite"));
        reader.notes.fault(format_args!("{}/POSITION", reader.pointer), fault);
        return None;
    }
    let vertex = |(i, position): (usize, &[f32; 3])| {
        let normal = normals.as_ref().map_or(Vec3::ZERO, |normals| Vec3::from(normals[i]));
        // In f64, where the squares of the least f32 are not 0.
        let normal = normal.as_dvec3().try_normalize().map_or(Vec3::ZERO, |unit| unit.as_vec3());
        let Vec2 { x: u, y: v } = uvs.as_ref().map_or(Vec2::ZERO, |uvs| finite_uv(uvs[i], reader.notes));
        Vertex { position: Vec3::from(*position), u, normal, v }
    };
    let plain = positions.iter().enumerate().map(vertex).collect();
    drop((positions, normals, uvs));
    let mut vertices = Vertices { plain, extras: Vec::new() };
    if let Some(uvs) = reader.list("TEXCOORD", second_uv, floats::<2>)? {
        for (extra, uv) in vertices.extras_mut().iter_mut().zip(uvs) {
            extra.uv = finite_uv(uv, reader.notes);
        }
    }
    if let Some(list) = reader.list("COLOR_0", attributes.colors, colors)? {
        let colors: Vec<_> = list.into_iter().map(|color| finite_color(color, reader.notes)).collect();
        // Exporters like to write white for all.
        if colors.iter().any(|color| *color != VertexExtra::NONE.color) {
            vertices.extras_mut().iter_mut().zip(colors).for_each(|(extra, color)| extra.color = color);
        }
    }
    if let Some(tangents) = reader.list("TANGENT", attributes.tangents, floats::<4>)? {
        for (extra, tangent) in vertices.extras_mut().iter_mut().zip(tangents) {
            extra.tangent = unit_tangent(tangent, reader.notes);
        }
    }
    Some(vertices)
}

struct Reader<'a> {
    file: &'a File,
    /// Of the attributes.
    pointer: String,
    /// Of the lists so far.
    length: Option<usize>,
    notes: &'a mut Notes,
}

impl Reader<'_> {
    /// The list that `read` makes of the accessor, as long as those before: `Some(None)` if there is no accessor,
    /// `None` if it is faulty.
    fn list<T>(
        &mut self,
        name: &str,
        accessor: Option<usize>,
        read: impl FnOnce(&File, Index<Accessor>) -> Result<Vec<T>, Fault>,
    ) -> Option<Option<Vec<T>>> {
        let Some(accessor) = accessor else { return Some(None) };
        let pointer = format!("{}/{name}", self.pointer);
        let list = self.notes.catch(&pointer, read(self.file, Index::new(accessor as u32)))?;
        let length = *self.length.get_or_insert(list.len());
        if list.len() != length {
            let message = format!("has another number of elements than the {length} positions");
            self.notes.fault(pointer, Fault::new("gltf-length", message));
            return None;
        }
        Some(Some(list))
    }
}

fn finite_uv(uv: [f32; 2], notes: &mut Notes) -> Vec2 {
    let uv = Vec2::from(uv);
    if uv.is_finite() {
        return uv;
    }
    notes.lack("texture coordinate that is not finite", "set to 0");
    Vec2::ZERO
}

/// Packed; clamped to 0..1, as glTF says.
fn finite_color(color: [f32; 4], notes: &mut Notes) -> [u32; 2] {
    if color.iter().all(|c| c.is_finite()) {
        return VertexExtra::pack_color(color.map(|c| c.clamp(0.0, 1.0)));
    }
    notes.lack("vertex colour that is not finite", "set to white");
    VertexExtra::NONE.color
}

/// Zero where there is no direction.
fn unit_tangent([x, y, z, w]: [f32; 4], notes: &mut Notes) -> Vec4 {
    let tangent = Vec3::new(x, y, z);
    if tangent.is_finite() && tangent.normalize_or_zero() != Vec3::ZERO {
        return tangent.normalize_or_zero().extend(if w < 0.0 { -1.0 } else { 1.0 });
    }
    notes.lack("vertex tangent without a direction", "left without its normal map");
    Vec4::ZERO
}
