//! The container: the JSON document, and the bytes that a binary glTF carries beside it.

use super::notes::Fault;
use gltf::json::deserialize::from_slice;
use gltf::json::{Root, Value};
use serde_path_to_error::Segment;

/// The JSON text and the binary chunk of a file's content; the content itself if it is no binary glTF.
pub fn split(content: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    if !content.starts_with(b"glTF") {
        return Ok((content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content), None));
    }
    let version = word(content, 4).ok_or_else(cut)?;
    if version != 2 {
        let message = format!("the binary glTF has version {version}; only 2 is understood");
        return Err(Fault::new("gltf-container", message));
    }
    // Bytes after the stated length are no part of the container.
    let length = word(content, 8).ok_or_else(cut)? as usize;
    let content = content.get(..length).ok_or_else(cut)?;
    let (kind, json, end) = chunk(content, 12)?;
    if &kind != b"JSON" {
        return Err(Fault::new("gltf-container", "the first chunk of the binary glTF is not JSON"));
    }
    if end >= length {
        return Ok((json, None));
    }
    let (kind, data, _) = chunk(content, end)?;
    Ok((json, (&kind == b"BIN\0").then_some(data)))
}

fn cut() -> Fault {
    Fault::new("gltf-container", "the binary glTF is cut short").help("was the file fetched whole?")
}

/// The chunk at byte `at`: kind, data, and where it ends.
fn chunk(content: &[u8], at: usize) -> Result<([u8; 4], &[u8], usize), Fault> {
    let (size, kind) = word(content, at).zip(word(content, at + 4)).ok_or_else(cut)?;
    let start = at + 8;
    let end = start.checked_add(size as usize).ok_or_else(cut)?;
    Ok((kind.to_le_bytes(), content.get(start..end).ok_or_else(cut)?, end))
}

fn word(content: &[u8], at: usize) -> Option<u32> {
    content.get(at..)?.first_chunk().copied().map(u32::from_le_bytes)
}

/// Longest text that is tidied, in bytes: as values of any type, a text takes many times its size.
const MOST_TIDIED: usize = 8 << 20;

/// The document in a JSON text, and how many channels of animations had to be left out since they move no node; or what
/// is wrong, with the JSON pointer of where.
pub fn parse(json: &[u8]) -> Result<(Root, usize), String> {
    from_slice(json).map(|root| (root, 0)).or_else(|error| {
        let tidied = if json.len() <= MOST_TIDIED { parse_tidied(json) } else { None };
        tidied.ok_or_else(|| match place(json) {
            Some(pointer) => format!("at {pointer}: {error}"),
            None => error.to_string(),
        })
    })
}

/// JSON pointer of the place that keeps a text from being a document.
fn place(json: &[u8]) -> Option<String> {
    let mut text = serde_json::Deserializer::from_slice(json);
    let error = serde_path_to_error::deserialize::<_, Root>(&mut text).err()?;
    let name = |segment: &Segment| match segment {
        Segment::Seq { index } => format!("/{index}"),
        Segment::Map { key } => format!("/{}", key.replace('~', "~0").replace('/', "~1")),
        Segment::Enum { .. } | Segment::Unknown => String::new(),
    };
    let pointer: String = error.path().iter().map(name).collect();
    (!pointer.is_empty()).then_some(pointer)
}

/// Some documents are right, but not for the JSON types: whole numbers written as floats, scenes without nodes,
/// animations of what is no node.
fn parse_tidied(json: &[u8]) -> Option<(Root, usize)> {
    let mut document: Value = from_slice(json).ok()?;
    make_integers(&mut document);
    let mut left_out = 0;
    for scene in document.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        scene.as_object_mut()?.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    for animation in document.get_mut("animations").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            let before = channels.len();
            channels.retain(|channel| channel.pointer("/target/node").is_some_and(Value::is_u64));
            left_out += before - channels.len();
        }
    }
    Some((from_slice(&serde_json::to_vec(&document).ok()?).ok()?, left_out))
}

fn make_integers(value: &mut Value) {
    match value {
        Value::Number(number) => {
            // Beyond 2^53 a float doesn't tell which integer it stands for.
            let whole = number.as_f64().filter(|x| number.is_f64() && x.fract() == 0.0 && x.abs() < 9e15);
            if let Some(whole) = whole {
                *number = (whole as i64).into();
            }
        }
        Value::Array(list) => list.iter_mut().for_each(make_integers),
        Value::Object(map) => map.values_mut().for_each(make_integers),
        Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}
