//! What scenes a folder has, without loading them.

pub use super::gltf::outline::Outline;
pub use super::setting::{About, SCENES};

use super::{gltf, setting};
use crate::problem::{Problem, Result};
use std::path::{Path, PathBuf};

/// A scene that can be named by its file.
#[derive(Clone, Debug)]
pub struct Entry {
    pub path: PathBuf,
    /// Only of a setting.
    pub about: Option<About>,
    /// Numbers of its things, with what a setting adds; `None` where a setting's model is missing.
    pub outline: Option<Outline>,
}

/// The glTF files and settings in `folder`, but not in folders below it, by name. What is wrong with a file stands in its
/// place.
///
/// Errors: `scene-folder` if the folder can't be read.
pub fn list(folder: &Path) -> Result<Vec<(PathBuf, Result<Entry>)>> {
    let unreadable = |error: std::io::Error| {
        Problem::input("scene-folder", format!("can't read the folder `{}`: {error}", folder.display()))
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.is_file() && kind(&path).is_some() {
            paths.push(path);
        }
    }
    paths.sort_unstable();
    Ok(paths.into_iter().map(|path| (path.clone(), entry(path))).collect())
}

/// Whether a file is a setting, by its name; `None` if it is no scene.
fn kind(path: &Path) -> Option<bool> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "gltf" | "glb" => Some(false),
        "ron" => Some(true),
        _ => None,
    }
}

fn entry(path: PathBuf) -> Result<Entry> {
    if kind(&path) != Some(true) {
        let outline = gltf::outline::read(&path)?;
        return Ok(Entry { path, about: None, outline: Some(outline) });
    }
    let about = setting::about(&path)?;
    let outline = about.model.as_deref().map(gltf::outline::read).transpose()?;
    let outline = outline.map(|of_model| Outline {
        lights: of_model.lights + about.lights,
        cameras: of_model.cameras + about.cameras,
        ..of_model
    });
    Ok(Entry { path, about: Some(about), outline })
}
