//! Which voxels triangles fill, by exact tests of overlap in integers. It shares no code with the kernels.
//!
//! A voxel's side is [`VOXEL`] units; voxel i covers the units from i · VOXEL to (i + 1) · VOXEL, both included for the
//! conservative rule. Corners are odd units, so that none lies there.

use rayon::prelude::*;
use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicU64, Ordering};

/// Units of a voxel's side. The voxelizer snaps corners to odd ones.
pub const VOXEL: i64 = 4096;
pub const HALF: i64 = VOXEL / 2;
/// Corners farther out than this are moved there, in units.
const OUTMOST: i64 = 131_072 * VOXEL;

pub type Point = [i64; 3];
pub type Triangle = [Point; 3];

/// Which rule says that a triangle fills a voxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// 26-separating: it meets the cube.
    Conservative,
    /// 6-separating (Schwarz and Seidel 2010, "Fast Parallel Surface and Solid Voxelization on GPUs", 4.1): the plane
    /// meets the voxel's axis that is nearest to the normal (of equal ones z, then x), its upper end not included; and
    /// in each projection every edge has an end of the voxel's two axes on its inner side.
    Thin,
    /// The same without the bounds: a voxel beyond them is filled too, beside a sharp corner, if the plane and all
    /// projections say so. Published counts are of this set. No voxelizer here has it.
    ThinBeyond,
}

impl Rule {
    pub const BOTH: [Self; 2] = [Self::Thin, Self::Conservative];

    /// The knob's value.
    pub fn separability(self) -> &'static str {
        if self == Self::Conservative { "26" } else { "6" }
    }

    /// How many voxels beyond a triangle's bounds are asked about.
    fn beyond(self) -> i64 {
        i64::from(self == Self::ThinBeyond)
    }
}

/// What happens when they only touch.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Ties {
    Count,
    DoNotCount,
}

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn cross(a: Point, b: Point) -> [i128; 3] {
    let [a, b] = [a, b].map(|v| v.map(i128::from));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [i128; 3], b: Point) -> i128 {
    (0..3).map(|i| a[i] * i128::from(b[i])).sum()
}

/// Whether `triangle` fills the voxel around `center`, whose side is `2 * half` units.
fn fills(triangle: &Triangle, center: Point, half: i64, rule: Rule, ties: Ties) -> bool {
    let t = triangle.map(|corner| minus(corner, center));
    let edges = [minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])];
    let n = cross(edges[0], edges[1]);
    let half = i128::from(half);
    // `gap`: how far apart, at most 0 if they meet.
    let meet = |gap: i128| gap < 0 || (gap == 0 && ties == Ties::Count);
    let along = |axis: [i128; 3], reach: i128| {
        let places = t.map(|corner| dot(axis, corner));
        let low = places.into_iter().min().unwrap_or_default();
        let high = places.into_iter().max().unwrap_or_default();
        axis == [0; 3] || (meet(low - reach) && meet(-high - reach))
    };
    let units = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let boxes = units.iter().all(|axis| along(axis.map(i128::from), half));
    let size = n.map(i128::abs);
    match rule {
        // Without area it is a segment or a point, and fills what it meets.
        Rule::Thin | Rule::ThinBeyond if n == [0; 3] => {
            fills(triangle, center, half as i64, Rule::Conservative, ties)
        }
        // Separating axes (Akenine-Möller 2001): the cube's, the normal, and each edge with each of the cube's.
        Rule::Conservative => {
            let reach = |axis: [i128; 3]| half * axis.iter().map(|x| x.abs()).sum::<i128>();
            let sides = || edges.iter().flat_map(|edge| units.iter().map(|unit| cross(*edge, *unit)));
            boxes && along(n, reach(n)) && sides().all(|axis| along(axis, reach(axis)))
        }
        Rule::Thin | Rule::ThinBeyond => {
            let largest = size.into_iter().max().unwrap_or_default();
            let nearest = [2, 0, 1].into_iter().find(|axis| size[*axis] == largest).unwrap_or_default();
            // Of the plane above the middle, along the axis; times the largest component.
            let above = dot(n, t[0]) * n[nearest].signum();
            let plane = match ties {
                Ties::Count => (-half * largest..half * largest).contains(&above),
                Ties::DoNotCount => above.abs() < half * largest,
            };
            let projections = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];
            (boxes || rule == Rule::ThinBeyond)
                && plane
                && projections.iter().all(|&(u, v, w)| {
                    (0..3).all(|i| {
                        let (edge, from) = (edges[i], t[i]);
                        let inward = [-edge[v], edge[u]].map(|x| i128::from(x) * n[w].signum());
                        let reach = half * inward[0].abs().max(inward[1].abs());
                        let inside = -(inward[0] * i128::from(from[u]) + inward[1] * i128::from(from[v]));
                        n[w] == 0 || meet(-inside - reach)
                    })
                })
        }
    }
}

