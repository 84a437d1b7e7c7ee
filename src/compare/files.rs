//! Pictures of a comparison's folder.

use super::Plan;
use crate::comparison::Pictures;
use crate::measure::Kind;
use crate::picture::{self, Encoded, Picture};
use crate::problem::{Problem, Result};
use std::collections::BTreeMap;

/// Maps of errors of an output.
pub struct Written {
    pub difference: Option<Encoded>,
    pub flip: Option<Encoded>,
}

/// Writes pictures and maps, by output, into a folder below the comparison's.
pub fn write(
    plan: &Plan,
    into: &str,
    pictures: &BTreeMap<&str, &Picture>,
    maps: &BTreeMap<&str, Written>,
) -> Result<BTreeMap<String, Pictures>> {
    let folder = plan.folder.join(into);
    std::fs::create_dir_all(&folder).map_err(|e| {
        Problem::failure("unwritable", format!("can't make the folder `{}`: {e}", folder.display()))
    })?;
    let layers: Vec<(&str, &Picture)> = pictures.iter().map(|(name, picture)| (*name, *picture)).collect();
    picture::write_exr(&folder.join("outputs.exr"), &layers)?;
    let mut written = BTreeMap::new();
    for (output, shown) in pictures {
        let relative = |kind: &str| format!("{into}/{output}{kind}.png");
        let (curve, exposure) = Kind::of(output).display(&plan.measure);
        picture::write_png(&plan.folder.join(relative("")), &visible(output, shown), curve, exposure)?;
        let mut entry =
            Pictures { exr: format!("{into}/outputs.exr"), png: relative(""), ..Pictures::default() };
        if let Some(maps) = maps.get(output) {
            let map = |kind: &str, map: &Option<Encoded>| -> Result<Option<String>> {
                let Some(map) = map else { return Ok(None) };
                picture::write_encoded(&plan.folder.join(relative(kind)), map)?;
                Ok(Some(relative(kind)))
            };
            entry.difference = map("-difference", &maps.difference)?;
            entry.flip = map("-flip", &maps.flip)?;
        }
        written.insert((*output).to_owned(), entry);
    }
    Ok(written)
}

/// Where copies of what was run are, by the names of the files; named by their content: runs share them.
pub fn copies(documents: &BTreeMap<&str, &str>) -> BTreeMap<String, String> {
    let copy = |(name, text): (&&str, &&str)| {
        let hash = blake3::hash(text.as_bytes()).to_hex();
        let extension = name.rsplit('.').next().unwrap_or("txt");
        ((*name).to_owned(), format!("documents/{}.{extension}", &hash[..16]))
    };
    documents.iter().map(copy).collect()
}

/// Writes the copies.
pub fn documents(plan: &Plan, documents: &BTreeMap<&str, &str>) -> Result<BTreeMap<String, String>> {
    let folder = plan.folder.join("documents");
    std::fs::create_dir_all(&folder).map_err(|e| {
        Problem::failure("unwritable", format!("can't make the folder `{}`: {e}", folder.display()))
    })?;
    let copies = copies(documents);
    for (name, relative) in &copies {
        let path = plan.folder.join(relative);
        if let Some(text) = documents.get(name.as_str()).filter(|_| !path.exists()) {
            picture::write_bytes(&path, text.as_bytes())?;
        }
    }
    Ok(copies)
}

/// What a PNG can show of numbers that are no light: directions as ½ + ½ n, distances as a part of the largest.
fn visible(output: &str, picture: &Picture) -> Picture {
    let map = |f: &dyn Fn(f32) -> f32| {
        let data = picture.data().iter().map(|x| f(*x)).collect();
        Picture::new(picture.width(), picture.height(), picture.channels(), data)
    };
    let greatest = picture.data().iter().fold(0.0, |greatest: f32, x| greatest.max(*x)).max(1e-20);
    let shown = match output {
        "normal" => map(&|x| 0.5 + 0.5 * x),
        "depth" => map(&|x| x / greatest),
        _ => None,
    };
    shown.unwrap_or_else(|| picture.clone())
}

/// A name as that of a folder: letters, digits, and one `-` for all between.
pub fn slug(name: &str) -> String {
    let mut slug = String::new();
    for c in name.chars() {
        match c {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '.' | '_' => slug.push(c),
            _ if !slug.ends_with('-') => slug.push('-'),
            _ => {}
        }
    }
    // Names that differ only in what is lost here must not meet.
    let hash = blake3::hash(name.as_bytes()).to_hex();
    format!("{}-{}", slug.trim_matches('-').chars().take(60).collect::<String>(), &hash[..6])
}
