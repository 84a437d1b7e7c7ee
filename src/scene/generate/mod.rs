//! Scenes made by a command, as binary glTF files. The same call gives the same bytes.
//!
//! | file | what |
//! |---|---|
//! | `cornell` | a room from published numbers |
//! | [`hairball`] | very many thin triangles |
//! | [`triangle`] | one triangle as large as the scene |
//! | `glb` | the writer |

mod cornell;
mod glb;
pub mod hairball;
pub mod triangle;

pub use cornell::{CornellLight, cornell_box};

/// A generated scene: its file name and what makes its content.
pub type Generated = (&'static str, fn() -> Vec<u8>);

/// All that are kept in this repository.
pub const ALL: [Generated; 2] = [
    ("cornell-box.glb", || cornell_box(CornellLight::Area)),
    ("cornell-point.glb", || cornell_box(CornellLight::Point)),
];

/// Those that are made where they are wanted.
pub const OTHERS: [Generated; 2] = [("triangle.glb", triangle::make), ("hairball.glb", hairball::make)];

/// The scene of this name, with or without the file's extension.
pub fn find(name: &str) -> Option<Generated> {
    ALL.into_iter().chain(OTHERS).find(|(file, _)| file.strip_suffix(".glb") == Some(name) || *file == name)
}
