//! Closed meshes: balls, tori and boxes, turned anyhow.

use crate::oracle::{Point, Triangle, VOXEL};
use glam::{DQuat, DVec3, EulerRot};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

#[derive(Clone, Copy, Debug)]
pub enum Shape {
    Ball {
        radius: f64,
    },
    /// `ring`: radius of the circle in the middle of the tube.
    Torus {
        ring: f64,
        tube: f64,
    },
    Cuboid {
        half: DVec3,
    },
}

/// A shape around a place, in voxels.
#[derive(Clone, Copy, Debug)]
pub struct Solid {
    pub shape: Shape,
    pub center: DVec3,
    pub turned: DQuat,
}

/// Segments around a ball, a torus or its tube.
const SEGMENTS: usize = 24;

/// Corners of a surface with two parameters in [0, 1], each square two triangles. Both ends of a parameter are the same
/// corners, so the mesh is closed.
fn surface(at: impl Fn(f64, f64) -> DVec3) -> Vec<[DVec3; 3]> {
    let corner = |i: usize, j: usize| {
        let [u, v] = [i, j].map(|k| k as f64 / SEGMENTS as f64);
        at(u, v)
    };
    let square = |i: usize, j: usize| {
        // A torus and a ball's meridians come round again.
        let next = (i + 1) % SEGMENTS;
        let [a, b, c, d] = [(i, j), (next, j), (next, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
        [[a, b, c], [a, c, d]]
    };
    (0..SEGMENTS * SEGMENTS).flat_map(|k| square(k / SEGMENTS, k % SEGMENTS)).collect()
}

impl Shape {
    fn triangles(self) -> Vec<[DVec3; 3]> {
        match self {
            Self::Ball { radius } => surface(|u, v| {
                let ((sin, cos), (around, up)) = ((TAU * u).sin_cos(), (PI * v).sin_cos());
                // Exactly one corner at each pole.
                let around = if v == 0.0 || v == 1.0 { 0.0 } else { around };
                radius * DVec3::new(around * cos, around * sin, up)
            }),
            Self::Torus { ring, tube } => surface(|u, v| {
                let ((sin, cos), (up, out)) = ((TAU * u).sin_cos(), (TAU * (v % 1.0)).sin_cos());
                let reach = ring + tube * out;
                DVec3::new(reach * cos, reach * sin, tube * up)
            }),
            Self::Cuboid { half } => {
                let corner = |i: usize| {
                    half * DVec3::from_array(
                        [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 }),
                    )
                };
                let sides =
                    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
                let side = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]].map(|t| t.map(corner));
                sides.into_iter().flat_map(side).collect()
            }
        }
    }

    /// Whether a point lies deeper inside than a voxel, and than flat facets cut off.
    fn deep(self, p: DVec3) -> bool {
        let facets = (PI / SEGMENTS as f64).cos().powi(2);
        match self {
            Self::Ball { radius } => p.length() < radius * facets - 1.8,
            Self::Torus { ring, tube } => {
                let across = p.truncate().length() - ring;
                // The ring's segments cut off more where the tube is thin.
                across.hypot(p.z) < tube * facets - 1.8 - ring * (1.0 - facets)
            }
            Self::Cuboid { half } => (half - p.abs()).min_element() > 1.8,
        }
    }
}

impl Solid {
    /// In units; corners that fall together stay together.
    pub fn triangles(&self) -> Vec<Triangle> {
        let unit =
            |p: DVec3| ((self.center + self.turned * p) * VOXEL as f64).round().to_array().map(|x| x as i64);
        self.shape.triangles().into_iter().map(|t| t.map(unit)).collect()
    }

    /// Whether a voxel's middle lies well inside.
    pub fn holds(&self, voxel: Point) -> bool {
        let middle = DVec3::from_array(voxel.map(|i| i as f64 + 0.5));
        self.shape.deep(self.turned.inverse() * (middle - self.center))
    }
}

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (5.0..13.0_f64).prop_map(|radius| Shape::Ball { radius }),
        (4.5..6.0_f64, 6.5..7.5_f64).prop_map(|(tube, ring)| Shape::Torus { ring, tube }),
        [3.5..7.5_f64, 3.5..7.5, 3.5..7.5].prop_map(|half| Shape::Cuboid { half: DVec3::from_array(half) }),
    ]
}

/// Eight solids of at most 13.5 voxels around, one in each corner of a grid of 64.
pub fn solids() -> impl Strategy<Value = Vec<Solid>> {
    let one = |i: usize| {
        (shape(), [0.0..TAU, 0.0..TAU, 0.0..TAU], [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0]).prop_map(
            move |(shape, [a, b, c], shift)| Solid {
                shape,
                center: DVec3::from_array([0, 1, 2].map(|axis| [16.5, 47.5][i >> axis & 1] + shift[axis])),
                turned: DQuat::from_euler(EulerRot::XYZ, a, b, c),
            },
        )
    };
    (0..8).map(one).collect::<Vec<_>>()
}
