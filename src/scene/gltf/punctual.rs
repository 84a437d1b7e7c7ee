//! Lights and cameras that nodes carry.

use super::nodes::Placed;
use super::notes::{Fault, Notes};
use crate::scene::camera::{Camera, Lens};
use crate::scene::layout::Light;
use crate::scene::lights;
use glam::{DVec3, Vec3};
use gltf::json::Root;
use gltf::json::camera::{Camera as Json, Type as CameraType};
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

/// The camera of a node. It looks along the node's −z with +y up; a node's scale changes nothing.
pub fn camera(root: &Root, placed: &Placed, notes: &mut Notes) -> Option<Camera> {
    let index = placed.node.camera?.value();
    let Some(json) = root.cameras.get(index) else {
        let pointer = format!("/nodes/{}/camera", placed.index);
        notes.fault(pointer, Fault::beyond("camera", index, root.cameras.len()));
        return None;
    };
    let pointer = format!("/cameras/{index}");
    let (lens, near) = notes.catch(&pointer, lens(json))?;
    let name = json.name.clone().or_else(|| placed.node.name.clone());
    let name = name.unwrap_or_else(|| format!("camera {index}"));
    let eye = placed.to_world.transform_point3(DVec3::ZERO);
    let [direction, up] = [-DVec3::Z, DVec3::Y].map(|axis| placed.to_world.transform_vector3(axis));
    match Camera::looking(&name, eye, direction, up) {
        Some(camera) => {
            let camera = Camera { lens, near, ..camera };
            if !camera.is_usable() {
                let message =
                    format!("the lens, znear {near} or the position {eye} is beyond what a float can hold");
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

/// The lens, and the distance of the near plane in metres. Of an orthographic camera the height counts; the picture's
/// shape gives the width.
fn lens(json: &Json) -> Result<(Lens, f64), Fault> {
    let wrong = |message: String| Err(Fault::new("gltf-camera", message));
    match (json.type_, &json.perspective, &json.orthographic) {
        (Checked::Valid(CameraType::Perspective), Some(lens), _) => {
            let (vertical_fov, near) = (f64::from(lens.yfov), f64::from(lens.znear));
            if !(vertical_fov > 0.0 && vertical_fov < PI && near > 0.0 && near.is_finite()) {
                return wrong(format!(
                    "yfov {vertical_fov} must be between 0 and π, and znear {near} above 0"
                ));
            }
            Ok((Lens::Perspective { vertical_fov }, near))
        }
        (Checked::Valid(CameraType::Orthographic), _, Some(lens)) => {
            let [half_height, near, far] = [lens.ymag, lens.znear, lens.zfar].map(f64::from);
            // A negative magnification would mirror the picture; glTF advises against it.
            let half_height = half_height.abs();
            let range = near >= 0.0 && far > near && far.is_finite();
            if !(range && half_height > 0.0 && half_height.is_finite()) {
                return wrong(format!(
                    "ymag {half_height} must be above 0, and zfar {far} above znear {near}"
                ));
            }
            Ok((Lens::Orthographic { half_height, far }, near))
        }
        _ => wrong("the type and what describes it don't match".to_owned()),
    }
}
