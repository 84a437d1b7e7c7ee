//! Scenes made of loose triangles, loaded as any scene is.

use crate::glb::glb;
use serde_json::{Value, json};
use std::path::PathBuf;
use tempfile::TempDir;
use voxgi::scene::{self, Scene};

/// Loose triangles of one material: a node named `part0`, `part1`, … each.
#[derive(Clone)]
pub struct Part {
    /// Three for each triangle, metres.
    pub corners: Vec<[f32; 3]>,
    /// As many texture coordinates, or none.
    pub uvs: Vec<[f32; 2]>,
    /// Linear.
    pub color: [f32; 3],
    /// Linear, at most 1.
    pub emission: [f32; 3],
    /// Where the image is less than half opaque, there is nothing.
    pub masked: bool,
    /// Where the node lies.
    pub translation: [f32; 3],
}

impl Part {
    pub fn new(corners: Vec<[f32; 3]>) -> Self {
        Self {
            corners,
            uvs: Vec::new(),
            color: [1.0; 3],
            emission: [0.0; 3],
            masked: false,
            translation: [0.0; 3],
        }
    }
}

/// What a scene is made of.
#[derive(Clone, Default)]
pub struct Model {
    pub parts: Vec<Part>,
    /// A PNG that all parts with texture coordinates show, and how: glTF's sampler.
    pub image: Option<(Vec<u8>, Value)>,
    /// RON of a setting's motion.
    pub motion: Option<String>,
}

impl Model {
    pub fn load(&self) -> Scene {
        let folder = tempfile::tempdir().expect("a folder for the scene");
        let path = self.write(&folder);
        scene::load(&path)
            .unwrap_or_else(|problems| panic!("{:?}", problems.iter().next().map(|p| &p.message)))
    }

    fn write(&self, folder: &TempDir) -> PathBuf {
        let model = folder.path().join("model.glb");
        std::fs::write(&model, self.glb()).expect("the scene can be written");
        let Some(motion) = &self.motion else { return model };
        let setting = folder.path().join("model.ron");
        let content = format!("Setting(gltf: \"model.glb\", motion: [{motion}])");
        std::fs::write(&setting, content).expect("the setting can be written");
        setting
    }

    fn glb(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut views = Vec::new();
        let mut accessors = Vec::new();
        let (mut meshes, mut nodes, mut materials) = (Vec::new(), Vec::new(), Vec::new());
        for (i, part) in self.parts.iter().enumerate() {
            let extreme = |f: fn(f32, f32) -> f32| {
                [0, 1, 2].map(|axis| part.corners.iter().map(|c| c[axis]).reduce(f).unwrap_or_default())
            };
            let mut attributes = json!({ "POSITION": accessors.len() });
            views.push(view(&mut bytes, part.corners.iter().flatten().flat_map(|x| x.to_le_bytes())));
            accessors.push(json!({
                "bufferView": views.len() - 1, "componentType": 5126, "type": "VEC3",
                "count": part.corners.len(), "min": extreme(f32::min), "max": extreme(f32::max),
            }));
            let [r, g, b] = part.color;
            let mut look = json!({ "baseColorFactor": [r, g, b, 1.0] });
            if !part.uvs.is_empty() {
                attributes["TEXCOORD_0"] = json!(accessors.len());
                look["baseColorTexture"] = json!({ "index": 0 });
                views.push(view(&mut bytes, part.uvs.iter().flatten().flat_map(|x| x.to_le_bytes())));
                accessors.push(json!({
                    "bufferView": views.len() - 1, "componentType": 5126, "type": "VEC2",
                    "count": part.uvs.len(),
                }));
            }
            let alpha = if part.masked { "MASK" } else { "OPAQUE" };
            materials.push(json!({
                "pbrMetallicRoughness": look, "emissiveFactor": part.emission, "alphaMode": alpha,
            }));
            meshes.push(json!({ "primitives": [{ "attributes": attributes, "material": i }] }));
            nodes.push(json!({ "mesh": i, "name": format!("part{i}"), "translation": part.translation }));
        }
        let mut document = json!({
            "asset": { "version": "2.0" },
            "meshes": meshes,
            "materials": materials,
            "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
            "nodes": nodes,
            "accessors": accessors,
            "scene": 0,
        });
        if let Some((png, sampler)) = &self.image {
            views.push(view(&mut bytes, png.iter().copied()));
            document["images"] = json!([{ "bufferView": views.len() - 1, "mimeType": "image/png" }]);
            document["samplers"] = json!([sampler]);
            document["textures"] = json!([{ "source": 0, "sampler": 0 }]);
        }
        document["bufferViews"] = json!(views);
        document["buffers"] = json!([{ "byteLength": bytes.len() }]);
        glb(&document, &bytes)
    }
}

/// Adds a piece to the buffer, and says where it lies.
fn view(bytes: &mut Vec<u8>, piece: impl Iterator<Item = u8>) -> Value {
    let start = bytes.len();
    bytes.extend(piece);
    let length = bytes.len() - start;
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    json!({ "buffer": 0, "byteOffset": start, "byteLength": length })
}
