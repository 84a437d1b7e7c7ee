//! One thing that is compared: a pipeline with parts and knobs; and its run on a scene.

use super::Plan;
use crate::device::Gpu;
use crate::frame::{Changes, Clock, calibrate};
use crate::library::Library;
use crate::picture::Picture;
use crate::problem::{Problem, Result};
use crate::record::{self, Samples};
use crate::scene::Scene;
use crate::scene::features::{self, Feature};
use crate::session::{Prepared, Request, prepare};
use crate::tuned::{self, Uses};
use std::collections::BTreeMap;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Subject {
    pub pipeline: String,
    /// Role and part.
    pub parts: Vec<(String, String)>,
    /// Knob and value.
    pub sets: Vec<(String, String)>,
    /// The flag of an effect that the scene calls for, such as `scene.emissive`, and whether it is simulated.
    pub effects: Vec<(String, bool)>,
    /// Values that tuning found, of knobs that are not set.
    pub tuned: Uses,
}

/// What a run gave.
pub struct Done {
    pub samples: Samples,
    pub clock: Clock,
    pub stages: Vec<record::StageRecord>,
    pub knobs: BTreeMap<String, serde_json::Value>,
    pub parts: BTreeMap<String, String>,
    pub peak_bytes: u64,
    pub lacks: Vec<String>,
    pub pictures: BTreeMap<String, Picture>,
    /// Name and text.
    pub documents: BTreeMap<String, String>,
}

impl Subject {
    /// The pipeline, and what is not its default.
    pub fn name(&self) -> String {
        let all = self.settings().map(|(key, value)| format!("{key}={value}"));
        std::iter::once(self.pipeline.clone()).chain(all).collect::<Vec<_>>().join(", ")
    }

    /// The coordinates in which subjects differ.
    pub fn coordinates(&self) -> BTreeMap<String, String> {
        self.settings().collect()
    }

    fn settings(&self) -> impl Iterator<Item = (String, String)> {
        let effects = self.effects.iter().map(|(name, simulated)| (name.clone(), simulated.to_string()));
        self.parts.iter().chain(&self.sets).cloned().chain(tuned::sets(&self.tuned)).chain(effects)
    }

    /// What conditions are told in place of the scene's own features.
    fn claims(&self, scene: &Scene) -> Result<Vec<(&'static str, Feature)>> {
        let mut claims = Vec::new();
        for (name, simulated) in &self.effects {
            let without = features::without(scene, name).ok_or_else(|| {
                let present: Vec<&str> =
                    features::effects().filter(|name| features::without(scene, name).is_some()).collect();
                Problem::input("no-effect", format!("`{}` has nothing of `{name}`", scene.name)).help(
                    match present.is_empty() {
                        true => "there is no effect in it that can be left out".to_owned(),
                        false => format!("it has {}", present.join(", ")),
                    },
                )
            })?;
            claims.extend(without.into_iter().filter(|_| !simulated));
        }
        Ok(claims)
    }

    pub(crate) fn prepare(&self, plan: &Plan, library: &Library, scene: &Scene) -> Result<Prepared> {
        let request = Request {
            pipeline: self.pipeline.clone(),
            sets: self.sets.iter().cloned().chain(tuned::sets(&self.tuned)).collect(),
            parts: self.parts.clone(),
            size: plan.size,
            camera: plan.camera,
            claims: self.claims(scene)?,
            ..Request::default()
        };
        let prepared = prepare(&request, library, Some(scene))?;
        if prepared.graph.plan.progress.is_some() {
            let message = format!(
                "`{}` gets better from frame to frame: no frame of it has a time to compare",
                self.pipeline
            );
            return Err(Problem::input("progress", message)
                .help("it can be the reference: `--reference`; `voxgi render` shows it")
                .into());
        }
        Ok(prepared)
    }

    /// Runs it on a device of its own: a first frame, then those that count.
    pub(crate) fn run(&self, plan: &Plan, scene: &Scene, prepared: Prepared) -> Result<Done> {
        let gpu = Gpu::open(plan.adapter.as_deref(), &plan.limits)?;
        let clock = match plan.wall_clock {
            true => Clock::Wall("asked for by --wall-clock".to_owned()),
            false => calibrate::choose(&gpu)?,
        };
        let documents = prepared.documents().into_iter();
        let documents = documents.map(|(name, text)| (name.to_owned(), text.to_owned())).collect();
        let mut frame = prepared.realise(&gpu, scene, clock.clone(), None)?;
        let mut samples =
            Samples { first: Some(frame.run(&gpu, &Changes::All)?.clone()), ..Samples::default() };
        if frame.goes_on() {
            frame.reset();
        }
        for _ in 0..plan.frames {
            samples.frames.push(frame.run(&gpu, &Changes::All)?.clone());
        }
        let mut pictures = BTreeMap::new();
        for (name, reference, _) in &frame.graph.plan.outputs {
            let image = frame.read(&gpu, reference)?;
            if let (true, Some(picture)) =
                (image.float, Picture::new(image.width, image.height, image.channels as u32, image.data))
            {
                pictures.insert(name.clone(), picture);
            }
        }
        let (graph, memory) = (&frame.graph, record::memory(&frame));
        let left_out = self.effects.iter().filter(|(_, simulated)| !simulated);
        let left_out = left_out.map(|(name, _)| format!("`{name}` is left out, as asked"));
        Ok(Done {
            stages: record::stages(&frame, &samples),
            knobs: graph.plan.knobs.iter().map(|k| (k.path.clone(), record::value(&k.value))).collect(),
            parts: graph.plan.parts.clone(),
            peak_bytes: memory.peak_bytes + memory.kept_bytes,
            lacks: record::lacks(scene, graph).into_iter().chain(left_out).collect(),
            samples,
            clock,
            pictures,
            documents,
        })
    }
}
