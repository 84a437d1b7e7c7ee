//! Hard cases: slivers, triangles much larger than the grid, plates on voxel planes, scenes far from the origin.

use crate::lattice::Lattice;
use crate::model::{Model, Part};
use crate::oracle::{self, Point, Rule, Triangle, VOXEL, number};
use crate::random::{Region, hardened};
use crate::voxelizer::{Case, METHODS, Way, check, counted};
use fastrand::Rng;

/// Longest side over the height on it; infinite without area.
fn aspect([a, b, c]: &Triangle) -> f64 {
    let edge = |p: &Point, q: &Point| [0, 1, 2].map(|i| (q[i] - p[i]) as f64);
    let squared = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
    let (u, v) = (edge(a, b), edge(a, c));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let longest = [u, v, edge(b, c)].map(squared).into_iter().fold(0.0, f64::max);
    longest / squared(n).sqrt()
}

/// The point of a lattice of `step` units below `t` of the way from a to b.
fn between(a: Point, b: Point, t: f64, step: i64) -> Point {
    [0, 1, 2].map(|i| (a[i] + ((b[i] - a[i]) as f64 * t) as i64).div_euclid(step) * step)
}

/// Long and thin at odd angles, a thousand voxels through a grid of 16: their third corner lies as near to the side as
/// units allow.
#[test]
fn slivers_of_an_aspect_of_a_million() {
    let lattice = Lattice::window(16, 1.0 / 64.0, [0.5; 3]);
    let scene = Region::scene(&lattice);
    let grid = Region { low: [0; 3], high: lattice.grid.size.map(|n| n * VOXEL) };
    let mut rng = Rng::with_seed(7);
    let slivers: Vec<Triangle> = (0..600)
        .map(|i| {
            let [[begin, ..], [through, ..]] = [scene, grid].map(|r| r.triangles(&mut rng, 1, 0, 1)[0]);
            // As far on the other side, or cut short.
            let end = [0, 1, 2].map(|i| 2 * through[i] - begin[i]);
            let short = rng.f64().powi(2);
            let end = if i % 2 == 0 { end } else { between(through, end, short, 1) };
            let mut near = between(begin, end, rng.f64(), 1);
            near[i % 3] += rng.i64(-2..=2);
            [begin, end, near]
        })
        .filter(|t| t.iter().flatten().all(|x| (scene.low[0]..=scene.high[0]).contains(x)))
        .collect();
    let aspects = oracle::snapped(&slivers);
    let extreme = aspects.iter().filter(|t| (1e6..f64::INFINITY).contains(&aspect(t))).count();
    println!("{extreme} of {} slivers have an aspect over a million", slivers.len());
    assert!(extreme > 200);
    check("slivers", &lattice, &slivers, 100);
}

/// Triangles a thousand times as long as the grid, through it; and so long that their corners are moved.
#[test]
fn triangles_much_larger_than_the_grid() {
    for (resolution, window, step) in [(16, 0.001, 8), (32, 0.0001, 128)] {
        let lattice = Lattice::window(resolution, window, [0.5; 3]);
        let scene = Region::scene(&lattice);
        let grid = Region { low: [0; 3], high: lattice.grid.size.map(|n| n * VOXEL) };
        let mut rng = Rng::with_seed(8);
        let mut large: Vec<Triangle> = Vec::new();
        while large.len() < 60 {
            let [a, b, _] = scene.triangles(&mut rng, 1, scene.high[0] - scene.low[0], step)[0];
            let [middle, ..] = grid.triangles(&mut rng, 1, 0, step)[0];
            let c = [0, 1, 2].map(|i| 3 * middle[i] - a[i] - b[i]);
            if c.iter().all(|x| (scene.low[0]..=scene.high[0]).contains(x)) {
                large.push([a, b, c]);
            }
        }
        // Some within the grid too: they have other sums of rounding.
        large.extend(grid.triangles(&mut rng, 200, 3 * VOXEL, step));
        check(&format!("{} times the grid", 1.0 / window), &lattice, &large, 1000);
    }
}

/// What lies on a plane between voxels belongs to those above: corners there are snapped to the unit above. Both
/// windings, all three axes; the plate reaches to a voxel's beginning, so this voxel is filled too.
#[test]
fn plates_on_voxel_planes() {
    let lattice = Lattice::cube(16);
    let (first, last, level) = (3, 9, 6);
    let mut plates: Vec<Triangle> = Vec::new();
    for axis in 0..3 {
        let corner = |u: i64, v: i64| {
            let mut corner = [level * VOXEL; 3];
            (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (u * VOXEL, v * VOXEL);
            corner
        };
        let [a, b, c, d] =
            [(first, first), (last, first), (last, last), (first, last)].map(|(u, v)| corner(u, v));
        plates.extend(if axis == 1 { [[a, c, b], [d, c, a]] } else { [[a, b, c], [a, c, d]] });
    }
    for axis in 0..3 {
        let triangles = lattice.fixed(&plates[2 * axis..2 * axis + 2]);
        let scene = lattice.scene(&triangles);
        Case { name: "a plate", scene: &scene, grid: &lattice.grid, triangles: &triangles, control: 0 }
            .check();
        let fixing = oracle::snapped(&lattice.fixed(&[]));
        for rule in Rule::BOTH {
            let fixing = oracle::count(&fixing, lattice.grid.size, rule, oracle::Ties::Count);
            for method in METHODS {
                let counted = counted(&scene, &lattice.grid, &Way { method, payload: "payload/bits", rule });
                let expected = |voxel: Point| {
                    (0..3).all(
                        |i| if i == axis { voxel[i] == level } else { (first..=last).contains(&voxel[i]) },
                    )
                };
                let all = (0..16).flat_map(|z| (0..16).flat_map(move |y| (0..16).map(move |x| [x, y, z])));
                for voxel in all {
                    let at = number(voxel, lattice.grid.size);
                    let plate = expected(voxel);
                    assert_eq!(
                        counted[at] == 1,
                        plate || fixing[at] > 0,
                        "{method}, {rule:?}, {axis}: {voxel:?}"
                    );
                }
            }
        }
    }
}

/// Ten kilometres from the origin single floats are 2^-10 m apart: a 256th of these voxels. Once the file says so, once
/// a node does.
#[test]
fn scenes_far_from_the_origin() {
    let step = VOXEL / 256;
    let near = Lattice { voxel: 0.25, ..Lattice::cube(33) };
    let far = Lattice { origin: [10_000.0, -10_000.0, 10_000.0], ..near.clone() };
    let region = Region::scene(&far);
    let mut rng = Rng::with_seed(9);
    let mut some = |number, voxels: i64| region.triangles(&mut rng, number, voxels * VOXEL, step);
    let triangles = [some(2000, 2), some(200, 8), hardened(some(600, 4), step), some(20, 30)].concat();
    check("far away", &far, &triangles, 500);
    let triangles = far.fixed(&triangles);
    let moved = Part { translation: far.origin.map(|x| x as f32), ..near.part(&triangles) };
    let scene = far.loaded(&Model { parts: vec![moved], ..Model::default() });
    Case { name: "moved away", scene: &scene, grid: &far.grid, triangles: &triangles, control: 500 }.check();
}
