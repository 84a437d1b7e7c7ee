//! Views: the scene as each light sees it, for whatever a pipeline draws or samples from there.
//!
//! A spot light and a directional light have one view, a point light six square ones of 90°. Near and far are the
//! tightest that hold the scene's box along the view's axis, with a margin for rounding, wherever the light
//! stands. Depth is 1 at near and 0 at far.
//!
//! A perspective needs a near distance above 0: where the light is inside the box, or so near that the box
//! starts closer, that is [`NEAREST`] of the box's diagonal.

use super::bounds::Bounds;
use super::camera::{frame, world_to_view};
use super::layout::{DIRECTIONAL, Light, POINT, SPOT, View};
use glam::{DMat4, DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, PI};

/// Least near distance of a perspective, as a part of the scene's diagonal.
pub const NEAREST: f64 = 1e-4;
/// Widest view of a spot light, in radians (170°): beyond, the texels at its rim grow without limit.
pub const WIDEST_SPOT: f64 = 170.0 * PI / 180.0;
/// Margin that keeps a point of the box inside the view after rounding to f32, as a part of the view's extent.
const MARGIN: f64 = 1e-3;

/// The faces of a point light's cube: where each looks, and its up.
const FACES: [(DVec3, DVec3); 6] = [
    (DVec3::X, DVec3::Y),
    (DVec3::NEG_X, DVec3::Y),
    (DVec3::Y, DVec3::NEG_Z),
    (DVec3::NEG_Y, DVec3::Z),
    (DVec3::Z, DVec3::Y),
    (DVec3::NEG_Z, DVec3::Y),
];

/// Makes the views of all lights, in their order, and notes in each light which are its own.
pub fn fit(lights: &mut [Light], bounds: &Bounds) -> Vec<View> {
    let mut views = Vec::new();
    for (index, light) in (0..).zip(lights) {
        light.first_view = views.len() as u32;
        let position = light.position.as_dvec3();
        let direction = light.direction.as_dvec3();
        match light.kind {
            POINT => views.extend((0..).zip(FACES).map(|(face, (forward, up))| {
                let right = forward.cross(up);
                View { face, ..perspective(index, position, [right, up, forward], FRAC_PI_2, bounds) }
            })),
            SPOT => {
                let (right, up) = frame(direction, DVec3::Y);
                let axes = [right, up, direction];
                views.push(perspective(index, position, axes, spot_angle(light), bounds));
            }
            DIRECTIONAL => views.push(orthographic(index, direction, bounds)),
            _ => {}
        }
        light.view_count = views.len() as u32 - light.first_view;
    }
    views
}

/// Full angle of a spot light's view in radians.
fn spot_angle(light: &Light) -> f64 {
    (2.0 * f64::from(light.cos_outer).clamp(-1.0, 1.0).acos()).clamp(1e-3, WIDEST_SPOT)
}

/// Whether a spot light reaches further than its view.
pub fn wider_than_view(light: &Light) -> bool {
    light.kind == SPOT && 2.0 * f64::from(light.cos_outer).acos() > WIDEST_SPOT + 1e-6
}

/// `axes`: right, up, forward.
fn perspective(light: u32, position: DVec3, axes: [DVec3; 3], angle: f64, bounds: &Bounds) -> View {
    let [right, up, forward] = axes;
    let (start, end) = bounds.extent_along(forward, position);
    let least = (bounds.diagonal() * NEAREST).max(end.abs() * 1e-6).max(1e-6);
    let near = (start * (1.0 - MARGIN)).max(least);
    let far = (end * (1.0 + MARGIN)).max(near * (1.0 + MARGIN));
    let scale = 1.0 / (angle * 0.5).tan();
    // Depth z/w with z = a·z_view + b and w = −z_view: 1 at −near, 0 at −far.
    let (a, b) = (near / (far - near), near * far / (far - near));
    let projection = DMat4::from_cols(
        DVec4::X * scale,
        DVec4::Y * scale,
        DVec4::new(0.0, 0.0, a, -1.0),
        DVec4::new(0.0, 0.0, b, 0.0),
    );
    View {
        view_projection: (projection * world_to_view(position, right, up, forward)).as_mat4(),
        position: position.as_vec3(),
        light,
        direction: forward.as_vec3(),
        face: 0,
        near: near as f32,
        far: far as f32,
        texel: (2.0 / scale) as f32,
        pad: 0,
    }
}

fn orthographic(light: u32, forward: DVec3, bounds: &Bounds) -> View {
    let (right, up) = frame(forward, DVec3::Y);
    let center = bounds.center();
    // Half extents along the axes; the box is symmetric about its centre. A flat or single-point scene keeps some.
    let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
    let least = (bounds.diagonal() * MARGIN).max(f64::from(reach) * 1e-5).max(1e-6);
    let half = |axis| (bounds.extent_along(axis, center).1 * (1.0 + MARGIN)).max(least);
    let (width, height, depth) = (half(right), half(up), half(forward));
    let position = center - forward * depth;
    let projection = DMat4::from_cols(
        DVec4::X / width,
        DVec4::Y / height,
        DVec4::Z / (2.0 * depth),
        DVec4::new(0.0, 0.0, 1.0, 1.0),
    );
    View {
        view_projection: (projection * world_to_view(position, right, up, forward)).as_mat4(),
        position: position.as_vec3(),
        light,
        direction: forward.as_vec3(),
        face: 0,
        near: 0.0,
        far: (2.0 * depth) as f32,
        texel: (2.0 * width.max(height)) as f32,
        pad: 0,
    }
}
