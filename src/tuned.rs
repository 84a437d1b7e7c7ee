//! Values that tuning found, kept for `--tuned`.
//!
//! Each is a JSON file of its own in the folder `tuned` of the user's folder, written whole or not at all, so that
//! several tunings at once don't get in each other's way. It holds for one adapter (name, driver, its version), one
//! pipeline, its parts and a knob; a later one takes its place. Scenes, size and other knobs are those it was found
//! with, and bind nobody.

use crate::cache;
use crate::expr::Value;
use crate::picture;
use crate::plan::{Plan, PlannedKnob};
use crate::problem::{Problem, Result};
use crate::record::Adapter;
use crate::tune::{Outcome, values};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files of other numbers are not looked at.
const FORMAT: u32 = 1;

/// A file.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Kept {
    pub format: u32,
    pub adapter: Adapter,
    pub pipeline: String,
    /// Role → part, all of them.
    pub parts: BTreeMap<String, String>,
    /// Its path.
    pub knob: String,
    pub value: serde_json::Value,
    /// `time` or `error`, and of what: see [`Outcome`].
    pub least: String,
    pub of: String,
    pub scenes: Vec<String>,
    pub size: [u32; 2],
    /// Knobs and parts that were set, as written.
    pub set: BTreeMap<String, String>,
    /// UTC, `2026-11-22T08:30:00Z`.
    pub when: String,
    pub version: String,
}

/// A kept value in a record: where it is from.
#[derive(Clone, Debug, Deserialize, Eq, PartialEq, Serialize)]
pub struct Used {
    pub value: serde_json::Value,
    /// On which it was found; several are joined by commas.
    pub scene: String,
    pub when: String,
}

/// By the knob's path.
pub type Uses = BTreeMap<String, Used>;

/// The folder.
#[derive(Clone, Debug)]
pub struct Shelf {
    folder: PathBuf,
}

impl Kept {
    pub fn new(outcome: &Outcome, when: String) -> Self {
        Self {
            format: FORMAT,
            adapter: outcome.adapter.clone(),
            pipeline: outcome.pipeline.clone(),
            parts: outcome.parts.clone(),
            knob: outcome.knob.clone(),
            value: outcome.chosen.clone(),
            least: outcome.least.to_owned(),
            of: outcome.of.clone(),
            scenes: outcome.scenes.clone(),
            size: outcome.size,
            set: outcome.set.clone(),
            when,
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }

    /// Of all that it holds for.
    fn file_name(&self) -> String {
        let Adapter { name, driver, driver_info, .. } = &self.adapter;
        let parts = self.parts.iter().flat_map(|(role, part)| [role, part]);
        let all = [name, driver, driver_info, &self.pipeline, &self.knob].into_iter().chain(parts);
        let mut hash = blake3::Hasher::new();
        for text in all {
            hash.update(&(text.len() as u64).to_le_bytes());
            hash.update(text.as_bytes());
        }
        let safe = |c: char| if c.is_ascii_alphanumeric() || c == '_' || c == '.' { c } else { '-' };
        let about: String = format!("{}-{}", self.pipeline, self.knob).chars().map(safe).take(80).collect();
        format!("{about}-{}.json", &hash.finalize().to_hex()[..16])
    }

    fn is_of(&self, plan: &Plan) -> bool {
        self.pipeline == plan.name && self.parts == plan.parts
    }
}

/// Whether what holds for one holds for the other: kind and backend follow from the driver.
fn same(a: &Adapter, b: &Adapter) -> bool {
    (&a.name, &a.driver, &a.driver_info) == (&b.name, &b.driver, &b.driver_info)
}

impl Shelf {
    pub fn at(folder: PathBuf) -> Self {
        Self { folder }
    }

    pub fn of_user() -> Result<Self> {
        Ok(Self::at(cache::folder_of_user()?.join("tuned")))
    }

    /// Writes the file, and says which.
    pub fn keep(&self, kept: &Kept) -> Result<PathBuf> {
        let failed = |e: &dyn std::fmt::Display| {
            let message = format!("can't keep the value in `{}`: {e}", self.folder.display());
            Problem::failure("cache-write", message)
                .help("set VOXGI_CACHE to a folder that can be written to")
        };
        std::fs::create_dir_all(&self.folder).map_err(|e| failed(&e))?;
        let json = serde_json::to_vec_pretty(kept).map_err(|e| failed(&e))?;
        let path = self.folder.join(kept.file_name());
        picture::write_bytes(&path, &json)?;
        Ok(path)
    }

    /// All files of the folder, in the order of their names.
    fn all(&self) -> Result<Vec<Kept>> {
        let mut paths: Vec<PathBuf> = std::fs::read_dir(&self.folder)
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.path())
            .collect();
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
        paths.sort();
        let mut all = Vec::new();
        for path in paths {
            all.extend(read(&path)?);
        }
        Ok(all)
    }

