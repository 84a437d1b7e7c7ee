//! What of a triangle lies in a voxel: its area is its weight there, its middle is where attributes are taken.

use crate::lattice::Lattice;
use crate::model::{Model, Part};
use crate::oracle::{self, Point, Rule, Ties, Triangle, VOXEL, number};
use crate::random::{Region, hardened};
use crate::sums::Sums;
use crate::voxelizer::METHODS;
use fastrand::Rng;
use glam::DVec3;

/// Units of a weight: of a voxel's face, and the least and the greatest weight.
const FACE: f64 = 65536.0;
const WEIGHTS: (f64, f64) = (256.0, 92682.0);
/// In faces. Of smaller pieces the middle is not asked for.
const LEAST: f64 = 1e-4;

#[derive(Clone, Copy)]
pub struct Piece {
    /// In voxels².
    pub area: f64,
    /// In voxels, from the voxel's lowest corner; of what has an area.
    pub middle: DVec3,
}

impl Piece {
    /// By cutting a polygon at one face of the voxel after the other (Sutherland and Hodgman 1974).
    pub fn of(triangle: &Triangle, voxel: Point) -> Self {
        let place = |corner: Point| {
            DVec3::from_array([0, 1, 2].map(|i| (corner[i] - voxel[i] * VOXEL) as f64 / VOXEL as f64))
        };
        let mut polygon: Vec<DVec3> = triangle.iter().map(|corner| place(*corner)).collect();
        for axis in 0..3 {
            for (sign, bound) in [(1.0, 0.0), (-1.0, 1.0)] {
                let inside = |p: DVec3| sign * (p[axis] - bound);
                let mut rest = Vec::with_capacity(9);
                for (i, a) in polygon.iter().enumerate() {
                    let b = polygon[(i + 1) % polygon.len()];
                    let (at_a, at_b) = (inside(*a), inside(b));
                    if at_a >= 0.0 {
                        rest.push(*a);
                    }
                    if (at_a >= 0.0) != (at_b >= 0.0) {
                        rest.push(a.lerp(b, at_a / (at_a - at_b)));
                    }
                }
                polygon = rest;
            }
        }
        let (mut area, mut middle) = (0.0, DVec3::ZERO);
        for i in 2..polygon.len() {
            let fan = [polygon[0], polygon[i - 1], polygon[i]];
            let part = 0.5 * (fan[1] - fan[0]).cross(fan[2] - fan[0]).length();
            area += part;
            middle += part * (fan[0] + fan[1] + fan[2]) / 3.0;
        }
        Self { area, middle: middle / area.max(1e-300) }
    }

    pub fn weight(&self) -> f64 {
        (self.area * FACE).round().clamp(WEIGHTS.0, WEIGHTS.1)
    }
}

/// What a voxel's sums should be.
#[derive(Clone, Copy, Default)]
struct Expected {
    fragments: f64,
    weights: f64,
    albedo: DVec3,
    within: DVec3,
    /// If all weights were 1.
    even: DVec3,
    /// Weights of pieces whose middles are not asked for.
    small: f64,
}

fn expected(parts: &[(Vec<Triangle>, [f32; 3])], size: Point, rule: Rule) -> Vec<Expected> {
    let mut voxels = vec![Expected::default(); size.into_iter().product::<i64>() as usize];
    for (triangles, color) in parts {
        let color = DVec3::from_array(color.map(f64::from));
        for triangle in oracle::snapped(triangles) {
            for voxel in oracle::voxels(&triangle, size, VOXEL, rule, Ties::Count) {
                let piece = Piece::of(&triangle, voxel);
                let (sum, weight) = (&mut voxels[number(voxel, size)], piece.weight());
                sum.fragments += 1.0;
                sum.weights += weight;
                sum.albedo += weight * color;
                sum.even += color;
                if piece.area > 1.1 * LEAST {
                    sum.within += weight * piece.middle;
                } else {
                    sum.small += weight;
                }
            }
        }
    }
    voxels
}

/// Loose triangles of three colours: weights, colours and middles of all voxels.
#[test]
fn weights_are_areas_and_places_are_middles() {
    let lattice = Lattice::cube(24);
    let region = Region::scene(&lattice);
    let mut rng = Rng::with_seed(31);
    let mut some = |number, voxels: i64, step| region.triangles(&mut rng, number, voxels * VOXEL, step);
    let parts = [
        (lattice.fixed(&some(500, 2, 1)), [0.9_f32, 0.25, 0.1]),
        ([some(60, 12, 1), some(10, 20, 1)].concat(), [0.1, 0.75, 0.3]),
        ([some(100, 6, VOXEL / 2), hardened(some(400, 4, 512), 512)].concat(), [0.3, 0.3, 0.8]),
    ];
    let of =
        |(triangles, color): &(Vec<Triangle>, [f32; 3])| Part { color: *color, ..lattice.part(triangles) };
    let scene = lattice.loaded(&Model { parts: parts.iter().map(of).collect(), ..Model::default() });
    for rule in Rule::BOTH {
        let expected = expected(&parts, lattice.grid.size, rule);
        let sums = Sums::of(&scene, &lattice.grid, METHODS[0], rule);
        let (mut worst, mut filled, mut uneven) = ([0.0_f64; 3], 0, 0);
        for voxel in sums.filled() {
            let right = &expected[number(voxel, lattice.grid.size)];
            let words = sums.voxel(voxel).map(f64::from);
            let off = |at: usize, right: DVec3| {
                (DVec3::new(words[at], words[at + 1], words[at + 2]) - right).abs().max_element()
            };
            let own = [(words[0] - right.weights).abs(), off(1, right.albedo)];
            for (worst, off) in worst.iter_mut().zip(own) {
                *worst = worst.max(off / right.fragments);
            }
            if right.small == 0.0 {
                worst[2] = worst[2].max(off(7, right.within) / right.weights);
            }
            filled += 1;
            let even = right.even / right.fragments;
            uneven += usize::from((right.albedo / right.weights).distance(even) > 0.1);
        }
        println!("{rule:?}: {filled} voxels, off by {worst:?}");
        assert!(
            uneven > 200,
            "the control: {uneven} voxels would be others if all fragments weighed the same"
        );
        assert_eq!(filled, expected.iter().filter(|voxel| voxel.fragments > 0.0).count());
        // Units of a weight for each fragment. Parts of a voxel's side: half a unit of the least weight are 0.002, and of the
        // smallest pieces middles are known to 0.003.
        assert!(worst[0] < 4.0 && worst[1] < 4.0 && worst[2] < 0.006, "{worst:?}");
    }
}