/// What the voxelizer does to corners first.
pub fn snapped(triangles: &[Triangle]) -> Vec<Triangle> {
    let odd = |x: i64| 2 * x.clamp(-OUTMOST, OUTMOST).div_euclid(2) + 1;
    triangles.iter().map(|triangle| triangle.map(|corner| corner.map(odd))).collect()
}

/// The voxels along an axis of a grid with `size` of them, `side` units each, that a triangle's bounds meet; and
/// `beyond` on either side.
fn range(triangle: &Triangle, axis: usize, size: i64, side: i64, beyond: i64) -> RangeInclusive<i64> {
    let places = triangle.map(|corner| corner[axis].div_euclid(side));
    let (low, high) = (places.into_iter().min(), places.into_iter().max());
    (low.unwrap_or_default() - beyond).max(0)..=(high.unwrap_or_default() + beyond).min(size - 1)
}

/// The voxels of a grid that a triangle's bounds meet, and `beyond` on all sides.
fn around(triangle: &Triangle, size: Point, side: i64, beyond: i64) -> impl Iterator<Item = Point> {
    let [x, y, z] = [0, 1, 2].map(|axis| range(triangle, axis, size[axis], side, beyond));
    z.flat_map(move |z| {
        let x = x.clone();
        y.clone().flat_map(move |y| x.clone().map(move |x| [x, y, z]))
    })
}

pub fn voxels_around(triangle: &Triangle, size: Point) -> impl Iterator<Item = Point> {
    around(triangle, size, VOXEL, 0)
}

/// The center of a voxel whose side is `side` units.
fn center(voxel: Point, side: i64) -> Point {
    voxel.map(|i| i * side + side / 2)
}

/// The voxels of a grid that a triangle fills, where a voxel's side is `side` units.
pub fn voxels(
    triangle: &Triangle,
    size: Point,
    side: i64,
    rule: Rule,
    ties: Ties,
) -> impl Iterator<Item = Point> {
    around(triangle, size, side, rule.beyond())
        .filter(move |voxel| fills(triangle, center(*voxel, side), side / 2, rule, ties))
}

/// A voxel's place in lists: x fastest.
pub fn number([x, y, z]: Point, size: Point) -> usize {
    ((z * size[1] + y) * size[0] + x) as usize
}

/// For each voxel how many triangles fill it.
pub fn count(triangles: &[Triangle], size: Point, rule: Rule, ties: Ties) -> Vec<u32> {
    let mut counts = vec![0; size.into_iter().product::<i64>() as usize];
    for triangle in triangles {
        voxels(triangle, size, VOXEL, rule, ties).for_each(|voxel| counts[number(voxel, size)] += 1);
    }
    counts
}

/// How many voxels differ.
pub fn differences(a: &[u32], b: &[u32]) -> usize {
    assert_eq!(a.len(), b.len(), "grids of other sizes");
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

pub fn filled(counts: &[u32]) -> usize {
    counts.iter().filter(|count| **count > 0).count()
}

/// Voxels of a grid, a bit each in the order of [`number`].
pub struct Set(Vec<u64>);

impl Set {
    /// What any of the triangles fills, where a voxel's side is `side` units and touching counts. All processors work
    /// on it, and what is filled isn't asked about again.
    pub fn of(triangles: &[Triangle], size: Point, side: i64, rule: Rule) -> Self {
        let voxels = size.into_iter().product::<i64>() as usize;
        let words: Vec<_> = (0..voxels.div_ceil(64)).map(|_| AtomicU64::new(0)).collect();
        triangles.par_iter().for_each(|triangle| {
            for voxel in around(triangle, size, side, rule.beyond()) {
                let at = number(voxel, size);
                let (word, bit) = (&words[at / 64], 1 << (at % 64));
                let known = word.load(Ordering::Relaxed) & bit != 0;
                if !known && fills(triangle, center(voxel, side), side / 2, rule, Ties::Count) {
                    word.fetch_or(bit, Ordering::Relaxed);
                }
            }
        });
        Self(words.into_iter().map(AtomicU64::into_inner).collect())
    }

    pub fn filled(&self) -> usize {
        self.0.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// How many voxels are in one of the two alone.
    pub fn differences(&self, other: &Self) -> usize {
        assert_eq!(self.0.len(), other.0.len(), "grids of other sizes");
        self.0.iter().zip(&other.0).map(|(a, b)| (a ^ b).count_ones() as usize).sum()
    }
}
