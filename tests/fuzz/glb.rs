//! glTF documents as a JSON value and the bytes of their first buffer, to and from files.

use serde_json::{Value, json};
use std::fs;
use std::path::Path;

#[derive(Clone)]
pub struct Document {
    pub json: Value,
    /// Content of buffer 0.
    pub bytes: Vec<u8>,
}

/// The document of a `.gltf` or `.glb` file with its first buffer, if it can be had.
pub fn read(path: &Path) -> Option<Document> {
    let content = fs::read(path).ok()?;
    if content.starts_with(b"glTF") {
        let length = u32::from_le_bytes(*content.get(12..)?.first_chunk()?) as usize;
        let json = serde_json::from_slice(content.get(20..20 + length)?).ok()?;
        let bytes = content.get(28 + length..).unwrap_or_default().to_vec();
        return Some(Document { json, bytes });
    }
    let mut json: Value = serde_json::from_slice(&content).ok()?;
    let mut bytes = Vec::new();
    if let Some(buffer) = json.pointer_mut("/buffers/0").and_then(Value::as_object_mut)
        && let Some(Value::String(uri)) = buffer.get("uri")
        && let Some((_, data)) = uri.split_once(";base64,")
    {
        bytes = base64(data)?;
        buffer.remove("uri");
    }
    json.is_object().then_some(Document { json, bytes })
}

fn base64(text: &str) -> Option<Vec<u8>> {
    let (mut word, mut bits, mut out) = (0_u32, 0, Vec::new());
    for byte in text.trim_end_matches('=').bytes() {
        let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        word = word << 6 | digits.iter().position(|digit| *digit == byte)? as u32;
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            out.push((word >> bits) as u8);
            word &= (1 << bits) - 1;
        }
    }
    Some(out)
}

/// A binary glTF of a JSON text and a binary chunk.
pub fn binary(json: &[u8], bytes: &[u8]) -> Vec<u8> {
    let mut file = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, data, fill) in [(b"JSON", json, b' '), (b"BIN\0", bytes, 0)] {
        let length = data.len().next_multiple_of(4);
        file.extend((length as u32).to_le_bytes());
        file.extend(kind);
        file.extend(data);
        file.resize(file.len() + length - data.len(), fill);
    }
    let length = file.len() as u32;
    file[8..12].copy_from_slice(&length.to_le_bytes());
    file
}

