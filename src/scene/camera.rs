//! Cameras: pinholes, and parallel projections.

use super::bounds::Bounds;
use super::is_near;
use super::layout::CameraUniform;
use glam::{DMat4, DVec3, DVec4};

/// A camera. `forward`, `right`, `up` are unit vectors at right angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    pub name: String,
    pub position: DVec3,
    pub forward: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub lens: Lens,
    /// Metres; nothing nearer is seen.
    pub near: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Full vertical angle in radians, between 0 and π.
    Perspective { vertical_fov: f64 },
    /// Half the height of the picture in metres; nothing further than `far` metres is seen.
    Orthographic { half_height: f64, far: f64 },
}

impl Camera {
    /// A camera at `eye` that looks along `direction`, with `up` as nearly up as that allows. `None` if `direction` has
    /// no length.
    pub fn looking(name: &str, eye: DVec3, direction: DVec3, up: DVec3) -> Option<Self> {
        let forward = direction.try_normalize()?;
        let (right, up) = frame(forward, up);
        Some(Self {
            name: name.to_owned(),
            position: eye,
            forward,
            right,
            up,
            lens: Lens::DEFAULT,
            near: DEFAULT_NEAR,
        })
    }

    /// The camera of a scene that has none: from the front (glTF's front is +z), so far away that a ball around
    /// `bounds` fits the picture's height.
    pub fn framing(bounds: &Bounds) -> Self {
        let radius = (bounds.diagonal() * 0.5).max(1e-3);
        let distance = radius / (DEFAULT_FOV * 0.5).sin();
        Self {
            name: "default".to_owned(),
            position: bounds.center() + DVec3::Z * distance,
            forward: -DVec3::Z,
            right: DVec3::X,
            up: DVec3::Y,
            lens: Lens::DEFAULT,
            near: distance * 1e-3,
        }
    }

    /// Whether its numbers are such that f32 can hold the camera of pictures of all shapes.
    pub fn is_usable(&self) -> bool {
        [1e-4, 1.0, 1e4].into_iter().all(|aspect| {
            let uniform = self.uniform(aspect);
            let matrices = [uniform.view_projection, uniform.inverse_view_projection];
            matrices.iter().all(|matrix| matrix.is_finite())
                && [uniform.right, uniform.up].iter().all(|side| side.is_finite())
                && uniform.distance.is_finite()
                && is_near(uniform.position)
                && uniform.near > 0.0
        })
    }

    /// The camera for a picture whose width is `aspect` times its height. Clip space is wgpu's: x right, y up, depth 1
    /// at `near` and 0 at infinity, or at the far plane of an orthographic one.
    pub fn uniform(&self, aspect: f64) -> CameraUniform {
        let near = self.near;
        // Depth z/w with z = a·z_view + b; w = −z_view or 1; and distance along `forward` as
        // a quotient of depth d: (x + y·d) / (z + w·d).
        let half = self.lens.half_height();
        let (a, b, w, distance) = match self.lens {
            Lens::Perspective { .. } => {
                (0.0, near, DVec4::new(0.0, 0.0, -1.0, 0.0), DVec4::new(near, 0.0, 0.0, 1.0))
            }
            Lens::Orthographic { far, .. } => {
                let depth = far - near;
                (depth.recip(), far / depth, DVec4::W, DVec4::new(far, -depth, 1.0, 0.0))
            }
        };
        let projection = DMat4::from_cols(
            DVec4::X / (half * aspect),
            DVec4::Y / half,
            DVec4::new(0.0, 0.0, a, w.z),
            DVec4::new(0.0, 0.0, b, w.w),
        );
        let view_projection = projection * world_to_view(self.position, self.right, self.up, self.forward);
        CameraUniform {
            view_projection: view_projection.as_mat4(),
            inverse_view_projection: view_projection.inverse().as_mat4(),
            position: self.position.as_vec3(),
            near: self.near as f32,
            forward: self.forward.as_vec3(),
            aspect: aspect as f32,
            right: (self.right * half * aspect).as_vec3(),
            parallel: f32::from(u8::from(matches!(self.lens, Lens::Orthographic { .. }))),
            up: (self.up * half).as_vec3(),
            pad_up: 0,
            distance: distance.as_vec4(),
        }
    }
}

impl Lens {
    /// Half the height of what is seen at distance 1, in metres.
    pub fn half_height(&self) -> f64 {
        match self {
            Self::Perspective { vertical_fov } => (vertical_fov * 0.5).tan(),
            Self::Orthographic { half_height, .. } => *half_height,
        }
    }

    const DEFAULT: Self = Self::Perspective { vertical_fov: DEFAULT_FOV };
}

const DEFAULT_FOV: f64 = 50.0 * std::f64::consts::PI / 180.0;
const DEFAULT_NEAR: f64 = 0.01;

/// (right, up) at right angles to the unit vector `forward`, `up` as near to the one wished as can be; another one is
/// taken where that is parallel to `forward`.
pub(super) fn frame(forward: DVec3, wished_up: DVec3) -> (DVec3, DVec3) {
    let across = |up: DVec3| {
        let right = forward.cross(up);
        (right.length() > 1e-6 * up.length()).then(|| right.normalize())
    };
    let right = across(wished_up).or_else(|| across(DVec3::Y)).or_else(|| across(DVec3::Z));
    // `forward` can't be parallel to both y and z.
    let right = right.unwrap_or(DVec3::X);
    (right, right.cross(forward))
}

/// World to view space, where x is right, y is up and the camera looks along −z.
pub(super) fn world_to_view(position: DVec3, right: DVec3, up: DVec3, forward: DVec3) -> DMat4 {
    let row = |axis: DVec3| axis.extend(-axis.dot(position));
    DMat4::from_cols(row(right), row(up), row(-forward), DVec4::W).transpose()
}
