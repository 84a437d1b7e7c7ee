//! Scenes made for one test: variants of the Cornell box, and loose triangles.

use super::glb::glb;
use super::program::shipped;
use serde_json::{Value, json};
use std::path::PathBuf;
use tempfile::TempDir;

/// A folder of scenes that goes away with the test.
pub struct Studio(TempDir);

impl Studio {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for scenes"))
    }

    /// A file of the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A setting with these fields.
    pub fn setting(&self, name: &str, fields: &str) -> PathBuf {
        self.file(&format!("{name}.ron"), format!("Setting({fields})").as_bytes())
    }

    fn file(&self, name: &str, content: &[u8]) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).expect("the scene can be written");
        path
    }

    /// A shipped scene, with its glTF document edited.
    pub fn edited(&self, scene: &str, name: &str, edit: impl FnOnce(&mut Value)) -> PathBuf {
        let content = std::fs::read(shipped(&format!("scenes/{scene}.glb"))).expect("the scene is there");
        // A header of 12 bytes, then chunks: length, kind, content. The first is the document.
        let length = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|i| content[at + i])) as usize;
        let (document, binary) = content[20..].split_at(length(12));
        let mut document = serde_json::from_slice(document).expect("the document is JSON");
        edit(&mut document);
        self.file(&format!("{name}.glb"), &glb(&document, &binary[8..]))
    }

    /// The Cornell box without a light of its own, under the given ones (RON).
    pub fn cornell_under(&self, name: &str, lights: &str) -> PathBuf {
        self.edited("cornell-point", "dark", |document| {
            let unlit = |object: &mut Value| object.as_object_mut().map(|o| o.remove("extensions"));
            unlit(document);
            document["nodes"].as_array_mut().expect("nodes").iter_mut().for_each(|node| _ = unlit(node));
            document["extensionsUsed"] = json!(["KHR_materials_emissive_strength"]);
        });
        let setting = format!("Setting(gltf: \"dark.glb\", lights: [{lights}])");
        self.file(&format!("{name}.ron"), setting.as_bytes())
    }

    /// Loose triangles, positions in metres.
    pub fn triangles(&self, triangles: &[[[f32; 3]; 3]]) -> PathBuf {
        let corners = || triangles.iter().flatten();
        let bytes: Vec<u8> = corners().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let extreme = |f: fn(f32, f32) -> f32| {
            let of = |axis: usize| corners().map(|c| c[axis]).reduce(f).unwrap_or_default();
            [of(0), of(1), of(2)]
        };
        let document = json!({
            "asset": { "version": "2.0" },
            "buffers": [{ "byteLength": bytes.len() }],
            "bufferViews": [{ "buffer": 0, "byteLength": bytes.len() }],
            "accessors": [{
                "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 * triangles.len(),
                "min": extreme(f32::min), "max": extreme(f32::max),
            }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
            "nodes": [{ "mesh": 0 }],
            "scenes": [{ "nodes": [0] }],
            "scene": 0,
        });
        self.file("triangles.glb", &glb(&document, &bytes))
    }
}
