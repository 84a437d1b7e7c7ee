//! What a run says beside the pipeline file.

use crate::document::Cause;
use crate::expr::Value;
use std::collections::BTreeMap;

/// What a pipeline is planned for.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// Knobs set by the user, `--set NAME=TEXT`: by path, or by the path's last piece where that is unique. Of
    /// several for one knob, the last one counts.
    pub sets: Vec<(String, String)>,
    /// Parts put in by the user, `--part ROLE=PART`.
    pub parts: Vec<(String, String)>,
    /// Width and height of the outputs, in pixels.
    pub output: [u32; 2],
    /// All features by their dotted names (`scene.emissive`, `lights.point`, `camera.position`, …), so that unknown names
    /// are recognised; those not known yet are [`Value::Unknown`].
    pub features: BTreeMap<String, Value>,
    /// What loops go over; `None` without a scene.
    pub elements: Option<Elements>,
}

/// What of the scene `Each` goes over.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Elements {
    /// The kinds of the scene's lights, in its order.
    pub lights: Vec<LightKind>,
    /// How many views the engine fits to the lights.
    pub views: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightKind {
    Point,
    Spot,
    Directional,
}

impl LightKind {
    /// As pipeline files call it.
    pub fn name(self) -> &'static str {
        match self {
            LightKind::Point => "point",
            LightKind::Spot => "spot",
            LightKind::Directional => "directional",
        }
    }
}

impl Setup {
    /// The features, with those that every run has.
    pub(super) fn all_features(&self) -> BTreeMap<String, Value> {
        let mut features = self.features.clone();
        features.insert("output.width".to_owned(), Value::Number(self.output[0].into()));
        features.insert("output.height".to_owned(), Value::Number(self.output[1].into()));
        features.insert("frame.index".to_owned(), Value::Unknown);
        features
    }
}

/// What a change of this feature is a change of.
pub(super) fn cause(feature: &str) -> Option<Cause> {
    match feature.split_once('.')?.0 {
        "scene" => Some(Cause::Geometry),
        "lights" | "views" => Some(Cause::Lights),
        "camera" | "cameras" => Some(Cause::Camera),
        "frame" => Some(Cause::Frame),
        _ => None,
    }
}
