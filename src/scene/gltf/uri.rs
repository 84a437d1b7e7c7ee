//! URIs of buffers and images: data inside the file, or a file in the scene's own folder or below it.

use super::notes::{Fault, brief};
use std::path::{Component, Path, PathBuf};

/// Where a URI leads.
#[derive(Debug, PartialEq, Eq)]
pub enum Target {
    Data(Vec<u8>),
    /// Relative, of plain names only.
    File(PathBuf),
}

pub fn resolve(uri: &str) -> Result<Target, Fault> {
    match strip_scheme(uri, "data:") {
        Some(rest) => data(rest).map(Target::Data),
        None => file(uri).map(Target::File),
    }
}

fn strip_scheme<'a>(uri: &'a str, scheme: &str) -> Option<&'a str> {
    let (start, rest) = uri.split_at_checked(scheme.len())?;
    start.eq_ignore_ascii_case(scheme).then_some(rest)
}

fn data(rest: &str) -> Result<Vec<u8>, Fault> {
    let (kind, content) =
        rest.split_once(',').ok_or_else(|| Fault::new("gltf-uri", "the data URI has no comma"))?;
    if kind.ends_with(";base64") {
        base64(content).ok_or_else(|| Fault::new("gltf-uri", "the data URI's base64 is malformed"))
    } else {
        percent(content)
    }
}

/// A path of the user's file tree that stays below where it starts.
fn file(uri: &str) -> Result<PathBuf, Fault> {
    let decoded = String::from_utf8(percent(uri)?)
        .map_err(|_| Fault::new("gltf-uri", format!("the URI {:?} is not UTF-8", brief(uri))))?;
    inside(&decoded).ok_or_else(|| {
        Fault::new("gltf-uri", format!("the URI {:?} is not a file beside the scene or below it", brief(uri)))
            .help("put the file into the scene's folder and name it by a relative path without `..`")
    })
}

/// `path` if it is relative, without `..`, and the same on every system (no backslash, drive or control character).
pub fn inside(path: &str) -> Option<PathBuf> {
    if path.is_empty() || path.contains(['\\', ':']) || path.chars().any(char::is_control) {
        return None;
    }
    let path = Path::new(path);
    path.components()
        .all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
        .then(|| path.into())
}

fn percent(text: &str) -> Result<Vec<u8>, Fault> {
    let mut bytes = text.bytes();
    let mut out = Vec::with_capacity(text.len());
    while let Some(byte) = bytes.next() {
        if byte != b'%' {
            out.push(byte);
            continue;
        }
        let digit = |byte: Option<u8>| char::from(byte?).to_digit(16);
        match (digit(bytes.next()), digit(bytes.next())) {
            (Some(high), Some(low)) => out.push((high * 16 + low) as u8),
            _ => {
                let message = format!("{:?} has a `%` without two hex digits", brief(text));
                return Err(Fault::new("gltf-uri", message));
            }
        }
    }
    Ok(out)
}

/// RFC 4648 base64; padding may be left out, the unused bits may be anything.
fn base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    let mut out = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        if group.len() == 1 {
            return None;
        }
        let mut word = 0;
        for byte in group {
            let value = match byte {
                b'A'..=b'Z' => byte - b'A',
                b'a'..=b'z' => byte - b'a' + 26,
                b'0'..=b'9' => byte - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return None,
            };
            word = word << 6 | u32::from(value);
        }
        word <<= 6 * (4 - group.len());
        out.extend_from_slice(&word.to_be_bytes()[1..group.len()]);
    }
    Some(out)
}
