//! Reads path files.

use super::{CameraPath, Key, Unit};
use crate::problem::ron::RonFile;
use crate::problem::{Problem, Problems, Result, Source};
use glam::DVec3;
use ron::value::RawValue;
use serde::Deserialize;
use std::path::Path;

/// No path is longer; a file that is, is another kind of file.
const MOST_BYTES: u64 = 16 << 20;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Path")]
struct File<'a> {
    #[serde(borrow)]
    keys: Vec<&'a RawValue>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    #[serde(default)]
    frame: Option<u32>,
    #[serde(default)]
    time: Option<f64>,
    eye: [f64; 3],
    look_at: [f64; 3],
    #[serde(default)]
    fov_degrees: Option<f64>,
}

pub(super) fn read(path: &Path) -> Result<CameraPath> {
    let name = path.display().to_string();
    let unreadable =
        |why: String| Problem::input("path-file", format!("can't read the path `{name}`: {why}"));
    let length = std::fs::metadata(path).map_err(|e| unreadable(e.to_string()))?.len();
    if length > MOST_BYTES {
        return Err(unreadable(format!("it has {length} bytes, more than any path")).into());
    }
    let text = std::fs::read_to_string(path).map_err(|e| unreadable(e.to_string()))?;
    parse(Source::new(name, text))
}

pub(super) fn parse(source: Source) -> Result<CameraPath> {
    let ron = RonFile { source, code: "path", what: "the path" };
    let file: File = ron.parse()?;
    let mut problems = Vec::new();
    let mut keys: Vec<(Unit, Key)> = Vec::new();
    for raw in &file.keys {
        match key(&ron, raw) {
            Ok((unit, key)) => {
                problems.extend(keys.last().and_then(|before| disorder(before, &(unit, key.clone()))));
                keys.push((unit, key));
            }
            Err(problem) => problems.push(problem),
        }
    }
    if file.keys.len() < 2 {
        let whole = ron.source.at(0..ron.source.text().len());
        let message = format!("a path needs two keys at least, and has {}", file.keys.len());
        let help = "add `(frame: 0, eye: (0, 1, 3), look_at: (0, 1, 0))`, and one for a later frame";
        problems.push(Problem::input("path-keys", message).at(&whole, "this path").help(help));
    }
    Problems::check(problems)?;
    let unit = keys.first().map_or(Unit::Frames, |first| first.0);
    Ok(CameraPath { unit, keys: keys.into_iter().map(|(_, key)| key).collect() })
}

fn key(ron: &RonFile, raw: &RawValue) -> Result<(Unit, Key), Problem> {
    let entry: Entry = ron.value(raw)?;
    let place = ron.place(raw);
    let wrong = |message: &str| Problem::input("path-value", message).at(&place, "this key");
    let (unit, at) = match (entry.frame, entry.time) {
        (Some(frame), None) => (Unit::Frames, f64::from(frame)),
        (None, Some(time)) => (Unit::Time, time),
        _ => {
            return Err(wrong("a key has either a `frame` or a `time`")
                .help("`frame: 30` is a frame of the run; times are stretched over all of its frames"));
        }
    };
    let (eye, look_at) = (DVec3::from(entry.eye), DVec3::from(entry.look_at));
    if !(at.is_finite() && eye.as_vec3().is_finite() && look_at.as_vec3().is_finite()) {
        return Err(wrong("`time`, `eye` and `look_at` must be finite"));
    }
    if eye == look_at {
        return Err(wrong("`eye` and `look_at` are the same point"));
    }
    let fov = entry.fov_degrees;
    if fov.is_some_and(|fov| !(fov > 0.0 && fov < 180.0)) {
        return Err(wrong("`fov_degrees` must be between 0 and 180"));
    }
    Ok((unit, Key { at, eye, look_at, fov: fov.map(f64::to_radians), place }))
}

/// What is wrong with a key after the one before.
fn disorder(before: &(Unit, Key), key: &(Unit, Key)) -> Option<Problem> {
    let problem = if before.0 != key.0 {
        Problem::input("path-keys", "the keys of a path have all a `frame`, or all a `time`")
    } else if key.1.at <= before.1.at {
        let help = "each key must be later than the one before";
        Problem::input("path-keys", "the keys of a path are not in order").help(help)
    } else {
        return None;
    };
    Some(problem.at(&key.1.place, "this key").at(&before.1.place, "after this one"))
}
