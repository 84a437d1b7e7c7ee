//! `grid/turned` as double precision knows it.

use crate::voxelizer::Grid;
use fastrand::Rng;
use glam::{DMat3, DQuat, DVec3, EulerRot};

/// What its knobs say.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    pub resolution: i64,
    /// Degrees.
    pub yaw: f64,
    pub pitch: f64,
    pub roll: f64,
    pub cover: [f64; 3],
}

/// How the grid lies around bounds.
#[derive(Clone, Debug)]
pub struct Turned {
    pub grid: Grid,
    /// From the world's axes to the grid's.
    to_axes: DMat3,
    /// The grid's corner, along its own axes, metres.
    corner: DVec3,
    voxel: f64,
}

impl Turn {
    pub fn new(resolution: i64, yaw: f64, pitch: f64, roll: f64) -> Self {
        Self { resolution, yaw, pitch, roll, cover: [1.0; 3] }
    }

    pub fn random(rng: &mut Rng, resolution: i64) -> Self {
        let mut angle = || (rng.f64() * 720.0 - 360.0).round();
        Self::new(resolution, angle(), angle(), angle())
    }

    pub fn knobs(&self) -> Vec<(&'static str, String)> {
        let numbers = [("yaw", self.yaw), ("pitch", self.pitch), ("roll", self.roll)];
        let covers = ["cover_x", "cover_y", "cover_z"].into_iter().zip(self.cover);
        let texts = numbers.into_iter().chain(covers).map(|(knob, value)| (knob, format!("{value:?}")));
        std::iter::once(("resolution", self.resolution.to_string())).chain(texts).collect()
    }

    /// Around a scene's bounds.
    pub fn around(&self, low: DVec3, high: DVec3) -> Turned {
        let [yaw, pitch, roll] = [self.yaw, self.pitch, self.roll].map(f64::to_radians);
        let to_axes = DMat3::from_quat(DQuat::from_euler(EulerRot::YXZ, yaw, pitch, roll)).transpose();
        let ends = [low, high];
        let corners =
            (0..8_usize).map(|i| DVec3::from_array([0, 1, 2].map(|axis| ends[i >> axis & 1][axis])));
        let turned: Vec<DVec3> = corners.map(|corner| to_axes * corner).collect();
        let extreme = |f: fn(DVec3, DVec3) -> DVec3| turned.iter().copied().reduce(f).unwrap_or_default();
        let (least, greatest) = (extreme(DVec3::min), extreme(DVec3::max));
        let covered = (greatest - least) * DVec3::from_array(self.cover);
        let resolution = self.resolution as f64;
        let inner = (resolution - 3.0).max(resolution / 2.0);
        let voxel = covered.max_element() / inner;
        let room = resolution - inner;
        let size = (covered / voxel + room - 0.001).ceil().max(DVec3::ONE).to_array().map(|n| n as i64);
        Turned {
            grid: Grid { part: "grid/turned", knobs: self.knobs(), size },
            to_axes,
            corner: (least + greatest) / 2.0 - covered / 2.0 - room / 2.0 * voxel,
            voxel,
        }
    }
}

impl Turned {
    /// From the world to voxels.
    pub fn place(&self, world: DVec3) -> DVec3 {
        (self.to_axes * world - self.corner) / self.voxel
    }

    pub fn world(&self, place: DVec3) -> DVec3 {
        self.to_axes.transpose() * (self.corner + place * self.voxel)
    }
}
