//! The models' files, read without the loader, and edited.

use crate::support::scenes;
use serde_json::Value;
use std::path::PathBuf;
use tempfile::TempDir;

/// The folder of the models; without it the test is skipped.
pub fn folder() -> Option<PathBuf> {
    scenes().map(|folder| folder.join("khronos"))
}

/// A binary glTF file.
#[derive(Clone)]
pub struct Model {
    pub document: Value,
    binary: Vec<u8>,
}

impl Model {
    pub fn read(name: &str) -> Option<Self> {
        let content = std::fs::read(folder()?.join(format!("{name}.glb"))).expect("the model is there");
        // A header of 12 bytes, then chunks: length, kind, content. The first is the document.
        let length = u32::from_le_bytes([12, 13, 14, 15].map(|i| content[i])) as usize;
        let (document, rest) = content[20..].split_at(length);
        let document = serde_json::from_slice(document).expect("the document is JSON");
        Some(Self { document, binary: rest[8..].to_vec() })
    }

    /// A copy with its document changed.
    pub fn edited(&self, edit: impl FnOnce(&mut Value)) -> Self {
        let mut edited = self.clone();
        edit(&mut edited.document);
        edited
    }

    /// Writes it into a folder of its own as `model.glb`.
    pub fn write(&self) -> (TempDir, PathBuf) {
        let mut text = self.document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let word = |n: usize| (n as u32).to_le_bytes();
        let length = 28 + text.len() + self.binary.len();
        let chunk = |kind: &[u8], content: &[u8]| [&word(content.len()), kind, content].concat();
        let bytes =
            [b"glTF", &word(2)[..], &word(length), &chunk(b"JSON", &text), &chunk(b"BIN\0", &self.binary)];
        let folder = tempfile::tempdir().expect("a folder for the model");
        let path = folder.path().join("model.glb");
        std::fs::write(&path, bytes.concat()).expect("the model can be written");
        (folder, path)
    }

    pub fn load(&self) -> voxgi::scene::Scene {
        let (_folder, path) = self.write();
        voxgi::scene::load(&path).expect("the model can be loaded")
    }

    /// The numbers of an attribute of the mesh's first primitive, or of its `indices`, one after another; integers that
    /// stand for fractions are divided.
    pub fn numbers(&self, mesh: usize, attribute: &str) -> Vec<f64> {
        let primitive = &self.document["meshes"][mesh]["primitives"][0];
        let place =
            if attribute == "indices" { &primitive["indices"] } else { &primitive["attributes"][attribute] };
        let whole = |value: &Value, otherwise: u64| value.as_u64().unwrap_or(otherwise) as usize;
        let accessor = &self.document["accessors"][whole(place, 0)];
        let view = &self.document["bufferViews"][whole(&accessor["bufferView"], 0)];
        let components = match accessor["type"].as_str().expect("a type") {
            "SCALAR" => 1,
            text => text[3..].parse().expect("VEC2 to VEC4"),
        };
        let (size, most) = match accessor["componentType"].as_u64() {
            Some(5121) => (1, 255.0),
            Some(5123) => (2, 65535.0),
            Some(5125) => (4, 1.0),
            Some(5126) => (4, 1.0),
            other => panic!("component type {other:?}"),
        };
        let scale = if accessor["normalized"] == true { most } else { 1.0 };
        let start = whole(&view["byteOffset"], 0) + whole(&accessor["byteOffset"], 0);
        let stride = whole(&view["byteStride"], (size * components) as u64);
        let number = |bytes: &[u8]| match (size, &accessor["componentType"]) {
            (1, _) => f64::from(bytes[0]),
            (2, _) => f64::from(u16::from_le_bytes([bytes[0], bytes[1]])),
            (_, kind) if kind == 5126 => f32::from_le_bytes([0, 1, 2, 3].map(|i| bytes[i])).into(),
            _ => u32::from_le_bytes([0, 1, 2, 3].map(|i| bytes[i])).into(),
        };
        let elements = 0..whole(&accessor["count"], 0);
        let places = elements.flat_map(|e| (0..components).map(move |c| start + e * stride + c * size));
        places.map(|at| number(&self.binary[at..]) / scale).collect()
    }
}
