//! A scene's references, and runs held against them.

use super::Plan;
use super::files::{self, Written};
use super::subject::{Done, Subject};
use crate::comparison::{Memory, Reference, Run, StageTime, Timing};
use crate::converge::{Estimate, Step};
use crate::device::Gpu;
use crate::expr::Value;
use crate::library::Library;
use crate::measure::{self, Input, Kind, Masks, Measures};
use crate::picture::Picture;
use crate::problem::Result;
use crate::record;
use crate::reference::Cache;
use crate::scene::Scene;
use crate::session::{Prepared, Request, prepare};
use std::collections::BTreeMap;

/// What light a run simulates, as knobs of the reference.
pub struct Light {
    /// Of the reference that simulates it.
    pub name: String,
    sets: Vec<(String, String)>,
}

/// The light of a run: the reference's knobs that its pipeline has too.
pub fn light(plan: &Plan, library: &Library, run: &Prepared) -> Result<Light> {
    let reference = prepare(&request(plan, Vec::new()), library, None)?;
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let mut sets = Vec::new();
    // Knobs of its parts are how pictures are shown.
    for knob in reference.graph.plan.knobs.iter().filter(|knob| !knob.set && !knob.path.contains('.')) {
        let same = run.graph.plan.knobs.iter().find(|own| last(&own.path) == last(&knob.path));
        if let Some(own) = same {
            let value = match &own.value {
                Value::Text(text) => text.clone(),
                other => other.to_string(),
            };
            sets.push((knob.path.clone(), value));
        }
    }
    let all = sets.iter().chain(&plan.reference_sets).map(|(key, value)| format!("{key}={value}"));
    let name = std::iter::once(plan.reference.clone()).chain(all).collect::<Vec<_>>().join(", ");
    Ok(Light { name, sets })
}

fn request(plan: &Plan, sets: Vec<(String, String)>) -> Request {
    Request {
        pipeline: plan.reference.clone(),
        sets: sets.into_iter().chain(plan.reference_sets.iter().cloned()).collect(),
        size: plan.size,
        camera: plan.camera,
        ..Request::default()
    }
}

/// A reference at hand.
pub struct Truth {
    estimate: Estimate,
    masks: Option<Masks>,
    noise: BTreeMap<String, f64>,
}

/// Gets the reference from the cache, or makes it, and writes its pictures.
pub fn make(
    plan: &Plan,
    library: &Library,
    cache: &Cache,
    scene: &Scene,
    light: &Light,
    watch: &mut dyn FnMut(Step) -> Result<()>,
) -> Result<(Truth, Reference)> {
    let (truth, made) = get(plan, library, cache, scene, light, watch)?;
    let estimate = &truth.estimate;
    let shown: BTreeMap<&str, &Picture> = estimate
        .pictures
        .iter()
        .filter(|(name, _)| !name.ends_with("_variance"))
        .map(|(name, picture)| (name.as_str(), picture))
        .collect();
    let into = format!("{}/{}", files::slug(&scene.name), files::slug(&light.name));
    let pictures = files::write(plan, &into, &shown, &BTreeMap::new())?;
    let mean = |picture: &Picture| {
        let colors = picture.channels().min(3) as usize;
        let sum: f64 = picture.texels().flat_map(|texel| &texel[..colors]).map(|x| f64::from(*x)).sum();
        sum / (picture.texels().len() * colors) as f64
    };
    let entry = Reference {
        pipeline: plan.reference.clone(),
        knobs: made.knobs,
        samples: estimate.samples,
        seconds: estimate.seconds,
        cached_samples: made.cached_samples,
        noise: truth.noise.clone(),
        mean: shown.iter().map(|(name, picture)| ((*name).to_owned(), mean(picture))).collect(),
        pictures,
    };
    Ok((truth, entry))
}

/// What is known of a reference beside its pictures.
pub struct Made {
    knobs: BTreeMap<String, serde_json::Value>,
    cached_samples: u64,
}

/// Gets the reference from the cache, or makes it.
pub fn get(
    plan: &Plan,
    library: &Library,
    cache: &Cache,
    scene: &Scene,
    light: &Light,
    watch: &mut dyn FnMut(Step) -> Result<()>,
) -> Result<(Truth, Made)> {
    let gpu = Gpu::open(plan.adapter.as_deref(), &plan.limits)?;
    let made = cache.get(&gpu, scene, library, &request(plan, light.sets.clone()), &plan.until, watch)?;
    let estimate = made.estimate;
    let masks = match (estimate.pictures.get("depth"), estimate.pictures.get("direct")) {
        (Some(depth), Some(direct)) => Some(Masks::new(
            &Input { name: "the reference's depth", picture: depth },
            &Input { name: "the reference's direct", picture: direct },
        )?),
        _ => None,
    };
    let names: Vec<String> = estimate.means().map(|(name, _, _)| name.to_owned()).collect();
    let noise: BTreeMap<String, f64> =
        names.into_iter().filter_map(|name| estimate.noise(&name).map(|noise| (name, noise))).collect();
    let about = Made { knobs: made.knobs, cached_samples: made.cached_samples };
    Ok((Truth { estimate, masks, noise }, about))
}