/// A document with something of everything that glTF has.
pub fn rich() -> Document {
    let mut bytes = Vec::new();
    let mut views = Vec::new();
    let mut put = |data: &[u8]| {
        views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": data.len()}));
        bytes.extend_from_slice(data);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    };
    let floats = |list: &[f32]| list.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    put(&floats(&[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]));
    put(&floats(&[0., 0., 1., 0., 0., 1., 0., 0., 1., 0., 0., 1.]));
    put(&floats(&[0., 0., 1., 0., 1., 1., 0., 1.]));
    put(&[0, 1, 2, 0, 2, 3]);
    put(&floats(&[1., 0., 0., 1., 1., 0., 0., 1., 1., 0., 0., -1., 1., 0., 0., -1.]));
    put(&[255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 128]);
    put(&[1, 0, 3, 0]);
    put(&floats(&[0.5, 0.5, 0.5, 2., 2., 2.]));
    put(&floats(&[0., 1., 2.]));
    put(&floats(&[0., 0., 0., 1., 0.7, 0., 0., 0.7, 1., 0., 0., 0.]));
    put(&floats(&[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.]));
    put(&picture(image::ImageFormat::Png));
    put(&picture(image::ImageFormat::Jpeg));
    let accessor = |view: u32, component: u32, kind: &str, count: u32| json!({"bufferView": view, "componentType": component, "type": kind, "count": count});
    let mut sparse = accessor(0, 5126, "VEC3", 4);
    sparse["sparse"] =
        json!({"count": 2, "indices": {"bufferView": 6, "componentType": 5123}, "values": {"bufferView": 7}});
    let mut colors = accessor(5, 5121, "VEC4", 4);
    colors["normalized"] = json!(true);
    let texture = |index: u32| json!({"index": index, "texCoord": index % 2});
    let transform = json!({"KHR_texture_transform": {"offset": [0.1, 0.2], "rotation": 1.0, "scale": [2, 3], "texCoord": 1}});
    let json = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 4]}],
        "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_emissive_strength"],
        "nodes": [
            {"children": [1, 2, 3], "translation": [1, 2, 3], "rotation": [0, 0.6, 0, 0.8], "scale": [1, -1, 2]},
            {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"mesh": 1, "skin": 0, "camera": 0, "extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"mesh": 0, "weights": [0.5], "camera": 1, "extensions": {"KHR_lights_punctual": {"light": 2}}},
            {"name": "joint"},
        ],
        "meshes": [
            {"weights": [0.25], "primitives": [
                {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TEXCOORD_1": 2, "TANGENT": 4, "COLOR_0": 5},
                 "indices": 3, "material": 0, "targets": [{"POSITION": 0}]},
                {"attributes": {"POSITION": 6, "TEXCOORD_0": 2}, "mode": 5, "material": 1},
            ]},
            {"primitives": [
                {"attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 5}, "mode": 6},
                {"attributes": {"POSITION": 0}, "mode": 1},
                {"attributes": {"POSITION": 0, "TEXCOORD_0": 2, "TEXCOORD_1": 2}, "indices": 3, "mode": 4, "material": 2},
            ]},
        ],
        "skins": [{"joints": [4], "inverseBindMatrices": 9, "skeleton": 4}],
        "animations": [{"channels": [
            {"sampler": 0, "target": {"node": 0, "path": "translation"}},
            {"sampler": 1, "target": {"node": 2, "path": "rotation"}},
        ], "samplers": [
            {"input": 7, "output": 10, "interpolation": "STEP"}, {"input": 7, "output": 8, "interpolation": "LINEAR"},
        ]}],
        "cameras": [
            {"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1, "zfar": 10.0, "aspectRatio": 1.5}},
            {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 10}},
        ],
        "materials": [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.6, 0.7, 1], "baseColorTexture": texture(0), "metallicRoughnessTexture": texture(1),
                "metallicFactor": 0.5, "roughnessFactor": 0.5}, "normalTexture": {"index": 1, "scale": 0.5},
                "occlusionTexture": {"index": 0, "strength": 0.5}, "alphaMode": "MASK", "alphaCutoff": 0.4, "doubleSided": true},
            {"emissiveFactor": [1, 0.5, 0.25], "emissiveTexture": {"index": 1, "extensions": transform},
                "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 7}}},
            {"alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}, "KHR_materials_transmission": {"transmissionFactor": 1}},
                "pbrMetallicRoughness": {"baseColorTexture": texture(1)}},
        ],
        "textures": [{"source": 0, "sampler": 0}, {"source": 1}],
        "samplers": [{"magFilter": 9728, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648}],
        "images": [{"bufferView": 11, "mimeType": "image/png"}, {"bufferView": 12, "mimeType": "image/jpeg"}],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 5, "color": [1, 0.5, 0.2], "range": 10}, {"type": "directional", "intensity": 2},
            {"type": "spot", "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}},
        ]}},
        "accessors": [
            accessor(0, 5126, "VEC3", 4), accessor(1, 5126, "VEC3", 4), accessor(2, 5126, "VEC2", 4), accessor(3, 5121, "SCALAR", 6),
            accessor(4, 5126, "VEC4", 4), colors, sparse, accessor(8, 5126, "SCALAR", 3), accessor(9, 5126, "VEC4", 3),
            accessor(10, 5126, "MAT4", 1), accessor(0, 5126, "VEC3", 3),
        ],
        "bufferViews": views, "buffers": [{"byteLength": bytes.len()}],
    });
    Document { json, bytes }
}

fn picture(format: image::ImageFormat) -> Vec<u8> {
    let picture = image::RgbImage::from_fn(5, 3, |x, y| image::Rgb([(x * 50) as u8, (y * 80) as u8, 128]));
    let mut file = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut file, format).unwrap();
    file.into_inner()
}
