//! Grids on which no position is rounded, so that what the voxelizer sees is known to the unit.
//!
//! The voxelizer computes `(p - grid_min) / voxel_size` in single floats. Here `voxel_size` is a power of two and all
//! positions are whole units of a voxel's 4096th, so that the division is exact, and the subtraction where its result has
//! no more than 24 bits. Two small triangles in opposite corners of the scene fix its bounds, and with them the grid.

use crate::model::{Model, Part};
use crate::oracle::{HALF, Point, Triangle, VOXEL};
use crate::voxelizer::Grid;
use voxgi::scene::Scene;

#[derive(Clone, Debug)]
pub struct Lattice {
    pub grid: Grid,
    /// The scene's corners in units, counted from the grid's.
    pub low: Point,
    pub high: Point,
    /// A voxel's side in metres, a power of two.
    pub voxel: f64,
    /// Where the scene's smallest corner lies, metres.
    pub origin: [f64; 3],
}

/// What the grids `grid/cube` and `grid/box` keep around the scene at each end, in units.
fn margin(resolution: i64) -> i64 {
    (resolution * VOXEL - side(resolution)) / 2
}

/// The scene's largest side in units: all but three voxels, or half of few.
fn side(resolution: i64) -> i64 {
    ((resolution - 3) * VOXEL).max(resolution * HALF)
}

impl Lattice {
    /// `grid/cube` around a scene that is as large as it may be.
    pub fn cube(resolution: i64) -> Self {
        let low = margin(resolution);
        let high = low + side(resolution);
        Self {
            grid: Grid::cube(resolution),
            low: [low; 3],
            high: [high; 3],
            voxel: 1.0 / 32.0,
            origin: [0.0; 3],
        }
    }

    /// `grid/box` around a scene whose sides are these parts of its largest; one must be 1.
    pub fn oblong(resolution: i64, parts: [f64; 3]) -> Self {
        let extent = parts.map(|part| (part * side(resolution) as f64) as i64);
        let room = resolution * VOXEL - side(resolution);
        let size = extent.map(|extent| (extent + room + VOXEL - 1).div_euclid(VOXEL));
        let cube = Self::cube(resolution);
        let high = [0, 1, 2].map(|axis| cube.low[axis] + extent[axis]);
        let grid = Grid { part: "grid/box", size, ..cube.grid };
        Self { grid, high, ..cube }
    }

    /// `grid/window` of a cube of a scene, `window` times its side and around the point at `at`, of its bounds.
    pub fn window(resolution: i64, window: f64, at: [f64; 3]) -> Self {
        let side = (resolution as f64 / window).round() * VOXEL as f64;
        let low = at.map(|at| resolution * HALF - (at * side) as i64);
        let high = low.map(|low| low + side as i64);
        let knobs = [("window", window), ("window_x", at[0]), ("window_y", at[1]), ("window_z", at[2])];
        let mut grid = Grid { part: "grid/window", ..Grid::cube(resolution) };
        grid.knobs.extend(knobs.map(|(knob, value)| (knob, value.to_string())));
        Self { grid, low, high, voxel: 1.0 / 32.0, origin: [0.0; 3] }
    }

    /// A unit of the grid in metres along an axis.
    fn place(&self, unit: i64, axis: usize) -> f64 {
        self.origin[axis] + (unit - self.low[axis]) as f64 * self.voxel / VOXEL as f64
    }

    /// A corner in metres; nothing may be rounded, here or where the voxelizer takes the grid's corner from it.
    pub fn metres(&self, corner: Point) -> [f32; 3] {
        [0, 1, 2].map(|axis| {
            let exact = self.place(corner[axis], axis);
            let begin = self.place(0, axis);
            let single = |x: f64| f64::from(x as f32) == x;
            assert!(
                single(exact) && single(begin) && single(exact - begin),
                "{corner:?} is rounded: {self:?}"
            );
            exact as f32
        })
    }

    /// With two more triangles that fix the grid, first.
    pub fn fixed(&self, triangles: &[Triangle]) -> Vec<Triangle> {
        let (low, high) = (self.low, self.high);
        let step = |from: Point, axis: usize, to: Point| {
            let mut corner = from;
            corner[axis] += (to[axis] - from[axis]) / 16;
            corner
        };
        let fixing =
            [(low, high), (high, low)].map(|(from, to)| [from, step(from, 0, to), step(from, 1, to)]);
        [&fixing[..], triangles].concat()
    }

    pub fn part(&self, triangles: &[Triangle]) -> Part {
        Part::new(triangles.iter().flatten().map(|corner| self.metres(*corner)).collect())
    }

    pub fn scene(&self, triangles: &[Triangle]) -> Scene {
        self.loaded(&Model { parts: vec![self.part(triangles)], ..Model::default() })
    }

    /// Sees that the grid lies where it should.
    pub fn loaded(&self, model: &Model) -> Scene {
        let scene = model.load();
        let bounds = [scene.bounds.min, scene.bounds.max].map(|corner| corner.to_array());
        assert_eq!(bounds, [self.low, self.high].map(|corner| self.metres(corner)), "the scene's bounds");
        scene
    }
}
