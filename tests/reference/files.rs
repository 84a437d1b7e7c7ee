//! Shipped scenes with their documents edited.

use serde_json::Value;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use voxgi::scene::{self, Scene};

/// A folder of scenes that goes away with the test.
pub struct Studio(TempDir);

impl Studio {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for scenes"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A shipped scene under another name, its glTF document edited.
    pub fn edited(&self, shipped: &str, name: &str, edit: impl FnOnce(&mut Value)) -> Scene {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{shipped}.glb"));
        let content = std::fs::read(path).expect("a scene of this repository");
        // A header of 12 bytes, then chunks: length, kind, content. The first is the document.
        let word = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|i| content[at + i])) as usize;
        let (document, binary) = content[20..].split_at(word(12));
        let mut document = serde_json::from_slice(document).expect("the document is JSON");
        edit(&mut document);
        let mut text = document.to_string();
        while !text.len().is_multiple_of(4) {
            text.push(' ');
        }
        let bytes = |n: usize| (n as u32).to_le_bytes();
        let head = [bytes(0x4654_6c67), bytes(2), bytes(20 + text.len() + binary.len()), bytes(text.len())];
        let file = self.path(name);
        std::fs::write(&file, [&head.concat(), &b"JSON"[..], text.as_bytes(), binary].concat())
            .expect("the scene can be written");
        scene::load(&file).expect("an edited scene")
    }

    /// Under a node with these fields.
    pub fn placed(&self, shipped: &str, name: &str, fields: Value) -> Scene {
        self.edited(shipped, name, |document| {
            let nodes = document["nodes"].as_array_mut().expect("nodes");
            let mut root = fields;
            root["children"] = (0..nodes.len()).collect::<Vec<_>>().into();
            nodes.push(root);
            document["scenes"][0]["nodes"] = vec![nodes.len() - 1].into();
        })
    }
}
