//! Scenes made from published numbers, as binary glTF files. The same call gives the same bytes.

mod cornell;
mod glb;

pub use cornell::{CornellLight, cornell_box};

/// A generated scene: its file name and what makes its content.
pub type Generated = (&'static str, fn() -> Vec<u8>);

/// All generated scenes.
pub const ALL: [Generated; 2] = [
    ("cornell-box.glb", || cornell_box(CornellLight::Area)),
    ("cornell-point.glb", || cornell_box(CornellLight::Point)),
];
