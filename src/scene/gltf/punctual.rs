//! Lights and cameras that nodes carry.

use super::nodes::Placed;
use super::notes::{Fault, Notes};
use crate::scene::camera::Camera;
use crate::scene::layout::Light;
use crate::scene::lights;
use glam::{DVec3, Vec3};
use gltf::json::Root;
use gltf::json::camera::Type as CameraType;
use gltf::json::extensions::scene::khr_lights_punctual::Type;
use gltf::json::validation::Checked;
use std::f64::consts::PI;

/// The light of a node. Lights shine along their node's −z; a node's scale changes nothing.
pub fn light(root: &Root, placed: &Placed, notes: &mut Notes) -> Option<Light> {
    let index = placed.node.extensions.as_ref()?.khr_lights_punctual.as_ref()?.light.value();
    let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    let lights = lights.map_or(&[][..], |e| &e.lights);
    let Some(light) = lights.get(index) else {
        let pointer = format!("/nodes/{}/extensions/KHR_lights_punctual/light", placed.index);
        notes.fault(pointer, Fault::beyond("light", index, lights.len()));
        return None;
    };
    let pointer = format!("/extensions/KHR_lights_punctual/lights/{index}");
    let intensity = Vec3::from(light.color) * light.intensity;
    let position = placed.to_world.transform_point3(DVec3::ZERO);
    let direction = placed.to_world.transform_vector3(-DVec3::Z);
    let made = match light.type_ {
        Checked::Valid(Type::Point) => lights::point(position, intensity),
        Checked::Valid(Type::Directional) => lights::directional(direction, intensity),
        Checked::Valid(Type::Spot) => {
            let (inner, outer) = light
                .spot
                .as_ref()
                .map_or((0.0, PI / 4.0), |s| (s.inner_cone_angle.into(), s.outer_cone_angle.into()));
            lights::spot(position, direction, intensity, inner, outer)
        }
        Checked::Invalid => Err("the type is none of point, spot, directional".to_owned()),
    };
    notes.catch(pointer, made.map_err(|message| Fault::new("gltf-light", message)))
}

/// The perspective camera of a node. It looks along the node's −z with +y up; a node's scale changes nothing.
pub fn camera(root: &Root, placed: &Placed, notes: &mut Notes) -> Option<Camera> {
    let index = placed.node.camera?.value();
    let Some(json) = root.cameras.get(index) else {
        let pointer = format!("/nodes/{}/camera", placed.index);
        notes.fault(pointer, Fault::beyond("camera", index, root.cameras.len()));
        return None;
    };
    let pointer = format!("/cameras/{index}");
    let lens = match (json.type_, &json.perspective) {
        (Checked::Valid(CameraType::Perspective), Some(lens)) => lens,
        (Checked::Valid(CameraType::Orthographic), _) => {
            notes.lack("orthographic camera", "left out");
            return None;
        }
        _ => {
            notes.fault(pointer, Fault::new("gltf-camera", "the type and what describes it don't match"));
            return None;
        }
    };
    let (angle, near) = (f64::from(lens.yfov), f64::from(lens.znear));
    if !(angle > 0.0 && angle < PI && near > 0.0 && near.is_finite()) {
        let message = format!("yfov {angle} must be between 0 and π, and znear {near} above 0");
        notes.fault(pointer, Fault::new("gltf-camera", message));
        return None;
    }
    let name = json.name.clone().or_else(|| placed.node.name.clone());
    let name = name.unwrap_or_else(|| format!("camera {index}"));
    let eye = placed.to_world.transform_point3(DVec3::ZERO);
    let [direction, up] = [-DVec3::Z, DVec3::Y].map(|axis| placed.to_world.transform_vector3(axis));
    match Camera::looking(&name, eye, direction, up) {
        Some(camera) => {
            let camera = Camera { vertical_fov: angle, near, ..camera };
            if !camera.is_usable() {
                let message = format!(
                    "yfov {angle}, znear {near} or the position {eye} is beyond what a float can hold"
                );
                notes.fault(pointer, Fault::new("gltf-camera", message));
                return None;
            }
            Some(camera)
        }
        None => {
            let message = format!("node {} is scaled to nothing, so its camera looks nowhere", placed.index);
            notes.fault(pointer, Fault::new("gltf-camera", message));
            None
        }
    }
}
