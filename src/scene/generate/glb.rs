//! Writes binary glTF files of meshes: flat-shaded quadrilaterals, or vertices with their normals and indices.

use glam::{DVec3, Vec3};
use gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf::json::buffer::{Target, View};
use gltf::json::mesh::{Mesh, Mode, Primitive, Semantic};
use gltf::json::validation::Checked::Valid;
use gltf::json::{self, Index, Material, Node, Root};
use std::collections::BTreeMap;

/// A glTF document under construction.
#[derive(Default)]
pub struct Document {
    pub root: Root,
    binary: Vec<u8>,
}

/// A vertex: where it is, and its normal, of unit length.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    pub position: Vec3,
    pub normal: Vec3,
}

impl Document {
    pub fn material(&mut self, material: Material) -> Index<Material> {
        self.root.push(material)
    }

    /// Adds a node with a mesh of quads. The corners of each go counter-clockwise seen from its front.
    pub fn quads(&mut self, name: &str, quads: &[[DVec3; 4]], material: Index<Material>) {
        let corners: Vec<Vec3> = quads.iter().flatten().map(|corner| corner.as_vec3()).collect();
        let normals: Vec<Vec3> = quads
            .iter()
            .flat_map(|[a, b, c, d]| [(c - a).cross(d - b).normalize_or_zero().as_vec3(); 4])
            .collect();
        let indices: Vec<u8> = (0..quads.len() as u16)
            .flat_map(|quad| [0, 1, 2, 0, 2, 3].map(|corner| quad * 4 + corner))
            .flat_map(u16::to_le_bytes)
            .collect();
        self.mesh(name, &corners, &normals, (&indices, ComponentType::U16), material);
    }

    /// Adds a node with a mesh of triangles, 24 bytes a vertex. Each index is below the number of vertices.
    pub fn triangles(
        &mut self,
        name: &str,
        vertices: &[Corner],
        triangles: &[[u32; 3]],
        material: Index<Material>,
    ) {
        let positions: Vec<Vec3> = vertices.iter().map(|vertex| vertex.position).collect();
        let normals: Vec<Vec3> = vertices.iter().map(|vertex| vertex.normal).collect();
        let indices: Vec<u8> = triangles.iter().flatten().flat_map(|index| index.to_le_bytes()).collect();
        self.mesh(name, &positions, &normals, (&indices, ComponentType::U32), material);
    }

    /// `indices`: three for each triangle, as bytes of integers of this type.
    fn mesh(
        &mut self,
        name: &str,
        corners: &[Vec3],
        normals: &[Vec3],
        (indices, kind): (&[u8], ComponentType),
        material: Index<Material>,
    ) {
        let low = corners.iter().copied().reduce(Vec3::min).unwrap_or_default();
        let high = corners.iter().copied().reduce(Vec3::max).unwrap_or_default();
        let positions =
            self.accessor(bytemuck::cast_slice(corners), corners.len(), Type::Vec3, ComponentType::F32);
        self.root.accessors[positions.value()].min = Some(json::Value::from(low.to_array().to_vec()));
        self.root.accessors[positions.value()].max = Some(json::Value::from(high.to_array().to_vec()));
        let normals =
            self.accessor(bytemuck::cast_slice(normals), normals.len(), Type::Vec3, ComponentType::F32);
        let indices = self.accessor(indices, indices.len() / kind.size(), Type::Scalar, kind);
        let primitive = Primitive {
            attributes: BTreeMap::from([
                (Valid(Semantic::Positions), positions),
                (Valid(Semantic::Normals), normals),
            ]),
            extensions: None,
            extras: None,
            indices: Some(indices),
            material: Some(material),
            mode: Valid(Mode::Triangles),
            targets: None,
        };
        let mesh = self.root.push(Mesh {
            extensions: None,
            extras: None,
            name: Some(name.to_owned()),
            primitives: vec![primitive],
            weights: None,
        });
        self.root.push(Node { mesh: Some(mesh), name: Some(name.to_owned()), ..Node::default() });
    }

    fn accessor(&mut self, bytes: &[u8], count: usize, type_: Type, kind: ComponentType) -> Index<Accessor> {
        let indices = matches!(type_, Type::Scalar);
        let view = self.root.push(View {
            buffer: Index::new(0),
            byte_length: bytes.len().into(),
            byte_offset: Some(self.binary.len().into()),
            byte_stride: None,
            name: None,
            target: Some(Valid(if indices { Target::ElementArrayBuffer } else { Target::ArrayBuffer })),
            extensions: None,
            extras: None,
        });
        self.binary.extend_from_slice(bytes);
        pad(&mut self.binary, 0);
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: count.into(),
            component_type: Valid(GenericComponentType(kind)),
            extensions: None,
            extras: None,
            type_: Valid(type_),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        })
    }

    /// The file, with all nodes in one scene.
    pub fn into_bytes(mut self) -> Vec<u8> {
        self.root.push(json::Buffer {
            byte_length: self.binary.len().into(),
            name: None,
            uri: None,
            extensions: None,
            extras: None,
        });
        let nodes = (0..self.root.nodes.len() as u32).map(Index::new).collect();
        let scene = self.root.push(json::Scene { extensions: None, extras: None, name: None, nodes });
        self.root.scene = Some(scene);
        // Maps with string keys and finite numbers always have a text.
        let mut text = self.root.to_vec().unwrap_or_default();
        pad(&mut text, b' ');
        let length = 12 + 8 + text.len() + 8 + self.binary.len();
        let mut file = Vec::with_capacity(length);
        file.extend(b"glTF");
        file.extend([2, length as u32].map(u32::to_le_bytes).as_flattened());
        for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &self.binary)] {
            file.extend((chunk.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(chunk);
        }
        file
    }
}

/// Fills up to a multiple of four bytes.
fn pad(bytes: &mut Vec<u8>, with: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), with);
}
