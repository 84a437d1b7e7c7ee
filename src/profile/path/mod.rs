//! Ways of the camera: through the keys of a file, or around the scene.
//!
//! ```ron
//! Path(keys: [
//!     (frame: 0, eye: (0, 1, 4), look_at: (0, 1, 0)),
//!     (frame: 30, eye: (2, 1.5, 3), look_at: (0, 1, 0), fov_degrees: 40),
//!     (frame: 60, eye: (3, 1, 0), look_at: (0, 1, 0)),
//! ])
//! ```
//!
//! A `frame` is one of the run's, counted from 0; before the first key and after the last the camera stands still.
//! Keys may have a `time` instead, in any unit: then the whole path is stretched over the run, its first key in the
//! first frame and its last key in the last. Between keys, `eye` and `look_at` move on a smooth curve ([`spline`]).
//! `fov_degrees` is the full vertical angle, by default that of the scene's camera; it changes evenly in the logarithm
//! of its tangent, so that it stays between 0 and 180. Up is y.

mod read;
pub mod spline;

use crate::problem::{Place, Problem, Result, Source};
use crate::scene::{Bounds, Camera, Lens};
use glam::{DQuat, DVec3};

/// Where the camera is in each frame of a run.
#[derive(Clone, Debug)]
pub struct CameraPath {
    unit: Unit,
    /// At least two, in order.
    keys: Vec<Key>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unit {
    Frames,
    Time,
}

#[derive(Clone, Debug)]
struct Key {
    at: f64,
    eye: DVec3,
    look_at: DVec3,
    /// Radians.
    fov: Option<f64>,
    place: Place,
}

impl CameraPath {
    /// Reads a path file.
    ///
    /// Errors: `path-file` if it can't be read, `path`, `path-keys` and `path-value` for what is wrong inside.
    pub fn read(path: &std::path::Path) -> Result<Self> {
        read::read(path)
    }

    /// The path that the text of a file is.
    pub fn parse(source: Source) -> Result<Self> {
        read::parse(source)
    }

    /// How many frames the keys reach, if they are frames.
    pub fn frames(&self) -> Option<u32> {
        let last = self.keys.last().filter(|_| self.unit == Unit::Frames)?;
        Some(last.at as u32 + 1)
    }

    /// The camera of each of `frames` frames; what the path does not say is as in `base`.
    ///
    /// Errors: `path-value` where the curve leads the eye into the point it looks at.
    pub fn cameras(&self, base: &Camera, frames: u32) -> Result<Vec<Camera>, Problem> {
        (0..frames).map(|frame| self.camera(base, self.at(frame, frames))).collect()
    }

    /// What keys count in, at a frame.
    fn at(&self, frame: u32, frames: u32) -> f64 {
        let [first, last] = [self.keys.first(), self.keys.last()].map(|key| key.map_or(0.0, |key| key.at));
        match self.unit {
            Unit::Frames => f64::from(frame),
            Unit::Time => {
                first + (last - first) * f64::from(frame) / f64::from(frames.saturating_sub(1).max(1))
            }
        }
    }

    fn camera(&self, base: &Camera, at: f64) -> Result<Camera, Problem> {
        let along = |of: &dyn Fn(&Key) -> [f64; 3]| {
            let points: Vec<_> = self.keys.iter().map(|key| (key.at, of(key))).collect();
            spline::curve(&points, at).map_or(DVec3::ZERO, DVec3::from)
        };
        let (eye, look_at) = (along(&|key| key.eye.into()), along(&|key| key.look_at.into()));
        let zooms: Vec<_> = self
            .keys
            .iter()
            .map(|key| {
                let half = key.fov.map_or(base.lens.half_height(), |fov| (fov * 0.5).tan());
                (key.at, [half.ln()])
            })
            .collect();
        let zoom = spline::curve(&zooms, at).map_or(0.0, |[zoom]| zoom);
        let camera = Camera::looking(&base.name, eye, look_at - eye, DVec3::Y);
        let camera = camera.filter(|_| eye.as_vec3().is_finite() && look_at.as_vec3().is_finite());
        match camera {
            Some(camera) => {
                // An orthographic camera stays one unless the path gives angles.
                let lens = match base.lens {
                    Lens::Orthographic { .. } if self.keys.iter().all(|key| key.fov.is_none()) => base.lens,
                    _ => Lens::Perspective { vertical_fov: 2.0 * zoom.exp().atan() },
                };
                Ok(Camera { lens, near: base.near, ..camera })
            }
            None => {
                let before = self.keys.iter().rfind(|key| key.at <= at).or(self.keys.first());
                let problem =
                    Problem::input("path-value", "the path leads the eye into the point it looks at");
                let problem = problem.help("move `eye` or `look_at` of a key, or put one more key between");
                Err(match before {
                    Some(key) => problem.at(&key.place, "after this key"),
                    None => problem,
                })
            }
        }
    }
}

/// The cameras of `frames` frames that go around the middle of `bounds` by `degrees` in all, about an upright axis,
/// counter-clockwise as seen from above. The first is `base`; a full turn ends one frame before it.
pub fn orbit(base: &Camera, bounds: &Bounds, degrees: f64, frames: u32) -> Vec<Camera> {
    let center = bounds.center();
    let turned = |frame: u32| {
        let turn = DQuat::from_rotation_y(degrees.to_radians() * f64::from(frame) / f64::from(frames.max(1)));
        Camera {
            position: center + turn * (base.position - center),
            forward: turn * base.forward,
            right: turn * base.right,
            up: turn * base.up,
            ..base.clone()
        }
    };
    (0..frames).map(turned).collect()
}
