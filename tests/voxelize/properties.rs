//! What is true without an oracle: thin voxels are conservative ones too, closed meshes have no holes, neither the order
//! of triangles nor what of it moves shows.

use crate::lattice::Lattice;
use crate::meshes::{Shape, Solid, solids};
use crate::model::{Model, Part};
use crate::oracle::{Point, Rule, Triangle, VOXEL, differences, number};
use crate::random::{Region, hardened};
use crate::sums::Sums;
use crate::voxelizer::{COUNT, Grid, METHODS, Method, Way, counted};
use fastrand::Rng;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use voxgi::scene::Scene;

const SIDE: i64 = 64;

/// Voxels that paths over faces reach from a corner of the grid, without filled ones.
fn reached(counts: &[u32]) -> Vec<bool> {
    let size = [SIDE; 3];
    let mut reached = vec![false; counts.len()];
    let mut open: Vec<Point> = vec![[0; 3]];
    assert_eq!(counts[0], 0, "the corner is empty");
    reached[0] = true;
    while let Some(voxel) = open.pop() {
        for (axis, step) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
            let mut next = voxel;
            next[axis] += step;
            if !(0..SIDE).contains(&next[axis]) {
                continue;
            }
            let at = number(next, size);
            if counts[at] == 0 && !reached[at] {
                reached[at] = true;
                open.push(next);
            }
        }
    }
    reached
}

/// How many voxels there are deep in the solids, and how many of them are reached from outside.
fn leaks(solids: &[Solid], counts: &[u32]) -> (usize, usize) {
    let reached = reached(counts);
    let all = (0..SIDE).flat_map(|z| (0..SIDE).flat_map(move |y| (0..SIDE).map(move |x| [x, y, z])));
    let deep = all.filter(|voxel| solids.iter().any(|solid| solid.holds(*voxel)));
    deep.fold((0, 0), |(all, out), voxel| (all + 1, out + usize::from(reached[number(voxel, [SIDE; 3])])))
}

fn voxelized(scene: &Scene, method: Method) -> [Vec<u32>; 2] {
    Rule::BOTH.map(|rule| counted(scene, &Grid::cube(SIDE), &Way { method, payload: "payload/sums", rule }))
}

/// Balls, tori and boxes: from outside no path over faces leads into them, thin as they are; and every triangle fills
/// conservatively what it fills thin.
#[test]
fn closed_meshes_have_no_holes() {
    let config = ProptestConfig {
        cases: 4,
        failure_persistence: None,
        max_shrink_iters: 16,
        ..ProptestConfig::default()
    };
    let lattice = Lattice::cube(SIDE);
    TestRunner::new(config)
        .run(&solids(), |solids| {
            let triangles: Vec<Triangle> = solids.iter().flat_map(Solid::triangles).collect();
            let scene = lattice.scene(&lattice.fixed(&triangles));
            for method in METHODS {
                let [thin, conservative] = voxelized(&scene, method);
                prop_assert!(thin.iter().zip(&conservative).all(|(thin, all)| thin <= all), "{method}");
                prop_assert!(thin.iter().sum::<u32>() < conservative.iter().sum::<u32>());
                for counts in [thin, conservative] {
                    let (deep, out) = leaks(&solids, &counts);
                    prop_assert!(deep > 50 && out == 0, "{method}: {out} of {deep} voxels are reached");
                }
            }
            Ok(())
        })
        .unwrap_or_else(|failure| panic!("{failure}"));
}

/// The control: without one triangle of a box what is inside is reached.
#[test]
fn a_hole_shows() {
    let lattice = Lattice::cube(SIDE);
    let solid = Solid {
        shape: Shape::Cuboid { half: DVec3::new(9.0, 7.0, 8.0) },
        center: DVec3::splat(32.0),
        turned: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7),
    };
    let triangles = solid.triangles();
    let whole = lattice.scene(&lattice.fixed(&triangles));
    let open = lattice.scene(&lattice.fixed(&triangles[1..]));
    for method in METHODS {
        let [thin, _] = voxelized(&whole, method);
        assert_eq!(leaks(&[solid], &thin).1, 0);
        for counts in voxelized(&open, method) {
            let (deep, out) = leaks(&[solid], &counts);
            assert!(out > 50, "{method}: {out} of {deep}");
        }
    }
}

/// Parts of several colours, some of it hard; the first fixes the grid.
fn crowd(lattice: &Lattice, seed: u64) -> Vec<Part> {
    // Off the scene's bounds: what moves may not change them.
    let [low, high] = [lattice.low.map(|x| x + VOXEL), lattice.high.map(|x| x - VOXEL)];
    let region = Region { low, high };
    let mut rng = Rng::with_seed(seed);
    let mut part = |color: [f32; 3]| {
        let mut some = |number, voxels: i64, step| region.triangles(&mut rng, number, voxels * VOXEL, step);
        let triangles = [some(400, 2, 1), some(60, 12, 2), hardened(some(200, 4, 512), 512)].concat();
        Part { color, ..lattice.part(&triangles) }
    };
    let mut parts = vec![lattice.part(&lattice.fixed(&[]))];
    parts.extend([[0.9, 0.2, 0.1], [0.1, 0.7, 0.3], [0.3, 0.3, 0.8]].map(&mut part));
    parts
}

