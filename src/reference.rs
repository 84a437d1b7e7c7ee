//! References, kept by what they depend on: made once, and resumed where more samples are wanted.
//!
//! Each is a folder of the cache, named by a hash of the files of the scene, the camera, the size, the knobs and the
//! texts of the pipeline, its parts and kernels. In it, `estimate-N.exr` holds the pictures after N samples for each
//! pixel, and `estimate.json`
//! says which is whole. The latter is written last, so that a run that was stopped leaves what there was before.

use crate::cache;
use crate::converge::{Estimate, Step, Until, VARIANCE, converge};
use crate::device::Gpu;
use crate::frame::Clock;
use crate::library::Library;
use crate::picture::{self, Picture};
use crate::plan::PlannedProgress;
use crate::problem::{Problem, Result};
use crate::scene::Scene;
use crate::session::{Prepared, Request, prepare};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Changes whenever estimates of before can't be gone on from.
const FORMAT: u32 = 1;
const FILE: &str = "estimate.json";

/// A folder of references.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
}

#[derive(Deserialize, Serialize)]
struct Kept {
    format: u32,
    samples: u64,
    seconds: f64,
    /// What it is of, for people who look into the folder.
    about: String,
}

/// An estimate, and what of it was there before.
#[derive(Clone, Debug)]
pub struct Made {
    pub estimate: Estimate,
    pub cached_samples: u64,
    /// All knobs, by path.
    pub knobs: BTreeMap<String, serde_json::Value>,
}