impl Truth {
    /// The relMSE of an output, or the most that is within the reference's noise.
    /// `None` if the reference has no such output, or it has no relMSE.
    pub fn error(&self, output: &str, picture: &Picture, options: &measure::Options) -> Result<Option<f64>> {
        let Some(truth) = self.estimate.pictures.get(output) else { return Ok(None) };
        let (test, truth) = (colors(picture), colors(truth));
        let input = Input { name: output, picture: &test };
        let truth = measure::Truth { name: "the reference", picture: &truth, variance: None };
        let errors = Measures::new(Kind::of(output), input, truth, options)?.errors(None)?;
        let noise = self.noise.get(output).copied().unwrap_or(0.0);
        Ok(errors.get("relmse").map(|relmse| measure::above_noise(*relmse, noise)))
    }

    /// Measures the run, and writes its pictures.
    pub fn hold_against(
        &self,
        plan: &Plan,
        scene: &Scene,
        subject: &Subject,
        reference: &str,
        done: Done,
    ) -> Result<Run> {
        let name = subject.name();
        let mut errors: BTreeMap<String, BTreeMap<String, f64>> = BTreeMap::new();
        let mut masked: BTreeMap<String, BTreeMap<String, BTreeMap<String, f64>>> = BTreeMap::new();
        let mut within_noise = Vec::new();
        let mut maps = BTreeMap::new();
        let owned = |errors: BTreeMap<&'static str, f64>| -> BTreeMap<String, f64> {
            errors.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
        };
        for (output, picture) in &done.pictures {
            let Some(truth) = self.estimate.pictures.get(output) else { continue };
            let (test_name, truth_name) = (format!("{name}/{output}"), format!("{reference}/{output}"));
            // Alpha says what no other output of the same name has to say.
            let (test, truth) = (colors(picture), colors(truth));
            let variance = self.estimate.pictures.get(&format!("{output}_variance")).map(colors);
            let input = Input { name: &test_name, picture: &test };
            let truth = measure::Truth { name: &truth_name, picture: &truth, variance: variance.as_ref() };
            let measures = Measures::new(Kind::of(output), input, truth, &plan.measure)?;
            let whole = measures.errors(None)?;
            if let (Some(relmse), Some(noise)) = (whole.get("relmse"), self.noise.get(output))
                && measure::within_noise(*relmse, *noise)
            {
                within_noise.push(output.clone());
            }
            errors.insert(output.clone(), owned(whole));
            for (mask, pixels) in self.masks.iter().flat_map(Masks::named) {
                let of_mask = masked.entry(mask.to_owned()).or_default();
                of_mask.insert(output.clone(), owned(measures.errors(Some(pixels))?));
            }
            maps.insert(
                output.as_str(),
                Written { difference: measures.difference_map(), flip: measures.flip_map() },
            );
        }
        let shown = done.pictures.iter().map(|(name, picture)| (name.as_str(), picture)).collect();
        let into = format!("{}/{}", files::slug(&scene.name), files::slug(&name));
        let pictures = files::write(plan, &into, &shown, &maps)?;
        let documents = done.documents.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        let documents = files::documents(plan, &documents)?;
        let (clock, clock_reason) = record::clock(&done.clock);
        let samples: Vec<Option<f64>> = done.samples.frames.iter().map(|t| t.frame).collect();
        let gpu_ms = Timing::of(samples);
        Ok(Run {
            name,
            scene: scene.name.clone(),
            reference: reference.to_owned(),
            pipeline: subject.pipeline.clone(),
            parts: done.parts,
            knobs: done.knobs,
            set: subject.coordinates(),
            tuned: subject.tuned.clone(),
            clock: clock.to_owned(),
            clock_reason,
            repeats_ms: vec![gpu_ms.median],
            gpu_ms,
            first_use_ms: done.samples.first.as_ref().and_then(|t| t.frame),
            encode_ms: done.samples.median(|t| Some(t.encode)),
            stages: done.stages.into_iter().map(stage).collect(),
            errors,
            masked,
            within_noise,
            memory: Memory { peak_bytes: done.peak_bytes },
            lacks: done.lacks,
            pictures,
            documents,
        })
    }
}

fn stage(stage: record::StageRecord) -> StageTime {
    StageTime {
        path: stage.path,
        status: stage.status.to_owned(),
        reason: stage.reason,
        gpu_ms: stage.gpu_ms,
        spread: stage.spread,
        samples_ms: stage.samples_ms,
    }
}

/// The picture without its alpha.
fn colors(picture: &Picture) -> Picture {
    let count = picture.channels().min(3);
    let data = picture.texels().flat_map(|texel| texel[..count as usize].iter().copied()).collect();
    Picture::new(picture.width(), picture.height(), count, data).unwrap_or_else(|| picture.clone())
}