/// No bit of any sum depends on the order of triangles, nor on who voxelizes.
#[test]
fn order_changes_no_bit() {
    let lattice = Lattice::cube(24);
    let parts = crowd(&lattice, 11);
    let mut rng = Rng::with_seed(12);
    let mut shuffled = parts.clone();
    rng.shuffle(&mut shuffled);
    for part in &mut shuffled {
        let mut triangles: Vec<_> = part.corners.chunks_exact(3).map(<[_]>::to_vec).collect();
        rng.shuffle(&mut triangles);
        part.corners = triangles.concat();
    }
    assert_ne!(
        parts.iter().map(|p| &p.corners).collect::<Vec<_>>(),
        shuffled.iter().map(|p| &p.corners).collect::<Vec<_>>()
    );
    // The control: one triangle has another colour.
    let mut other = parts.clone();
    let moved = other[1].corners.split_off(3 * 399);
    other[2].corners.splice(0..0, moved);
    let scenes = [parts, shuffled, other].map(|parts| lattice.loaded(&Model { parts, ..Model::default() }));
    for rule in Rule::BOTH {
        let expected = Sums::of(&scenes[0], &lattice.grid, METHODS[0], rule);
        for method in METHODS {
            let [same, shuffled, other] =
                [0, 1, 2].map(|i| Sums::of(&scenes[i], &lattice.grid, method, rule));
            assert_eq!(expected.differences(&same), 0, "{method}, {rule:?}: other sums than {}", METHODS[0]);
            assert_eq!(expected.differences(&shuffled), 0, "{method}, {rule:?}: the order shows");
            assert!(expected.differences(&other) > 0, "the control");
        }
    }
}

/// Still and moving triangles have sums of their own; where nothing has moved yet, together they are what they would be
/// if all were still.
#[test]
fn what_moves_adds_to_what_is_still() {
    let lattice = Lattice::cube(24);
    let parts = crowd(&lattice, 13);
    let still = Model { parts, ..Model::default() };
    let keys = "(time: 0), (time: 1, offset: (0.001, 0, 0)), (time: 2)";
    let motion = |node: &str| format!("(node: \"{node}\", keys: [{keys}])");
    let still_scene = lattice.loaded(&still);
    // The control: a part that is left out shows.
    let mut fewer = still.clone();
    fewer.parts.remove(2);
    let of = |scene| Sums::of(scene, &lattice.grid, METHODS[0], Rule::Thin);
    assert!(of(&still_scene).differences(&of(&lattice.loaded(&fewer))) > 100);
    for moving in [vec!["part2"], vec!["part1", "part3"]] {
        let motion = moving.iter().map(|node| motion(node)).collect::<Vec<_>>().join(", ");
        let scene = lattice.loaded(&Model { motion: Some(motion), ..still.clone() });
        assert_eq!(scene.triangles.len() - scene.still_triangles, 660 * moving.len());
        for rule in Rule::BOTH {
            for method in METHODS {
                let [all, apart] = [&still_scene, &scene].map(|s| Sums::of(s, &lattice.grid, method, rule));
                assert_eq!(all.differences(&apart), 0, "{method}, {rule:?}, {moving:?}");
                let bits =
                    |scene| counted(scene, &lattice.grid, &Way { method, payload: "payload/bits", rule });
                assert_eq!(bits(&still_scene), bits(&scene), "{method}, {rule:?}, {moving:?}");
            }
        }
    }
}

/// More large triangles, each of several chunks, than a queue of 65536 chunks takes: none is lost, none is done twice.
#[test]
fn a_full_queue_loses_nothing() {
    let lattice = Lattice::cube(100);
    let mut rng = Rng::with_seed(16);
    let (low, high) = (lattice.low[0], lattice.high[0]);
    let mut near = |[x, y, z]: Point| [x, y, z].map(|x| (x + rng.i64(-VOXEL..=VOXEL)).clamp(low, high));
    // Thin, from one corner of the grid's square to the other: eleven chunks where they lie flat.
    let triangles: Vec<Triangle> = (0..16_000)
        .map(|i| {
            let height = low + (high - low) * (i % 97) / 97;
            let end = near([high, high, height]);
            [near([low, low, height]), end, near(end)]
        })
        .collect();
    let scene = lattice.scene(&lattice.fixed(&triangles));
    let counts = METHODS.map(|method| {
        let way = Way { method, payload: COUNT, rule: Rule::Thin };
        counted(&scene, &lattice.grid, &way)
    });
    assert!(counts[0].iter().max() > Some(&3), "triangles meet in voxels");
    let found: Vec<_> =
        METHODS.iter().zip(&counts).map(|(m, c)| (m.to_string(), differences(c, &counts[0]))).collect();
    assert!(found.iter().all(|(_, differing)| *differing == 0), "{found:?}");
}
