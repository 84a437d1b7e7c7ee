//! What differs between two comparisons.

use crate::comparison::{Comparison, Run};
use crate::problem::Result;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;

/// Something that is not alike.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Difference {
    /// `SCENE / RUN`, or empty where it is about all.
    pub run: String,
    /// `adapter`, `scene …`, `knob …`, `document kernels/…`, `frame`, `stage …`, `error color relmse`, `picture color`.
    pub what: String,
    pub before: String,
    pub after: String,
    /// Of numbers: after over before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<f64>,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} → {}", self.what, self.before, self.after)?;
        self.ratio.map_or(Ok(()), |ratio| write!(f, " (×{ratio:.3})"))
    }
}

/// All differences between two comparisons in their folders. Times differ where the spreads (p10 to p90) don't
/// meet; pictures where their files do.
pub fn diff(before: (&Comparison, &Path), after: (&Comparison, &Path)) -> Result<Vec<Difference>> {
    let (a, b) = (before.0, after.0);
    let mut found = Found { run: String::new(), all: Vec::new() };
    found.text("version", &a.version, &b.version);
    found.text("adapter", &a.adapter.name, &b.adapter.name);
    found.text(
        "driver",
        &format!("{} {}", a.adapter.driver, a.adapter.driver_info),
        &format!("{} {}", b.adapter.driver, b.adapter.driver_info),
    );
    found.text("size", &format!("{}x{}", a.size[0], a.size[1]), &format!("{}x{}", b.size[0], b.size[1]));
    found.text("curve", &a.curve, &b.curve);
    found.text("exposure", &a.exposure.to_string(), &b.exposure.to_string());
    for scene in &a.scenes {
        if let Some(other) = b.scenes.iter().find(|other| other.name == scene.name) {
            found.text(&format!("scene {}", scene.name), &scene.content, &other.content);
        }
    }
    let name = |run: &Run| format!("{} / {}", run.scene, run.name);
    let named = |comparison: &Comparison| -> BTreeMap<String, Run> {
        comparison.runs.iter().map(|run| (name(run), run.clone())).collect()
    };
    let (before_runs, after_runs) = (named(a), named(b));
    for run in before_runs.keys().chain(after_runs.keys()).collect::<BTreeSet<_>>() {
        found.run.clone_from(run);
        match (before_runs.get(run), after_runs.get(run)) {
            (Some(one), Some(two)) => found.runs((one, before.1), (two, after.1)),
            (one, _) => {
                let [there, missing] = ["there", "not there"];
                let (one, two) = if one.is_some() { (there, missing) } else { (missing, there) };
                found.text("run", one, two);
            }
        }
    }
    Ok(found.all)
}

struct Found {
    run: String,
    all: Vec<Difference>,
}

impl Found {
    fn push(&mut self, what: &str, before: String, after: String, ratio: Option<f64>) {
        self.all.push(Difference { run: self.run.clone(), what: what.to_owned(), before, after, ratio });
    }

    fn text(&mut self, what: &str, before: &str, after: &str) {
        if before != after {
            self.push(what, before.to_owned(), after.to_owned(), None);
        }
    }

    fn number(&mut self, what: &str, before: f64, after: f64) {
        let ratio = (before != 0.0).then(|| after / before);
        self.push(what, format!("{before:.4}"), format!("{after:.4}"), ratio);
    }

    fn runs(&mut self, (a, from_a): (&Run, &Path), (b, from_b): (&Run, &Path)) {
        self.text("clock", &a.clock, &b.clock);
        self.text("reference", &a.reference, &b.reference);
        let show = |value: Option<&serde_json::Value>| value.map_or("none".to_owned(), ToString::to_string);
        for knob in a.knobs.keys().chain(b.knobs.keys()).collect::<BTreeSet<_>>() {
            self.text(&format!("knob {knob}"), &show(a.knobs.get(knob)), &show(b.knobs.get(knob)));
        }
        let none = "none".to_owned();
        for role in a.parts.keys().chain(b.parts.keys()).collect::<BTreeSet<_>>() {
            let [one, two] = [a, b].map(|run| run.parts.get(role).unwrap_or(&none));
            self.text(&format!("part {role}"), one, two);
        }
        for file in a.documents.keys().chain(b.documents.keys()).collect::<BTreeSet<_>>() {
            // Copies are named by their content.
            let [one, two] = [a, b].map(|run| run.documents.get(file).unwrap_or(&none));
            self.text(&format!("document {file}"), one, two);
        }
        let apart = |a: (Option<f64>, Option<f64>), b: (Option<f64>, Option<f64>)| match (a, b) {
            ((Some(a10), Some(a90)), (Some(b10), Some(b90))) => a90 < b10 || b90 < a10,
            _ => false,
        };
        if let (Some(one), Some(two)) = (a.gpu_ms.median, b.gpu_ms.median)
            && apart((a.gpu_ms.p10, a.gpu_ms.p90), (b.gpu_ms.p10, b.gpu_ms.p90))
        {
            self.number("frame", one, two);
        }
        for stage in &a.stages {
            let Some(other) = b.stages.iter().find(|other| other.path == stage.path) else { continue };
            self.text(&format!("stage {}", stage.path), &stage.status, &other.status);
            if let (Some(one), Some(two)) = (stage.gpu_ms, other.gpu_ms)
                && apart((stage.spread.p10, stage.spread.p90), (other.spread.p10, other.spread.p90))
            {
                self.number(&format!("stage {}", stage.path), one, two);
            }
        }
        for (output, measures) in &a.errors {
            for (measure, one) in measures {
                let other = b.errors.get(output).and_then(|measures| measures.get(measure));
                if let Some(two) = other.filter(|two| *two != one) {
                    self.number(&format!("error {output} {measure}"), *one, *two);
                }
            }
        }
        for (output, one) in &a.pictures {
            let Some(two) = b.pictures.get(output) else { continue };
            let [x, y] = [from_a.join(&one.png), from_b.join(&two.png)].map(|path| std::fs::read(path).ok());
            if x != y {
                self.push(&format!("picture {output}"), one.png.clone(), two.png.clone(), None);
            }
        }
    }
}
