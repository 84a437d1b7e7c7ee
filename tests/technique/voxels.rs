//! The voxelizer against exact tests of overlap, in integers.

use super::integrator::noise;
use super::program::{render, shipped};
use super::scenes::Studio;
use super::support::scenes;
use glam::Vec3;
use std::path::Path;
use voxgi::scene::layout::Instance;

const RESOLUTION: i64 = 32;
/// Units of a voxel's side. The voxelizer snaps corners to odd ones.
const VOXEL: i64 = 4096;
const HALF: i64 = VOXEL / 2;

type Point = [i64; 3];
type Triangle = [Point; 3];

/// Which rule says that a triangle fills a voxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// 26-separating: it meets the cube.
    Conservative,
    /// 6-separating (Schwarz and Seidel 2010, "Fast Parallel Surface and Solid Voxelization on GPUs", 4.1): the plane
    /// meets the voxel's axis that is nearest to the normal (of equal ones z, then x), its upper end not included; and
    /// in each projection every edge has an end of the voxel's two axes on its inner side.
    Thin,
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

/// Whether `triangle` fills the voxel around `center`.
fn fills(triangle: &Triangle, center: Point, rule: Rule, ties: Ties) -> bool {
    let t = triangle.map(|corner| minus(corner, center));
    let edges = [minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])];
    let n = cross(edges[0], edges[1]);
    let half = i128::from(HALF);
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
        Rule::Thin if n == [0; 3] => fills(triangle, center, Rule::Conservative, ties),
        // Separating axes (Akenine-Möller 2001): the cube's, the normal, and each edge with each of the cube's.
        Rule::Conservative => {
            let reach = |axis: [i128; 3]| half * axis.iter().map(|x| x.abs()).sum::<i128>();
            let sides = || edges.iter().flat_map(|edge| units.iter().map(|unit| cross(*edge, *unit)));
            boxes && along(n, reach(n)) && sides().all(|axis| along(axis, reach(axis)))
        }
        Rule::Thin => {
            let largest = size.into_iter().max().unwrap_or_default();
            let nearest = [2, 0, 1].into_iter().find(|axis| size[*axis] == largest).unwrap_or_default();
            // Of the plane above the middle, along the axis; times the largest component.
            let above = dot(n, t[0]) * n[nearest].signum();
            let plane = match ties {
                Ties::Count => (-half * largest..half * largest).contains(&above),
                Ties::DoNotCount => above.abs() < half * largest,
            };
            let projections = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];
            boxes
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

/// For each voxel how many triangles fill it.
pub fn count(triangles: &[Triangle], resolution: i64, rule: Rule, ties: Ties) -> Vec<u32> {
    let mut counts = vec![0; (resolution * resolution * resolution) as usize];
    for triangle in triangles {
        let range = |axis: usize| {
            let places = triangle.map(|corner| corner[axis].div_euclid(VOXEL));
            let (low, high) = (places.into_iter().min(), places.into_iter().max());
            low.unwrap_or_default()..=high.unwrap_or_default()
        };
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let center = [x, y, z].map(|i| i * VOXEL + HALF);
                    let number = ((z * resolution + y) * resolution + x) as usize;
                    counts[number] += u32::from(fills(triangle, center, rule, ties));
                }
            }
        }
    }
    counts
}

/// What the program's voxelizer counts.
pub fn counted(scene: &Path, resolution: i64, rule: Rule) -> Vec<u32> {
    let separability = if rule == Rule::Thin { 6 } else { 26 };
    let options = format!("--set resolution={resolution} --set separability={separability}");
    let [picture] = render(scene, "occupancy", &options, ["occupancy"]);
    picture.texels().map(|texel| texel[0] as u32).collect()
}

pub fn filled(counts: &[u32]) -> usize {
    counts.iter().filter(|count| **count > 0).count()
}

/// Voxels that differ, and how many are filled.
fn differences(a: &[u32], b: &[u32]) -> (usize, usize) {
    assert_eq!(a.len(), b.len());
    (a.iter().zip(b).filter(|(a, b)| a != b).count(), filled(b))
}

