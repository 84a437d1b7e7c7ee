//! Lights from checked numbers, the same for glTF files and settings. Errors are sentences that name the number.

use super::is_near;
use super::layout::{DIRECTIONAL, Light, POINT, SPOT};
use glam::{DVec3, Vec3};
use std::f64::consts::FRAC_PI_2;

/// `intensity`: W/sr.
pub fn point(position: DVec3, intensity: Vec3) -> Result<Light, String> {
    Ok(Light {
        position: near(position)?,
        kind: POINT,
        direction: Vec3::ZERO,
        first_view: 0,
        intensity: power(intensity)?,
        cos_outer: -1.0,
        cos_inner: -1.0,
        view_count: 0,
        pad: [0; 2],
    })
}

/// `direction`: of travel. `intensity`: W/sr. `inner`, `outer`: half angles of its light in radians.
pub fn spot(
    position: DVec3,
    direction: DVec3,
    intensity: Vec3,
    inner: f64,
    outer: f64,
) -> Result<Light, String> {
    if !(inner >= 0.0 && inner < outer && outer <= FRAC_PI_2 + 1e-6) {
        let degrees = [inner, outer].map(f64::to_degrees);
        return Err(format!(
            "the spot's half angles must grow from inner ({}°) to outer ({}°) within 0° to 90°",
            degrees[0], degrees[1]
        ));
    }
    Ok(Light {
        kind: SPOT,
        direction: unit(direction)?,
        cos_outer: outer.cos() as f32,
        cos_inner: inner.cos() as f32,
        ..point(position, intensity)?
    })
}

/// `direction`: of travel. `irradiance`: W/m² on a surface that faces the light.
pub fn directional(direction: DVec3, irradiance: Vec3) -> Result<Light, String> {
    Ok(Light { kind: DIRECTIONAL, direction: unit(direction)?, ..point(DVec3::ZERO, irradiance)? })
}

fn near(position: DVec3) -> Result<Vec3, String> {
    let position = position.as_vec3();
    if is_near(position) { Ok(position) } else { Err("the position is farther than 10¹⁸ m".to_owned()) }
}

fn power(v: Vec3) -> Result<Vec3, String> {
    if v.is_finite() && v.min_element() >= 0.0 {
        return Ok(v);
    }
    Err(format!("the intensity ({}, {}, {}) is negative or not finite", v.x, v.y, v.z))
}

fn unit(v: DVec3) -> Result<Vec3, String> {
    v.try_normalize().map(|v| v.as_vec3()).ok_or_else(|| "the direction has no length".to_owned())
}