    /// The kept values for a planned pipeline on an adapter, except of knobs that are set. Errors are inputs:
    /// `not-tuned` (there is none), `tuned-not-allowed` (the knob does not allow it any more),
    /// `tuned-file` (a file is broken).
    pub fn uses(&self, plan: &Plan, adapter: &Adapter) -> Result<Uses> {
        let all = self.all()?;
        let of_plan: Vec<&Kept> = all
            .iter()
            .filter(|kept| kept.is_of(plan) && plan.knobs.iter().any(|knob| knob.path == kept.knob))
            .collect();
        let here = of_plan.iter().filter(|kept| same(&kept.adapter, adapter));
        let mut uses = Uses::new();
        let mut found = false;
        for kept in here {
            found = true;
            let Some(knob) = plan.knobs.iter().find(|knob| knob.path == kept.knob && !knob.set) else {
                continue;
            };
            allowed(knob, kept)?;
            let (scene, when) = (kept.scenes.join(", "), kept.when.clone());
            uses.insert(kept.knob.clone(), Used { value: kept.value.clone(), scene, when });
        }
        if !found {
            return Err(none(plan, adapter, &of_plan, &all).into());
        }
        Ok(uses)
    }
}

impl Used {
    /// As `--set` takes it.
    pub fn text(&self) -> String {
        text(&self.value)
    }
}

/// What to set, from what is used.
pub fn sets(uses: &Uses) -> impl Iterator<Item = (String, String)> {
    uses.iter().map(|(knob, used)| (knob.clone(), used.text()))
}

fn text(value: &serde_json::Value) -> String {
    match value {
        serde_json::Value::String(text) => text.clone(),
        // Whole numbers without decimals.
        serde_json::Value::Number(number) => {
            values::text(&Value::Number(number.as_f64().unwrap_or(f64::NAN)))
        }
        other => other.to_string(),
    }
}

fn read(path: &Path) -> Result<Option<Kept>> {
    let broken = |why: String| {
        Problem::input("tuned-file", format!("`{}` holds no value of a knob: {why}", path.display()))
            .help("delete it, and tune again")
    };
    let bytes = std::fs::read(path).map_err(|e| broken(e.to_string()))?;
    let json: serde_json::Value = serde_json::from_slice(&bytes).map_err(|e| broken(e.to_string()))?;
    if json["format"] != FORMAT {
        return Ok(None);
    }
    Ok(Some(serde_json::from_value(json).map_err(|e| broken(e.to_string()))?))
}

fn allowed(knob: &PlannedKnob, kept: &Kept) -> Result<()> {
    if let Err(why) = knob.read(&text(&kept.value)) {
        let mut message = format!("the kept value {} of `{}` is not allowed any more", kept.value, knob.path);
        why.help.iter().for_each(|help| message.push_str(&format!(": {help}")));
        return Err(Problem::input("tuned-not-allowed", message)
            .at(&knob.place, "declared here")
            .help(format!(
                "find another one: {}",
                command(&kept.pipeline, &kept.parts, &kept.knob, &kept.least)
            ))
            .into());
    }
    Ok(())
}

/// The command that finds a value.
fn command(pipeline: &str, parts: &BTreeMap<String, String>, knob: &str, least: &str) -> String {
    let parts: String = parts.iter().map(|(role, part)| format!(" --part {role}={part}")).collect();
    format!("`voxgi tune SCENE -p {pipeline}{parts} --knob {knob} --least {least}`")
}

/// There is no value, but perhaps for something near.
fn none(plan: &Plan, adapter: &Adapter, of_plan: &[&Kept], all: &[Kept]) -> Problem {
    let name = &plan.name;
    let near = || all.iter().find(|kept| kept.pipeline == *name && same(&kept.adapter, adapter));
    let (message, help) = if let Some(kept) = of_plan.first() {
        let of = &kept.adapter;
        (
            format!(
                "no knob of `{name}` was tuned on {} ({} {}), but `{}` was on {} ({} {})",
                adapter.name,
                adapter.driver,
                adapter.driver_info,
                kept.knob,
                of.name,
                of.driver,
                of.driver_info
            ),
            command(name, &plan.parts, &kept.knob, &kept.least),
        )
    } else if let Some(kept) = near() {
        (
            format!("no knob of `{name}` was tuned with these parts, but `{}` was with others", kept.knob),
            command(name, &plan.parts, &kept.knob, &kept.least),
        )
    } else {
        (
            format!("no knob of `{name}` was tuned on {}", adapter.name),
            format!("`voxgi tune SCENE -p {name} --knob KNOB --least time|error`"),
        )
    };
    Problem::input("not-tuned", message).help(format!("{help} finds and keeps a value"))
}
