//! Random triangles, within the grid and beyond it.

use crate::lattice::Lattice;
use crate::oracle::{self, Point, Rule, Ties, Triangle, VOXEL};
use crate::voxelizer::check;
use fastrand::Rng;

/// Where random triangles lie.
#[derive(Clone, Copy)]
pub struct Region {
    /// In units; corners lie between, both included.
    pub low: Point,
    pub high: Point,
}

impl Region {
    /// Within a lattice's scene.
    pub fn scene(lattice: &Lattice) -> Self {
        Self { low: lattice.low, high: lattice.high }
    }

    /// Triangles whose corners lie on a lattice of `step` units, within `reach` units of each other.
    pub fn triangles(&self, rng: &mut Rng, number: usize, reach: i64, step: i64) -> Vec<Triangle> {
        let mut pick = |low: i64, high: i64| low + step * rng.i64(0..=(high - low).max(0) / step);
        let mut triangle = || {
            let start = [0, 1, 2].map(|axis| pick(self.low[axis], self.high[axis] - reach));
            let end = [0, 1, 2].map(|axis| (start[axis] + reach).min(self.high[axis]));
            [(); 3].map(|()| [0, 1, 2].map(|axis| pick(start[axis], end[axis])))
        };
        (0..number).map(|_| triangle()).collect()
    }
}

/// Some made to what is hard: points, segments along axes and across, slivers, triangles in a plane along the axes.
pub fn hardened(mut triangles: Vec<Triangle>, step: i64) -> Vec<Triangle> {
    for (i, [a, b, c]) in triangles.iter_mut().enumerate() {
        match i % 8 {
            0 => (*b, *c) = (*a, *a),
            1 => *c = *b,
            2 => *c = [0, 1, 2].map(|axis| (a[axis] + b[axis]) / (2 * step) * step),
            3 => (b[1], c[1]) = (a[1], a[1]),
            4 => (b[0], b[2], *c) = (a[0], a[2], *a),
            5 => *c = [b[0] - step.max(2) * (b[0] - a[0]).signum(), b[1], b[2]],
            6 => (b[0], c[0]) = (a[0], a[0]),
            _ => (b[2], c[2]) = (a[2], a[2]),
        }
    }
    triangles
}

/// How many voxels are filled only because something touches them: a wrong rule for ties would show in them.
fn touched(lattice: &Lattice, triangles: &[Triangle]) -> usize {
    let triangles = oracle::snapped(triangles);
    let of = |ties| oracle::count(&triangles, lattice.grid.size, Rule::Conservative, ties);
    oracle::differences(&of(Ties::Count), &of(Ties::DoNotCount))
}

/// Corners anywhere.
#[test]
fn triangles_anywhere() {
    let lattice = Lattice::cube(32);
    let region = Region::scene(&lattice);
    let mut rng = Rng::with_seed(1);
    let mut some = |number, voxels: i64| region.triangles(&mut rng, number, voxels * VOXEL, 1);
    check("anywhere", &lattice, &[some(4000, 2), some(600, 8), some(80, 29)].concat(), 1000);
}

/// Corners on a coarse lattice, so that triangles just touch voxels and lie along their faces.
#[test]
fn triangles_on_a_coarse_lattice() {
    let lattice = Lattice::cube(32);
    let region = Region::scene(&lattice);
    let mut rng = Rng::with_seed(2);
    let mut some = |number, voxels: i64, step| region.triangles(&mut rng, number, voxels * VOXEL, step);
    let triangles = [some(3000, 2, VOXEL / 4), some(500, 8, VOXEL / 2), some(60, 29, VOXEL)].concat();
    assert!(touched(&lattice, &triangles) > 100);
    check("on a lattice", &lattice, &triangles, 1000);
}

#[test]
fn triangles_that_are_hard() {
    let lattice = Lattice::cube(32);
    let region = Region::scene(&lattice);
    let mut rng = Rng::with_seed(3);
    let mut some =
        |number, voxels: i64, step| hardened(region.triangles(&mut rng, number, voxels * VOXEL, step), step);
    let triangles = [some(1500, 2, VOXEL / 8), some(300, 8, 1), some(60, 29, VOXEL / 2)].concat();
    assert!(touched(&lattice, &triangles) > 10);
    check("hard", &lattice, &triangles, 1000);
}

/// A window in a larger scene: triangles lie inside, partly inside, and outside.
#[test]
fn triangles_beyond_the_grid() {
    for (seed, window, at) in
        [(4, 0.5, [0.5, 0.5, 0.5]), (5, 0.25, [0.25, 0.5, 0.875]), (6, 0.5, [0.0, 1.0, 0.5])]
    {
        let lattice = Lattice::window(16, window, at);
        let mut rng = Rng::with_seed(seed);
        let scene = Region::scene(&lattice);
        // Around the grid, within the scene.
        let around =
            Region { low: scene.low.map(|x| x.max(-8 * VOXEL)), high: scene.high.map(|x| x.min(24 * VOXEL)) };
        let mut some = |region: Region, number, voxels: i64, step| {
            region.triangles(&mut rng, number, voxels * VOXEL, step)
        };
        let triangles = [
            some(around, 2000, 3, 1),
            some(around, 300, 16, 1),
            hardened(some(around, 1000, 4, VOXEL / 8), VOXEL / 8),
            some(scene, 300, 64, VOXEL / 4),
        ]
        .concat();
        let outside = |t: &Triangle| oracle::voxels_around(t, lattice.grid.size).next().is_none();
        let out = triangles.iter().filter(|t| outside(t)).count();
        assert!(out > 300 && out + 300 < triangles.len(), "{out} of {} lie outside", triangles.len());
        check(&format!("a window of {window} around {at:?}"), &lattice, &triangles, 200);
    }
}
