//! The comparison as the page goes through it: scenes with their runs, each with its number, colour and anchor.

use super::measures::{DEFAULT_MEASURE, DEFAULT_OUTPUT, MEASURES, Measure, outputs};
use crate::comparison::{Comparison, Reference, Run, SceneEntry};

pub struct View<'a> {
    pub comparison: &'a Comparison,
    pub outputs: Vec<String>,
    /// What the page shows before anything is chosen.
    pub output: String,
    pub measure: &'static Measure,
    pub scenes: Vec<SceneView<'a>>,
}

pub struct SceneView<'a> {
    pub index: usize,
    pub entry: &'a SceneEntry,
    pub runs: Vec<RunView<'a>>,
}

#[derive(Clone, Copy)]
pub struct RunView<'a> {
    /// Among all runs: it makes the anchor.
    pub index: usize,
    /// Within the scene, from 1: how charts call it.
    pub number: usize,
    /// Runs of the same pipeline have the same colour and marker, in all scenes.
    pub series: usize,
    pub run: &'a Run,
    pub reference: Option<&'a Reference>,
}

impl<'a> View<'a> {
    pub fn new(comparison: &'a Comparison) -> Self {
        let mut pipelines: Vec<&str> = Vec::new();
        for run in &comparison.runs {
            if !pipelines.contains(&run.pipeline.as_str()) {
                pipelines.push(&run.pipeline);
            }
        }
        let scene = |(index, entry): (usize, &'a SceneEntry)| {
            let of_scene = comparison.runs.iter().enumerate().filter(|(_, run)| run.scene == entry.name);
            let run = |(at, (index, run)): (usize, (usize, &'a Run))| RunView {
                index,
                number: at + 1,
                series: pipelines.iter().position(|name| *name == run.pipeline).unwrap_or(0),
                run,
                reference: entry.references.get(&run.reference),
            };
            SceneView { index, entry, runs: of_scene.enumerate().map(run).collect() }
        };
        let outputs = outputs(comparison);
        let first = outputs.first().cloned().unwrap_or_default();
        let has_default = outputs.iter().any(|name| name == DEFAULT_OUTPUT);
        let measured = |measure: &&Measure| {
            let mut errors = comparison.runs.iter().flat_map(|run| run.errors.values());
            measure.charted && errors.any(|values| values.contains_key(measure.key))
        };
        let default = MEASURES.iter().find(|measure| measure.key == DEFAULT_MEASURE && measured(measure));
        Self {
            comparison,
            output: if has_default { DEFAULT_OUTPUT.to_owned() } else { first },
            measure: default.or_else(|| MEASURES.iter().find(measured)).unwrap_or(&MEASURES[0]),
            outputs,
            scenes: comparison.scenes.iter().enumerate().map(scene).collect(),
        }
    }

    /// Each output with each measure that charts offer and any run has, and whether that is shown first.
    pub fn combinations(&self) -> impl Iterator<Item = (&str, &'static Measure, bool)> {
        let measures = || MEASURES.iter().filter(|measure| self.has(measure));
        let all = self.outputs.iter().flat_map(move |output| measures().map(move |m| (output.as_str(), m)));
        all.map(|(output, m)| (output, m, output == self.output && m.key == self.measure.key))
    }

    /// Whether charts offer `measure`.
    pub fn has(&self, measure: &Measure) -> bool {
        let mut errors = self.comparison.runs.iter().flat_map(|run| run.errors.values());
        measure.charted && errors.any(|values| values.contains_key(measure.key))
    }
}

impl<'a> SceneView<'a> {
    pub fn anchor(&self) -> String {
        format!("scene-{}", self.index + 1)
    }

    pub fn run(&self, index: usize) -> Option<&RunView<'a>> {
        self.runs.iter().find(|run| run.index == index)
    }
}

impl RunView<'_> {
    pub fn anchor(&self) -> String {
        format!("run-{}", self.index + 1)
    }

    pub fn within_noise(&self, output: &str) -> bool {
        self.run.within_noise.iter().any(|name| name == output)
    }
}
