//! Binary glTF files.

use serde_json::Value;
use std::fmt::Write;

/// A document and its buffer as one file: both chunks in multiples of 4 bytes.
pub fn glb(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut text = document.to_string();
    let spaces = text.len().next_multiple_of(4) - text.len();
    let _infallible = write!(text, "{:spaces$}", "");
    let zeros = vec![0; binary.len().next_multiple_of(4) - binary.len()];
    let word = |n: usize| (n as u32).to_le_bytes();
    let padded = binary.len() + zeros.len();
    let length = 12 + 8 + text.len() + 8 + padded;
    let pieces: [&[u8]; 10] = [
        b"glTF",
        &word(2),
        &word(length),
        &word(text.len()),
        b"JSON",
        text.as_bytes(),
        &word(padded),
        b"BIN\0",
        binary,
        &zeros,
    ];
    pieces.concat()
}
