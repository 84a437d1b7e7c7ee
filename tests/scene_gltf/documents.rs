//! glTF documents made by hand.

use serde_json::{Value, json};
use voxgi::problem::Problems;
use voxgi::scene::{self, Scene};

pub fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

pub fn data_uri(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let bits: String = bytes.iter().map(|byte| format!("{byte:08b}")).collect();
    let mut text = String::from("data:application/octet-stream;base64,");
    for group in bits.as_bytes().chunks(6) {
        let group = format!("{:0<6}", std::str::from_utf8(group).unwrap());
        text.push(char::from(DIGITS[usize::from_str_radix(&group, 2).unwrap()]));
    }
    text
}

/// A document of one node with one primitive, made of lists: attribute or `indices`, content, component type, type, count.
pub fn document(lists: &[(&str, Vec<u8>, u32, &str, usize)]) -> Value {
    let mut binary = Vec::new();
    let (mut views, mut accessors, mut attributes) = (vec![], vec![], json!({}));
    let mut primitive = json!({});
    for (i, (name, bytes, component, type_, count)) in lists.iter().enumerate() {
        views.push(json!({"buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len()}));
        accessors.push(json!({"bufferView": i, "componentType": component, "type": type_, "count": count}));
        binary.extend_from_slice(bytes);
        binary.resize(binary.len().next_multiple_of(4), 0);
        match *name {
            "indices" => primitive["indices"] = json!(i),
            _ => attributes[*name] = json!(i),
        }
    }
    primitive["attributes"] = attributes;
    json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": binary.len(), "uri": data_uri(&binary)}],
    })
}

/// Corners (0 0 0), (1 0 0), (0 1 0), in that order: it faces +z.
pub const TRIANGLE: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];

pub fn triangle() -> Value {
    document(&[("POSITION", floats(&TRIANGLE), 5126, "VEC3", 3)])
}

/// Loads the document from a folder of its own.
pub fn load(document: &Value) -> Result<Scene, Problems> {
    load_bytes("scene.gltf", &serde_json::to_vec(document).unwrap())
}

pub fn load_bytes(name: &str, bytes: &[u8]) -> Result<Scene, Problems> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    scene::load(&path)
}
