//! Mutants of glTF files: of the document's values, the text, the bytes of buffers, the container.

use crate::glb::{Document, binary};
use fastrand::Rng;
use serde_json::{Value, json};

/// A file name and its content, and the content of `buffer.bin`, which it may refer to.
pub struct Files {
    pub name: &'static str,
    pub content: Vec<u8>,
    pub buffer: Vec<u8>,
}

/// The document with some changes of values and bytes. `donors`: other documents, to take pieces from.
pub fn mutant(start: &Document, donors: &[Document], dice: &mut Rng) -> Document {
    let mut document = start.clone();
    for _ in 0..1 + dice.usize(..4) * dice.usize(..2) {
        match dice.usize(..10) {
            0 | 1 if !document.bytes.is_empty() => change_bytes(&mut document.bytes, dice),
            _ => change_value(&mut document.json, donors, dice),
        }
    }
    document
}

/// As files: a binary glTF, or a text with a buffer beside it; sometimes the text or the container is spoilt.
pub fn files(document: &Document, dice: &mut Rng) -> Files {
    let mut json = document.json.clone();
    let beside = dice.usize(..4) == 0;
    if beside && let Some(buffer) = json.pointer_mut("/buffers/0").and_then(Value::as_object_mut) {
        buffer.entry("uri").or_insert(json!("buffer.bin"));
    }
    let mut text = serde_json::to_vec(&json).unwrap();
    if dice.usize(..12) == 0 {
        change_text(&mut text, dice);
    }
    if beside {
        return Files { name: "scene.gltf", content: text, buffer: document.bytes.clone() };
    }
    let mut content = binary(&text, &document.bytes);
    if dice.usize(..16) == 0 {
        change_bytes(&mut content, dice);
    } else if dice.usize(..16) == 0 {
        // The words of the container: magic, version, length, and the lengths and kinds of both chunks.
        let second = 20 + text.len().next_multiple_of(4);
        let at = [0, 4, 8, 12, 16, second, second + 4][dice.usize(..7)];
        content[at..at + 4].copy_from_slice(&NUMBERS[dice.usize(..NUMBERS.len())].to_le_bytes());
    }
    Files { name: "scene.glb", content, buffer: Vec::new() }
}

const NUMBERS: [u32; 14] =
    [0, 1, 2, 3, 7, 8, 127, 255, 65_535, 65_536, 1 << 25, (1 << 31) - 1, 1 << 31, u32::MAX];

fn change_bytes(bytes: &mut Vec<u8>, dice: &mut Rng) {
    if bytes.is_empty() {
        return;
    }
    let at = dice.usize(..bytes.len());
    match dice.usize(..8) {
        0 => bytes.truncate(at),
        1 => bytes.resize(bytes.len() + dice.usize(..64), dice.u8(..)),
        2 | 3 => bytes[at] = dice.u8(..),
        4 => bytes[at] ^= 1 << dice.u8(..8),
        _ => {
            let special =
                [f32::NAN, f32::INFINITY, -f32::INFINITY, 3e38, -3e38, 1e-40, 0.0, -0.0, 1e19, 1e-19];
            let word =
                if dice.bool() { special[dice.usize(..10)].to_bits() } else { NUMBERS[dice.usize(..14)] };
            if let Some(word_there) = bytes.get_mut(at & !3..(at & !3) + 4) {
                word_there.copy_from_slice(&word.to_le_bytes());
            }
        }
    }
}

/// What values can't say: keys twice, numbers beyond all types, nesting, rubbish.
fn change_text(text: &mut Vec<u8>, dice: &mut Rng) {
    let at = dice.usize(..text.len());
    let piece: Vec<u8> = match dice.usize(..5) {
        0 => {
            let end = (at + dice.usize(1..200)).min(text.len());
            text[at..end].to_vec()
        }
        1 => b"[".repeat(dice.usize(1..3000)),
        2 => [&b"1e400"[..], b"-1e400", b"18446744073709551616", b"4294967296", b"4294967295.0"]
            [dice.usize(..5)]
        .to_vec(),
        3 => {
            let keys = text.iter().enumerate().filter(|(_, byte)| **byte == b'{').map(|(i, _)| i + 1);
            let places: Vec<usize> = keys.collect();
            let Some(place) = dice.choice(&places).copied() else { return };
            let piece = text[place..(place + dice.usize(1..60)).min(text.len())].to_vec();
            text.splice(place..place, piece);
            return;
        }
        _ => vec![dice.u8(..)],
    };
    let end = if dice.bool() { at } else { (at + piece.len()).min(text.len()) };
    text.splice(at..end, piece);
}

