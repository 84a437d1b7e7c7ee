//! Plans of small pipelines, with their parts in a folder of their own.

mod errors;
mod loops;
mod names;
mod random;
mod resources;

use super::*;
use crate::document;
use crate::problem::{Problem, Source};

/// A scene with two point lights and a spot light between them.
fn setup() -> Setup {
    Setup {
        output: [640, 480],
        features: features(&[
            ("scene.emissive", Value::Flag(false)),
            ("scene.triangles", Value::Number(12.0)),
            ("lights.point", Value::Number(2.0)),
            ("lights.directional", Value::Number(0.0)),
            ("camera.position", Value::Vector(vec![1.0, 2.0, 3.0])),
        ]),
        elements: Some(Elements {
            lights: vec![LightKind::Point, LightKind::Spot, LightKind::Point],
            views: 3,
        }),
        ..Setup::default()
    }
}

/// The same names, without a scene.
fn no_scene() -> Setup {
    let mut setup = setup();
    setup.features.values_mut().for_each(|value| *value = Value::Unknown);
    Setup { elements: None, ..setup }
}

fn features(features: &[(&str, Value)]) -> BTreeMap<String, Value> {
    features.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect()
}

/// A library with these parts, in a folder that lives as long as what is returned.
fn library(parts: &[(&str, &str)]) -> (tempfile::TempDir, Library) {
    let folder = tempfile::tempdir().unwrap();
    for (name, part) in parts {
        let file = folder.path().join(format!("pipelines/parts/{name}.ron"));
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(file, part).unwrap();
    }
    let library = Library::new(vec![folder.path().to_owned()]).unwrap();
    (folder, library)
}

/// `Pipeline(about: "", …)` with the fields `text`.
fn document(text: &str) -> Result<Document> {
    document::parse(&Source::new("test.ron", format!("Pipeline(about: \"\",\n{text})")))
}

fn try_plan(text: &str, parts: &[(&str, &str)], setup: &Setup) -> Result<Plan> {
    let (_folder, library) = library(parts);
    expand(&document(text)?, &library, setup)
}

#[track_caller]
fn plan(text: &str) -> Plan {
    plan_with(text, &[], &setup())
}

#[track_caller]
fn plan_with(text: &str, parts: &[(&str, &str)], setup: &Setup) -> Plan {
    match try_plan(text, parts, setup) {
        Ok(plan) => plan,
        Err(problems) => panic!("{text}\n{problems}"),
    }
}

/// The problems of a pipeline that can't be planned.
#[track_caller]
fn problems(text: &str, parts: &[(&str, &str)], setup: &Setup) -> Vec<Problem> {
    try_plan(text, parts, setup).expect_err(text).iter().cloned().collect()
}

impl Plan {
    fn paths(&self) -> Vec<&str> {
        self.stages.iter().map(|stage| stage.path.as_str()).collect()
    }

    #[track_caller]
    fn stage(&self, path: &str) -> &PlannedStage {
        self.stages.iter().find(|stage| stage.path == path).unwrap_or_else(|| panic!("{:?}", self.paths()))
    }

    /// A reference as text, with the path of its resource.
    fn show(&self, reference: &Reference) -> String {
        let mut text = self.resources[reference.resource].path.clone();
        text += &reference.mip.map(|mip| format!("@mip{mip}")).unwrap_or_default();
        text += &reference.layer.map(|layer| format!("@layer{layer}")).unwrap_or_default();
        text + if reference.previous { "@previous" } else { "" }
    }

    #[track_caller]
    fn bound(&self, path: &str, binding: &str) -> String {
        self.show(&self.stage(path).bind[binding].0)
    }

    /// What `name` means to a stage.
    #[track_caller]
    fn means(&self, path: &str, name: &str) -> String {
        match self.lookup(self.stage(path).scope, name) {
            Some(Named::Resource(reference)) => self.show(reference),
            Some(Named::Knob(index)) => format!("knob {}", self.knobs[*index].path),
            Some(Named::Value(index)) => format!("value {}", self.values[*index].path),
            Some(Named::Index(value)) => format!("index {value}"),
            Some(Named::Sampler(_)) => "sampler".to_owned(),
            None => "nothing".to_owned(),
        }
    }

    #[track_caller]
    fn value(&self, path: &str) -> &PlannedValue {
        self.values.iter().find(|value| value.path == path).unwrap()
    }

    #[track_caller]
    fn kind(&self, path: &str) -> &ResourceKind {
        &self.resources.iter().find(|resource| resource.path == path).unwrap().kind
    }
}