/// Triangles whose corners lie on a lattice of `step` units, within `reach` voxels of each other; two small ones in
/// the corners of the scene fix the grid.
pub fn random(number: u64, reach: i64, step: i64) -> Vec<Triangle> {
    // The grid keeps 1.5 voxels around the scene.
    let (low, high) = (3 * HALF, 3 * HALF + 29 * VOXEL);
    let pick =
        |n: u64, low: i64, high: i64| low + step * (noise(n) * ((high - low) / step + 1) as f64) as i64;
    let mut triangles = vec![
        [[low; 3], [low + VOXEL, low, low], [low, low + VOXEL, low]],
        [[high; 3], [high - VOXEL, high, high], [high, high - VOXEL, high]],
    ];
    for i in 0..number {
        let n = |corner: u64, axis: u64| (reach as u64) << 40 | i << 8 | corner << 4 | axis;
        let start = [0, 1, 2].map(|axis| pick(n(3, axis), low, (high - reach * VOXEL).max(low)));
        let end = start.map(|x| (x + reach * VOXEL).min(high));
        triangles.push([0, 1, 2].map(|corner| {
            [0, 1, 2].map(|axis| pick(n(corner, axis), start[axis as usize], end[axis as usize]))
        }));
    }
    triangles
}

/// Some made to what is hard: points, segments along axes and across, slivers, triangles in a plane along the axes.
pub fn hard(mut triangles: Vec<Triangle>) -> Vec<Triangle> {
    for (i, [a, b, c]) in triangles.iter_mut().enumerate().skip(2) {
        match i % 8 {
            0 => (*b, *c) = (*a, *a),
            1 => *c = *b,
            2 => *c = [0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2),
            3 => (b[1], c[1]) = (a[1], a[1]),
            4 => (b[0], b[2], *c) = (a[0], a[2], *a),
            5 => *c = [b[0] + 2, b[1], b[2]],
            6 => (b[0], c[0]) = (a[0], a[0]),
            _ => (b[2], c[2]) = (a[2], a[2]),
        }
    }
    triangles
}

pub fn snapped(triangles: &[Triangle]) -> Vec<Triangle> {
    let odd = |x: i64| 2 * x.div_euclid(2) + 1;
    triangles.iter().map(|triangle| triangle.map(|corner| corner.map(odd))).collect()
}

/// The program's scene of these triangles. A voxel becomes 1/32 m, so that no position is rounded anywhere.
pub fn scene(studio: &Studio, triangles: &[Triangle]) -> std::path::PathBuf {
    let metres = |x: i64| (x - 3 * HALF) as f32 / (VOXEL * 32) as f32;
    let triangles: Vec<_> = triangles.iter().map(|t| t.map(|corner| corner.map(metres))).collect();
    studio.triangles(&triangles)
}

/// No voxel more and none less. Corners lie anywhere, or on a coarse lattice, so that triangles just touch voxels and
/// lie along their faces.
#[test]
fn the_voxelizer_is_exact() {
    let studio = Studio::new();
    let sets = [
        ("anywhere", [random(4000, 2, 1), random(600, 8, 1), random(80, 29, 1)].concat()),
        (
            "on a lattice",
            [random(3000, 2, VOXEL / 4), random(500, 8, VOXEL / 2), random(60, 29, VOXEL)].concat(),
        ),
        (
            "hard",
            [hard(random(1500, 2, VOXEL / 8)), hard(random(300, 8, 1)), hard(random(60, 29, VOXEL / 2))]
                .concat(),
        ),
    ];
    for (kind, triangles) in sets {
        let scene = scene(&studio, &triangles);
        let triangles = snapped(&triangles);
        for (rule, other) in [(Rule::Thin, Rule::Conservative), (Rule::Conservative, Rule::Thin)] {
            let count = |rule, ties| count(&triangles, RESOLUTION, rule, ties);
            let exact = count(rule, Ties::Count);
            let counted = counted(&scene, RESOLUTION, rule);
            let (wrong, filled) = differences(&counted, &exact);
            let touching = differences(&count(rule, Ties::DoNotCount), &exact).0;
            println!("{kind}, {rule:?}: {filled} voxels filled, {touching} touched only, {wrong} differ");
            assert_eq!(wrong, 0, "{kind}, {rule:?}");
            assert!(kind == "anywhere" || touching > 10, "something just touches: {touching}");
            assert!(differences(&counted, &count(other, Ties::Count)).0 > 100, "the rules differ");
        }
    }
}

