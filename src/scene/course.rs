//! Motion in settings.

use super::layout::{Light, POINT};
use super::motion::{Carried, Interpolation, Keys, MovingNode, Parent, Pose, Request};
use crate::problem::Place;
use glam::{DMat4, DQuat, DVec3};
use serde::Deserialize;

/// Motion as a setting writes it: a turn about an axis, then an offset.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Course {
    #[serde(default = "up")]
    pub axis: [f64; 3],
    #[serde(default)]
    pub pivot: Option<[f64; 3]>,
    #[serde(default)]
    pub interpolation: Steps,
    pub keys: Vec<Key>,
}

#[derive(Deserialize, Clone, Copy, Default)]
pub enum Steps {
    Step,
    #[default]
    Linear,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Key {
    time: f64,
    #[serde(default)]
    offset: [f64; 3],
    #[serde(default)]
    degrees: f64,
}

pub fn up() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

/// Motion from checked numbers; errors are sentences.
pub fn request(node: String, course: Course, place: Place) -> Result<Request, String> {
    let axis = DVec3::from(course.axis).try_normalize().ok_or("the axis has no length")?;
    let times: Vec<f64> = course.keys.iter().map(|key| key.time).collect();
    if times.first().is_none_or(|first| *first < 0.0) || !times.windows(2).all(|t| t[0] < t[1]) {
        return Err("the times of the keys must grow from 0 or later, and there must be a key".to_owned());
    }
    let values: Vec<_> = course.keys.iter().map(|key| DVec3::from(key.offset).extend(key.degrees)).collect();
    let pivot = course.pivot.map(DVec3::from);
    let finite = |v: &glam::DVec4| v.as_vec4().is_finite();
    if !(values.iter().all(finite) && times.iter().all(|t| t.is_finite()))
        || pivot.is_some_and(|pivot| !pivot.as_vec3().is_finite())
    {
        return Err("a number of the motion is not finite".to_owned());
    }
    let interpolation = match course.interpolation {
        Steps::Step => Interpolation::Step,
        Steps::Linear => Interpolation::Linear,
    };
    Ok(Request { node, axis, pivot, keys: Keys { interpolation, times, values }, place })
}

/// A node that carries the setting's light `index`.
pub fn carrying(index: usize, light: &Light, request: &Request) -> MovingNode {
    let position = light.position.as_dvec3();
    let direction = if light.kind == POINT { -DVec3::Z } else { light.direction.as_dvec3() };
    let turn = DQuat::from_rotation_arc(-DVec3::Z, direction.normalize());
    MovingNode {
        parent: Parent::Still(DMat4::IDENTITY),
        rest: Pose::Matrix(DMat4::from_rotation_translation(turn, position)),
        tracks: Vec::new(),
        added: Some(request.about(position)),
        carries: vec![Carried::Light(index)],
    }
}
