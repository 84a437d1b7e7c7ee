//! Axis-aligned boxes.

use glam::{DVec3, Vec3};

/// All points between `min` and `max`, both included. A scene without triangles has the point at the origin.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Bounds {
    pub min: Vec3,
    pub max: Vec3,
}

impl Bounds {
    /// The smallest box around `points`; `None` if there are none.
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Option<Self> {
        points.into_iter().fold(None, |bounds: Option<Self>, p| {
            Some(bounds.map_or(Self { min: p, max: p }, |b| Self { min: b.min.min(p), max: b.max.max(p) }))
        })
    }

    /// In f64, where boxes far from the origin keep their shape.
    pub fn center(&self) -> DVec3 {
        (self.min.as_dvec3() + self.max.as_dvec3()) * 0.5
    }

    pub fn diagonal(&self) -> f64 {
        self.min.as_dvec3().distance(self.max.as_dvec3())
    }

    /// The smallest box around both.
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    pub fn corners(&self) -> [DVec3; 8] {
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f64, hi: f64| if i >> bit & 1 == 0 { lo } else { hi };
            DVec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
        })
    }

    /// Least and greatest value of `axis · (p − origin)` over the box.
    pub fn extent_along(&self, axis: DVec3, origin: DVec3) -> (f64, f64) {
        self.corners()
            .iter()
            .map(|corner| axis.dot(*corner - origin))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), d| (least.min(d), greatest.max(d)))
    }
}