/// Sees that a scene is voxelized as its triangles say, their corners snapped as the voxelizer says it does.
fn check(path: &Path, resolution: i64) {
    let scene = voxgi::scene::load(path).expect("the scene");
    let unmoved = |instance: &Instance| {
        let columns = instance.to_world.map(|column| column.truncate());
        columns == [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO]
    };
    assert!(scene.instances.iter().all(unmoved), "the oracle moves nothing");
    let (low, high) = (scene.bounds.min, scene.bounds.max);
    let voxel = f64::from((high - low).max_element()) / (resolution - 3) as f64;
    let snapped = |x: f32, axis: usize| {
        let place = (x - (f64::from(low[axis]) - 1.5 * voxel) as f32) / voxel as f32;
        2 * (place * HALF as f32).floor() as i64 + 1
    };
    let corner = |vertex: u32| {
        let position = scene.vertices[vertex as usize].position;
        [0, 1, 2].map(|axis| snapped(position[axis], axis))
    };
    let triangles: Vec<Triangle> = scene.triangles.iter().map(|t| [t.a, t.b, t.c].map(corner)).collect();
    for (rule, other) in [(Rule::Thin, Rule::Conservative), (Rule::Conservative, Rule::Thin)] {
        let exact = count(&triangles, resolution, rule, Ties::Count);
        let counted = counted(path, resolution, rule);
        let (wrong, filled) = differences(&counted, &exact);
        println!("{} at {resolution}³, {rule:?}: {filled} filled, {wrong} differ", path.display());
        assert_eq!(wrong, 0);
        assert!(differences(&counted, &count(&triangles, resolution, other, Ties::Count)).0 > 100);
    }
}

#[test]
fn the_cornell_box_is_voxelized_exactly() {
    check(&shipped("scenes/cornell-point.glb"), 32);
}

#[test]
fn scans_are_voxelized_exactly() {
    let Some(folder) = scenes() else { return };
    for (scene, resolution) in
        [("bunny.glb", 64), ("bunny.glb", 128), ("dragon-100k.glb", 64), ("dragon-100k.glb", 128)]
    {
        check(&folder.join(scene), resolution);
    }
}

/// The integers that decide where floats are not sure, of all sizes.
#[test]
fn wide_integers_are_exact() {
    let [picture] = render(&shipped("scenes/cornell-point.glb"), "wide", "", ["wide"]);
    let texels: Vec<&[f32]> = picture.texels().collect();
    let hash = |x: u32| -> u32 {
        let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
        (word >> 22) ^ word
    };
    let chosen = |index: u32| i128::from(hash(index).cast_signed() >> (1 + hash(hash(index)) % 31));
    let (mut largest, mut negative) = (0, 0);
    for (y, row) in texels.chunks_exact(192).enumerate() {
        for (x, found) in row.chunks_exact(3).enumerate() {
            let first = 8 * (y * 192 + x) as u32;
            let [a, b, c, d, e, f, g, h] = std::array::from_fn(|i| chosen(first + i as u32));
            let (one, other) = (a * b - c * d, e * f);
            let sum = one * g + other * h;
            let halves = found[0].iter().chain(found[1]).rev();
            let value = halves.fold(0_u128, |value, half| value << 16 | *half as u128).cast_signed();
            assert_eq!(value, sum, "({a} · {b} − {c} · {d}) · {g} + {e} · {f} · {h}");
            let [sign, factor_sign, float, less] = [0, 1, 2, 3].map(|i| found[2][i]);
            assert_eq!([sign, factor_sign], [sum.signum() as f32, one.signum() as f32]);
            assert!((f64::from(float) - one as f64).abs() <= one.abs() as f64 * 2.5e-7, "{one}");
            assert_eq!(less == 1.0, one.abs() < other.abs());
            (largest, negative) = (largest.max(sum.abs()), negative + usize::from(sum < 0));
        }
    }
    assert!(largest > 1 << 80 && negative > 1000, "{largest} {negative}");
}