impl Cache {
    pub fn at(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// The one in the user's cache.
    pub fn of_user() -> Result<Self> {
        Ok(Self::at(cache::folder_of_user()?.join("references")))
    }

    /// The reference of a scene by the pipeline that `request` names, good enough for `until`: from the cache, as
    /// far as it is
    /// there, and the rest made now. `watch` sees how far it is.
    pub fn get(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        library: &Library,
        request: &Request,
        until: &Until,
        watch: &mut dyn FnMut(Step) -> Result<()>,
    ) -> Result<Made> {
        let prepared = prepare(request, library, Some(scene))?;
        let progress = progress(&prepared)?;
        let knobs = prepared.graph.plan.knobs.iter();
        let knobs: BTreeMap<String, serde_json::Value> =
            knobs.map(|k| (k.path.clone(), crate::record::value(&k.value))).collect();
        let folder = self.folder.join(key(scene, &prepared, &progress)?);
        let before = read(&folder).filter(|estimate| fits(estimate, &prepared, &progress));
        let cached_samples = before.as_ref().map_or(0, |estimate| estimate.samples);
        if let Some(before) = &before
            && is_enough(before, until)
        {
            return Ok(Made { estimate: before.clone(), cached_samples, knobs });
        }
        let mut request = request.clone();
        request.sets.push((progress.first.clone(), cached_samples.to_string()));
        let prepared = prepare(&request, library, Some(scene))?;
        let mut frame = prepared.realise(gpu, scene, Clock::Wall("not timed".to_owned()), None)?;
        let about = format!("{} by {}, {:?}", scene.name, request.pipeline, request.size);
        let mut keep = |step: Step, estimate: Option<&Estimate>| {
            if let Some(estimate) = estimate {
                write(&folder, estimate, &about)?;
            }
            watch(step)
        };
        let (estimate, _) = converge(gpu, &mut frame, &progress, before.as_ref(), until, &mut keep)?;
        write(&folder, &estimate, &about)?;
        Ok(Made { estimate, cached_samples, knobs })
    }
}

fn progress(prepared: &Prepared) -> Result<PlannedProgress> {
    let plan = &prepared.graph.plan;
    Ok(plan.progress.clone().ok_or_else(|| {
        Problem::input("no-progress", format!("`{}` does not get better from frame to frame", plan.name))
            .help("a reference is a pipeline that says `progress`, such as `reference`")
    })?)
}

/// Whether an estimate has all that the pipeline gives, and whole batches of it.
fn fits(estimate: &Estimate, prepared: &Prepared, progress: &PlannedProgress) -> bool {
    let has = |name: &str| estimate.pictures.contains_key(name);
    let outputs = &prepared.graph.plan.outputs;
    let all = outputs.iter().filter_map(|(name, ..)| Some((name, name.strip_suffix(VARIANCE)?)));
    let whole = estimate.samples > 0 && estimate.samples.is_multiple_of(progress.batch);
    whole && { all }.all(|(variance, mean)| has(variance) && has(mean))
}

fn is_enough(estimate: &Estimate, until: &Until) -> bool {
    let met = [
        until.samples.map(|samples| estimate.samples >= samples),
        until.time.map(|time| estimate.seconds >= time.as_secs_f64()),
        until.error.map(|error| estimate.worst_noise() <= error),
    ];
    met.into_iter().flatten().any(|met| met)
}

/// Hashes pieces so that none runs into the next.
#[derive(Default)]
struct Hash(blake3::Hasher);

impl Hash {
    fn add(&mut self, bytes: &[u8]) {
        self.0.update(&(bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
    }

    fn name(&self) -> String {
        self.0.finalize().to_hex()[..32].to_owned()
    }
}

/// A name for all of a scene that a picture of this size shows through this camera.
pub fn content(scene: &Scene, camera: usize, [width, height]: [u32; 2]) -> Result<String> {
    let mut hash = Hash::default();
    for file in &scene.files {
        let content = std::fs::read(file)
            .map_err(|e| Problem::input("scene-file", format!("can't read `{}`: {e}", file.display())))?;
        hash.add(&content);
    }
    // Where things are: the scene may be shown at any time of its motion.
    hash.add(bytemuck::cast_slice(&scene.instances));
    hash.add(bytemuck::cast_slice(&scene.lights));
    if let Some(camera) = scene.cameras.get(camera) {
        hash.add(bytemuck::bytes_of(&camera.uniform(f64::from(width) / f64::from(height))));
    }
    hash.add(bytemuck::cast_slice(&[width, height]));
    Ok(hash.name())
}

/// A name for all that the estimate depends on.
fn key(scene: &Scene, prepared: &Prepared, progress: &PlannedProgress) -> Result<String> {
    let mut hash = Hash::default();
    hash.add(&FORMAT.to_le_bytes());
    hash.add(content(scene, prepared.camera, prepared.size)?.as_bytes());
    let plan = &prepared.graph.plan;
    for knob in plan.knobs.iter().filter(|knob| knob.path != progress.first) {
        hash.add(knob.path.as_bytes());
        hash.add(knob.value.to_string().as_bytes());
    }
    // Not kernels alone: what they are told is worked out in the pipeline.
    for text in prepared.documents().values() {
        hash.add(text.as_bytes());
    }
    Ok(hash.name())
}

fn pictures_of(folder: &Path, samples: u64) -> PathBuf {
    folder.join(format!("estimate-{samples}.exr"))
}

/// What the folder holds; nothing if it is not whole.
fn read(folder: &Path) -> Option<Estimate> {
    let kept: Kept = serde_json::from_slice(&std::fs::read(folder.join(FILE)).ok()?).ok()?;
    let pictures = picture::read_exr(&pictures_of(folder, kept.samples)).ok()?;
    let whole = kept.format == FORMAT && !pictures.is_empty();
    whole.then(|| Estimate {
        samples: kept.samples,
        seconds: kept.seconds,
        pictures: pictures.into_iter().collect(),
    })
}

fn write(folder: &Path, estimate: &Estimate, about: &str) -> Result<()> {
    let failed = |e: std::io::Error| {
        Problem::failure("cache-write", format!("can't keep the reference in `{}`: {e}", folder.display()))
            .help("set VOXGI_CACHE to a folder that can be written to")
    };
    std::fs::create_dir_all(folder).map_err(failed)?;
    let layers: Vec<(&str, &Picture)> =
        estimate.pictures.iter().map(|(name, p)| (name.as_str(), p)).collect();
    let file = pictures_of(folder, estimate.samples);
    picture::write_exr(&file, &layers)?;
    let kept = Kept {
        format: FORMAT,
        samples: estimate.samples,
        seconds: estimate.seconds,
        about: about.to_owned(),
    };
    let json = serde_json::to_vec_pretty(&kept)
        .map_err(|e| Problem::failure("cache-write", format!("can't describe the reference: {e}")))?;
    picture::write_bytes(&folder.join(FILE), &json)?;
    for entry in std::fs::read_dir(folder).map_err(failed)?.flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|extension| extension == "exr") && path != file {
            // Another run may be reading it; then it stays.
            let _gone = std::fs::remove_file(path);
        }
    }
    Ok(())
}
