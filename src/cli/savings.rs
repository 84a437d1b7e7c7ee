//! What omissions save: the time that stages which were kept or dropped take when they run all the same, and what
//! frames take that simulate effects of which the scene has nothing.

use super::run::{RunArgs, Started};
use crate::frame::Changes;
use crate::frame::Frame;
use crate::graph::Graph;
use crate::problem::Result;
use crate::record::{self, EffectRecord, Samples, StageRecord, quantile, spread};
use crate::scene::features;
use crate::session::{Request, prepare};
use std::collections::BTreeMap;

/// Frames over which the medians are taken, after a first one.
const FRAMES: usize = 3;
/// Pairs of frames with and without an effect.
const PAIRS: usize = 7;

/// Runs the pipeline with nothing left out, and notes in `stages` what those that were left out then take. A stage that
/// can't be bound for this scene has no such time: what it would read is not there.
pub fn stages(stages: &mut [StageRecord], args: &RunArgs, started: &Started) -> Result<()> {
    let (gpu, scene) = (&started.gpu, started.scene());
    let library = args.pipeline_args.library()?;
    let request = Request { drop: false, keep: false, ..started.request.clone() };
    let prepared = prepare(&request, &library, Some(scene))?;
    let mut frame = prepared.realise(gpu, scene, started.clock.clone(), None)?;
    let mut samples = Samples { first: Some(frame.run(gpu, &Changes::All)?.clone()), ..Samples::default() };
    for _ in 0..FRAMES {
        samples.frames.push(frame.run(gpu, &Changes::All)?.clone());
    }
    let whole = record::stages(&frame, &samples);
    for stage in stages.iter_mut().filter(|stage| stage.status != "run") {
        stage.saved_ms = whole.iter().find(|other| other.path == stage.path).and_then(|other| other.gpu_ms);
    }
    Ok(())
}

/// For each effect that the scene has nothing of and that changes what runs: frames that simulate it all the same, in
/// turns with frames that don't. The difference holds stages that run only for it and, in those that run anyway, what
/// specialising their kernels saves. An effect that can't be simulated on this scene has no such time.
pub fn effects(args: &RunArgs, started: &Started) -> Result<Vec<EffectRecord>> {
    let (gpu, scene) = (&started.gpu, started.scene());
    let library = args.pipeline_args.library()?;
    let request = Request { keep: false, ..started.request.clone() };
    let realised = |request: &Request| -> Result<Frame> {
        let mut frame =
            prepare(request, &library, Some(scene))?.realise(gpu, scene, started.clock.clone(), None)?;
        frame.run(gpu, &Changes::All)?;
        Ok(frame)
    };
    let mut without = realised(&request)?;
    let mut records = Vec::new();
    for (feature, claims) in features::missing_effects(scene) {
        let Ok(mut with) = realised(&Request { claims, ..request.clone() }) else { continue };
        let changed = changed(&with.graph, &without.graph);
        if changed.is_empty() {
            continue;
        }
        let (mut long, mut short) = (Samples::default(), Samples::default());
        for _ in 0..PAIRS {
            long.frames.push(with.run(gpu, &Changes::All)?.clone());
            short.frames.push(without.run(gpu, &Changes::All)?.clone());
        }
        let (long, short) = (record::stages(&with, &long), record::stages(&without, &short));
        let time = |stages: &[StageRecord], path: &str| {
            stages.iter().find(|stage| stage.path == path).and_then(|stage| stage.gpu_ms)
        };
        let longer = |path: &String| Some(time(&long, path)? - time(&short, path).unwrap_or(0.0));
        // What both run alike is left out: its noise would drown the difference.
        let sum = |stages: &[StageRecord], pair: usize| -> f64 {
            let counted = stages.iter().filter(|stage| changed.contains(&stage.path));
            counted.filter_map(|stage| *stage.samples_ms.get(pair)?).sum()
        };
        let differences: Vec<f64> = (0..PAIRS).map(|pair| sum(&long, pair) - sum(&short, pair)).collect();
        records.push(EffectRecord {
            feature,
            saved_ms: quantile(&differences, 0.5),
            spread: spread(&differences),
            stages: changed.iter().map(|path| (path.clone(), longer(path))).collect(),
        });
    }
    Ok(records)
}

/// Paths of stages that run another program in `graph` than in `other`, or only there.
fn changed(graph: &Graph, other: &Graph) -> Vec<String> {
    let programs = |graph: &Graph| -> BTreeMap<String, _> {
        let on = graph.stages.iter().filter(|stage| stage.off.is_none());
        on.filter_map(|stage| Some((stage.path.clone(), stage.linked.as_ref()?.program.key.clone())))
            .collect()
    };
    let others = programs(other);
    programs(graph)
        .into_iter()
        .filter(|(path, key)| others.get(path) != Some(key))
        .map(|(path, _)| path)
        .collect()
}
