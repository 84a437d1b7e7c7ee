//! Parts of one comparison, made apart, as one.

use crate::comparison::{Comparison, Pictures, SceneEntry};
use crate::problem::{Problem, Result};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Joins the comparisons in `folders` into `into`, pictures included. Runs that several have are taken from the first, and
/// references from that with the most samples.
///
/// Errors: `nothing-to-merge`, `unlike-comparisons`, and those of reading and writing.
pub fn merge(folders: &[PathBuf], into: &Path) -> Result<Comparison> {
    let mut parts = Vec::new();
    for folder in folders {
        let part = Comparison::read(folder)?.ok_or_else(|| {
            Problem::input("nothing-to-merge", format!("there is no comparison in `{}`", folder.display()))
                .help("name the folders that `voxgi sweep --shard` or `voxgi compare` wrote")
        })?;
        parts.push((folder, part));
    }
    let Some((_, first)) = parts.first() else {
        return Err(Problem::input("nothing-to-merge", "no folders were given").into());
    };
    let mut all = Comparison {
        name: into.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        scenes: Vec::new(),
        runs: Vec::new(),
        ..first.clone()
    };
    // All are looked at before anything is written.
    for (folder, part) in &parts {
        if !all.like(part) || !all.same_scenes(part) {
            let message = format!("`{}` can't stand beside `{}`", folder.display(), parts[0].0.display());
            let help = "scenes, size, exposure, curve, adapter, version and command must be the same";
            return Err(Problem::input("unlike-comparisons", message).help(help).into());
        }
        all.take(part.clone());
    }
    for (folder, part) in &parts {
        for file in files(part) {
            copy(folder, into, &file)?;
        }
    }
    all.write(into)?;
    Ok(all)
}

impl Comparison {
    /// Whether scenes that both have are the same.
    fn same_scenes(&self, other: &Self) -> bool {
        let twin = |scene: &SceneEntry| other.scenes.iter().find(|other| other.name == scene.name);
        self.scenes.iter().all(|scene| twin(scene).is_none_or(|twin| twin.content == scene.content))
    }

    fn take(&mut self, other: Self) {
        for scene in other.scenes {
            match self.scenes.iter_mut().find(|own| own.name == scene.name) {
                None => self.scenes.push(scene),
                Some(own) => {
                    for (name, reference) in scene.references {
                        let better =
                            own.references.get(&name).is_none_or(|own| own.samples < reference.samples);
                        if better {
                            own.references.insert(name, reference);
                        }
                    }
                }
            }
        }
        for run in other.runs {
            if !self.runs.iter().any(|own| (&own.scene, &own.name) == (&run.scene, &run.name)) {
                self.runs.push(run);
            }
        }
    }
}

/// All files that a comparison names.
fn files(comparison: &Comparison) -> BTreeSet<String> {
    let references = comparison.scenes.iter().flat_map(|scene| scene.references.values());
    let pictures = references.flat_map(|reference| reference.pictures.values());
    let pictures = pictures.chain(comparison.runs.iter().flat_map(|run| run.pictures.values()));
    let of_pictures = pictures.flat_map(|Pictures { exr, png, difference, flip }| {
        [Some(exr.clone()), Some(png.clone()), difference.clone(), flip.clone()]
    });
    let documents = comparison.runs.iter().flat_map(|run| run.documents.values().cloned());
    of_pictures.flatten().chain(documents).collect()
}

fn copy(from: &Path, into: &Path, file: &str) -> Result<()> {
    let failed = |e: std::io::Error| {
        Problem::failure("merge-copy", format!("can't copy `{file}` from `{}`: {e}", from.display()))
    };
    let inside = Path::new(file).components().all(|c| matches!(c, std::path::Component::Normal(_)));
    if !inside {
        let message = format!("`{}` names a file outside of its folder: `{file}`", from.display());
        return Err(Problem::input("merge-path", message).into());
    }
    let to = into.join(file);
    if let Some(folder) = to.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    if from != into {
        std::fs::copy(from.join(file), &to).map_err(failed)?;
    }
    Ok(())
}