fn change_value(document: &mut Value, donors: &[Document], dice: &mut Rng) {
    let places = pointers(document);
    let Some(place) = dice.choice(&places).cloned() else { return };
    let (parent, name) = place.rsplit_once('/').unwrap();
    match dice.usize(..12) {
        0 => {
            match document.pointer_mut(parent) {
                Some(Value::Object(map)) => drop(map.remove(name)),
                Some(Value::Array(list)) => drop(name.parse().map(|i: usize| list.remove(i))),
                _ => {}
            };
        }
        1 => {
            let copy = document.pointer(&place).cloned();
            if let (Some(Value::Array(list)), Some(copy)) = (document.pointer_mut(parent), copy) {
                let times = if dice.usize(..30) == 0 { dice.usize(1..500) } else { 1 };
                list.extend(std::iter::repeat_n(copy, times));
            }
        }
        2 | 3 => {
            // A value that has this name elsewhere, here or in another document.
            let donor = if dice.bool() { None } else { dice.choice(donors) };
            let from = donor.map_or(&*document, |donor| &donor.json).clone();
            let alike: Vec<_> =
                pointers(&from).into_iter().filter(|p| p.rsplit('/').next() == Some(name)).collect();
            if let (Some(there), Some(here)) = (dice.choice(&alike), document.pointer_mut(&place)) {
                *here = from.pointer(there).cloned().unwrap_or_default();
            }
        }
        4 => {
            // A member that its likes have and this object lacks.
            let Some(donor) = dice.choice(donors) else { return };
            let likes = pointers(&donor.json);
            let shape = |pointer: &str| {
                pointer.split('/').filter(|p| p.parse::<u32>().is_err()).collect::<Vec<_>>().join("/")
            };
            let likes: Vec<_> = likes
                .into_iter()
                .filter(|p| p.rsplit_once('/').is_some_and(|(up, _)| shape(up) == shape(parent)))
                .collect();
            if let (Some(there), Some(Value::Object(map))) =
                (dice.choice(&likes), document.pointer_mut(parent))
            {
                let key = there.rsplit('/').next().unwrap_or_default();
                map.insert(key.to_owned(), donor.json.pointer(there).cloned().unwrap_or_default());
            }
        }
        5 => {
            let mut nested = json!({});
            for _ in 0..dice.usize(1..200) {
                nested = if dice.bool() { json!([nested]) } else { json!({"extras": nested}) };
            }
            if let Some(here) = document.pointer_mut(&place) {
                *here = nested;
            }
        }
        6..=8 => {
            if let Some(here) = document.pointer_mut(&place) {
                nudge(here, dice);
            }
        }
        _ => {
            if let Some(here) = document.pointer_mut(&place) {
                *here = strange(dice);
            }
        }
    }
}

/// A value near the one there, of the same type.
fn nudge(value: &mut Value, dice: &mut Rng) {
    match value {
        Value::Number(number) => {
            let old = number.as_f64().unwrap_or(0.0);
            let new = match dice.usize(..8) {
                0 | 1 => old + 1.0,
                2 | 3 => old - 1.0,
                4 => old * 2.0,
                5 => -old,
                6 => f64::from(NUMBERS[dice.usize(..14)]),
                _ => old * 10_f64.powi(dice.i32(-40..40)),
            };
            *value =
                if new.fract() == 0.0 && (0.0..1e15).contains(&new) { json!(new as u64) } else { json!(new) };
        }
        Value::Bool(flag) => *flag = !*flag,
        Value::String(text) => {
            let strange = [
                "",
                "..",
                "/etc/passwd",
                "%2e%2e/x",
                "a%zz",
                "data:,",
                "data:;base64,AAAA",
                "buffer.bin",
                "\u{0}",
                "é",
                "SCALAR",
                "VEC4",
                "MAT4",
            ];
            *text = if dice.usize(..20) == 0 {
                text.repeat(1000)
            } else {
                strange[dice.usize(..strange.len())].to_owned()
            };
        }
        Value::Array(list) => dice.shuffle(list),
        Value::Object(map) => {
            let keys: Vec<String> = map.keys().cloned().collect();
            if let (Some(a), Some(b)) = (dice.choice(&keys), dice.choice(&keys)) {
                let taken = map[a].clone();
                map.insert(b.clone(), taken);
            }
        }
        Value::Null => {}
    }
}

fn strange(dice: &mut Rng) -> Value {
    match dice.usize(..12) {
        0 => json!(null),
        1 => json!(dice.bool()),
        2 => json!(-1),
        3 => json!(1_u64 << 32),
        4 => json!(u64::MAX),
        5 => json!([1e39, 1e-46, 0.5, 3.4e38][dice.usize(..4)]),
        6 => json!([]),
        7 => json!({}),
        8 => json!(vec![0; dice.usize(..40)]),
        9 => json!("x"),
        _ => json!(NUMBERS[dice.usize(..14)]),
    }
}

/// All places of a document but the whole, as JSON pointers; names with `/` or `~` are left out.
fn pointers(document: &Value) -> Vec<String> {
    let (mut open, mut list) = (vec![(String::new(), document)], Vec::new());
    while let Some((at, value)) = open.pop() {
        match value {
            Value::Object(map) => {
                let plain = map.iter().filter(|(name, _)| !name.contains(['/', '~']));
                open.extend(plain.map(|(name, value)| (format!("{at}/{name}"), value)));
            }
            Value::Array(items) => {
                // In long lists of numbers all places are alike.
                open.extend(items.iter().enumerate().take(64).map(|(i, value)| (format!("{at}/{i}"), value)));
            }
            _ => {}
        }
        if !at.is_empty() {
            list.push(at);
        }
    }
    list
}
