//! The voxelizer against exact tests of overlap, in integers.

use super::integrator::noise;
use super::program::{render, shipped};
use super::scenes::Studio;
use super::world::World;
use std::path::Path;

const RESOLUTION: i64 = 32;
/// The voxelizer snaps corners to this part of a voxel. Units here are half of it, so that centres are whole.
const SNAP: i64 = 4096;
const VOXEL: i64 = 2 * SNAP;

type Point = [i64; 3];
type Triangle = [Point; 3];

/// Which rule says that a triangle fills a voxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rule {
    /// 26-separating: it meets the cube.
    Conservative,
    /// 6-separating (Schwarz and Seidel 2010, "Fast Parallel Surface and Solid Voxelization on GPUs", 4.1): the plane
    /// meets the voxel's axis that is nearest to the normal, and in each projection every edge has an end of the
    /// voxel's two axes on its inner side.
    Thin,
}

/// What happens when they only touch.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ties {
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
    let half = i128::from(SNAP);
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
        // Separating axes (Akenine-Möller 2001): the cube's, the normal, and each edge with each of the cube's.
        Rule::Conservative => {
            let reach = |axis: [i128; 3]| half * axis.iter().map(|x| x.abs()).sum::<i128>();
            let sides = || edges.iter().flat_map(|edge| units.iter().map(|unit| cross(*edge, *unit)));
            boxes && along(n, reach(n)) && sides().all(|axis| along(axis, reach(axis)))
        }
        Rule::Thin => {
            let largest = size.into_iter().max().unwrap_or_default();
            let projections = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];
            boxes
                && along(n, half * largest)
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

/// For each voxel how many triangles fill it. Triangles without area fill nothing; a voxel that a triangle touches only
/// with its upper sides from outside (its box would end there) is not filled.
fn count(triangles: &[Triangle], rule: Rule, ties: Ties) -> Vec<u32> {
    let mut counts = vec![0; (RESOLUTION * RESOLUTION * RESOLUTION) as usize];
    for triangle in triangles {
        if cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0])) == [0; 3] {
            continue;
        }
        let range = |axis: usize| {
            let places = triangle.map(|corner| corner[axis].div_euclid(VOXEL));
            let (low, high) = (places.into_iter().min(), places.into_iter().max());
            low.unwrap_or_default()..=high.unwrap_or_default()
        };
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let center = [x, y, z].map(|i| i * VOXEL + SNAP);
                    let number = ((z * RESOLUTION + y) * RESOLUTION + x) as usize;
                    counts[number] += u32::from(fills(triangle, center, rule, ties));
                }
            }
        }
    }
    counts
}

/// What the program's voxelizer counts.
fn counted(scene: &Path, rule: Rule) -> Vec<u32> {
    let separability = if rule == Rule::Thin { 6 } else { 26 };
    let options = format!("--set resolution={RESOLUTION} --set separability={separability}");
    let [picture] = render(scene, "occupancy", &options, ["occupancy"]);
    picture.texels().map(|texel| texel[0] as u32).collect()
}

/// Voxels that differ, and how many are filled.
fn differences(a: &[u32], b: &[u32]) -> (usize, usize) {
    assert_eq!(a.len(), b.len());
    (a.iter().zip(b).filter(|(a, b)| a != b).count(), b.iter().filter(|n| **n > 0).count())
}

/// Triangles whose corners lie on a lattice of `step` units, within `reach` voxels of each other; two small ones in
/// the corners of the scene fix the grid.
fn random(number: u64, reach: i64, step: i64) -> Vec<Triangle> {
    // The grid keeps 1.5 voxels around the scene.
    let (low, high) = (3 * SNAP, 3 * SNAP + 29 * VOXEL);
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

/// The program's scene of these triangles. A voxel becomes 1/32 m, so that no position is rounded anywhere.
fn scene(studio: &Studio, triangles: &[Triangle]) -> std::path::PathBuf {
    let metres = |x: i64| (x - 3 * SNAP) as f32 / (VOXEL * 32) as f32;
    let triangles: Vec<_> = triangles.iter().map(|t| t.map(|corner| corner.map(metres))).collect();
    studio.triangles(&triangles)
}

/// No voxel more and none less: triangles of all sizes whose corners lie anywhere, so that they do not just touch.
#[test]
fn the_voxelizer_is_exact() {
    let studio = Studio::new();
    let triangles = [random(300, 2, 2), random(60, 8, 2), random(20, 29, 2)].concat();
    let scene = scene(&studio, &triangles);
    for (rule, other) in [(Rule::Thin, Rule::Conservative), (Rule::Conservative, Rule::Thin)] {
        let exact = count(&triangles, rule, Ties::Count);
        let counted = counted(&scene, rule);
        let (wrong, filled) = differences(&counted, &exact);
        println!("{rule:?}: {filled} voxels filled, {wrong} differ");
        assert_eq!(wrong, 0);
        assert!(differences(&counted, &count(&triangles, other, Ties::Count)).0 > 100, "the rules differ");
    }
}

/// On a coarse lattice many triangles just touch voxels, or lie along their faces: those may count or not, others must.
#[test]
fn the_voxelizer_is_exact_up_to_touching() {
    let studio = Studio::new();
    let triangles = [random(300, 2, VOXEL / 4), random(60, 8, VOXEL / 2), random(40, 29, VOXEL)].concat();
    let scene = scene(&studio, &triangles);
    for rule in [Rule::Thin, Rule::Conservative] {
        let counted = counted(&scene, rule);
        let open = count(&triangles, rule, Ties::DoNotCount);
        let closed = count(&triangles, rule, Ties::Count);
        let wrong = (0..counted.len()).filter(|i| !(open[*i]..=closed[*i]).contains(&counted[*i])).count();
        let touching = differences(&open, &closed).0;
        println!("{rule:?}: {wrong} wrong, {touching} touched only");
        assert!(touching > 100, "something just touches");
        assert_eq!(wrong, 0);
    }
}

/// The Cornell box at 32³, its corners snapped as the voxelizer says it does.
#[test]
fn the_cornell_box_is_voxelized_exactly() {
    let path = shipped("scenes/cornell-point.glb");
    let world = World::load(&path);
    let corners = || world.facets.iter().flat_map(|f| f.corners);
    let low = corners().reduce(|a, b| a.min(b)).unwrap_or_default();
    let high = corners().reduce(|a, b| a.max(b)).unwrap_or_default();
    let voxel = (high - low).max_element() / (RESOLUTION - 3) as f64;
    let snapped = |x: f64, axis: usize| {
        let place = (x as f32 - (low[axis] - 1.5 * voxel) as f32) / voxel as f32;
        2 * (place * SNAP as f32).round_ties_even() as i64
    };
    let triangle = |corners: [glam::DVec3; 3]| corners.map(|c| [0, 1, 2].map(|axis| snapped(c[axis], axis)));
    let triangles: Vec<Triangle> = world.facets.iter().map(|f| triangle(f.corners)).collect();
    for rule in [Rule::Thin, Rule::Conservative] {
        let exact = count(&triangles, rule, Ties::Count);
        let open = count(&triangles, rule, Ties::DoNotCount);
        let counted = counted(&path, rule);
        let (wrong, filled) = differences(&counted, &exact);
        println!(
            "Cornell {rule:?}: {filled} filled, {wrong} differ, {} touched only",
            differences(&open, &exact).0
        );
        assert_eq!(wrong, 0);
    }
}
