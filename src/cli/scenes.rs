//! `voxgi scenes`: the scenes there are, how to get those that are not, and what one scene has.

use super::{print, print_json};
use crate::problem::{Problems, Result};
use crate::scene::features::{Feature, features};
use crate::scene::listing::{Entry, Outline, SCENES, list};
use crate::scene::{self, Scene, generate};
use clap::Args;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Where scenes are looked for and written by default.
const FOLDER: &str = "scenes";

#[derive(Args)]
pub struct ScenesArgs {
    /// Folders to list, or scenes to load and describe. Default: the folder `scenes`, and that of VOXGI_SCENES.
    paths: Vec<PathBuf>,
    /// Print one JSON object.
    #[arg(long)]
    pub json: bool,
}

pub fn run(args: &ScenesArgs) -> Result<()> {
    let (mut text, mut values, mut problems) = (String::new(), Vec::new(), Vec::new());
    let paths = if args.paths.is_empty() { default_folders() } else { args.paths.clone() };
    for path in &paths {
        if !path.is_dir() {
            match scene::load(path) {
                Ok(scene) => {
                    text += &described(path, &scene);
                    values.push(loaded_json(path, &scene));
                }
                Err(found) => problems.extend(found.iter().cloned()),
            }
            continue;
        }
        let _infallible = writeln!(text, "{}", path.display());
        for (path, entry) in list(path)? {
            text += &line(&path, entry.as_ref().ok());
            match entry {
                Ok(entry) => values.push(entry_json(&entry)),
                // One broken scene does not hide the others.
                Err(found) => problems.extend(found.iter().cloned()),
            }
        }
        text.push('\n');
    }
    if args.paths.is_empty() {
        let absent = generate::ALL
            .map(|(name, _)| name)
            .into_iter()
            .filter(|name| !Path::new(FOLDER).join(name).is_file());
        for name in absent {
            let _infallible = writeln!(text, "built in: {name}; `voxgi generate` writes it to `{FOLDER}/`");
            values.push(json!({ "path": null, "name": name, "get": "voxgi generate" }));
        }
    }
    if !args.json {
        print(&text);
    } else if problems.is_empty() {
        print_json(&json!({ "schema": crate::record::SCHEMA, "scenes": values }));
    }
    // With `--json`, the one object says what is wrong.
    Problems::check(problems).map(|_| ())
}

fn default_folders() -> Vec<PathBuf> {
    let elsewhere = std::env::var_os(SCENES).map(PathBuf::from);
    std::iter::once(PathBuf::from(FOLDER)).chain(elsewhere).filter(|folder| folder.is_dir()).collect()
}

fn line(path: &Path, entry: Option<&Entry>) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut text = format!("  {name:<28}");
    let _infallible = match entry {
        None => writeln!(text, "  can't be read"),
        Some(Entry { outline: Some(outline), .. }) => writeln!(text, "{}", counts(outline)),
        Some(Entry { about, .. }) => {
            let gltf = about.as_ref().map_or("", |about| &about.gltf);
            writeln!(text, "  its model {gltf} is not there")
        }
    };
    let Some(about) = entry.and_then(|entry| entry.about.as_ref()) else { return text };
    let get = if about.model.is_some() { "" } else { &about.get };
    for (what, said) in [("", &*about.about), ("licence: ", &about.licence), ("to get it: ", get)] {
        if !said.is_empty() {
            let _infallible = writeln!(text, "      {what}{said}");
        }
    }
    text
}

fn counts(outline: &Outline) -> String {
    let Outline { triangles, materials, lights, cameras } = outline;
    format!("{triangles:>9} triangles {materials:>4} materials {lights:>3} lights {cameras:>3} cameras")
}

fn described(path: &Path, scene: &Scene) -> String {
    let mut text = format!("{}\n", path.display());
    let values = features(scene);
    let width = values.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, feature) in values {
        let value = match feature {
            Feature::Number(number) => number.to_string(),
            Feature::Flag(flag) => flag.to_string(),
            Feature::Vector(v) => v.map(|x| x.to_string()).join(" "),
        };
        let _infallible = writeln!(text, "  {name:<width$}  {value}");
    }
    for (i, camera) in scene.cameras.iter().enumerate() {
        let _infallible = writeln!(text, "  {:<width$}  {}", format!("camera {i}"), camera.name);
    }
    for lack in &scene.lacks {
        let _infallible = writeln!(text, "  {lack}");
    }
    text
}

fn loaded_json(path: &Path, scene: &Scene) -> Value {
    let features: serde_json::Map<String, Value> = features(scene)
        .into_iter()
        .map(|(name, feature)| {
            let value = match feature {
                Feature::Number(number) => json!(number),
                Feature::Flag(flag) => json!(flag),
                Feature::Vector(v) => json!(v),
            };
            (name.to_owned(), value)
        })
        .collect();
    json!({
        "path": path, "name": scene.name, "files": scene.files, "features": features,
        "cameras": scene.cameras.iter().map(|camera| &camera.name).collect::<Vec<_>>(),
        "lacks": scene.lacks.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}

fn entry_json(entry: &Entry) -> Value {
    let mut value = json!({ "path": entry.path });
    if let Some(Outline { triangles, materials, lights, cameras }) = entry.outline {
        value["counts"] =
            json!({ "triangles": triangles, "materials": materials, "lights": lights, "cameras": cameras });
    }
    if let Some(about) = &entry.about {
        value["setting"] = json!({
            "about": about.about, "licence": about.licence, "get": about.get, "gltf": about.gltf, "model": about.model,
        });
    }
    value
}
