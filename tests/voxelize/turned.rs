//! Grids that are turned: still not a voxel more and none less.

use crate::atlas::{beyond, through_atlas, unwrapped};
use crate::corners;
use crate::lattice::Lattice;
use crate::meshes::{Shape, Solid};
use crate::model::{Model, Part};
use crate::oracle::{self, HALF, Point, Rule, Ties, Triangle, VOXEL, number};
use crate::random::{Region, hardened};
use crate::solid::winding;
use crate::sums::Sums;
use crate::turns::{Turn, Turned};
use crate::voxelizer::{Case, Grid, METHODS, run};
use fastrand::Rng;
use glam::{DQuat, DVec3};
use std::path::Path;
use voxgi::scene::{self, Scene};
use voxgi::session::Request;

/// How far single floats may be off a place, in units: eight roundings of what they compute with, which is as large as
/// the grid and where it lies.
fn sure(turned: &Turned, bounds: [DVec3; 2]) -> f64 {
    let far = bounds.map(|corner| turned.place(corner).abs().max_element()).into_iter().fold(1.0, f64::max);
    let out = bounds.map(|corner| (turned.place(corner) - turned.place(DVec3::ZERO)).length());
    8.0 * 2_f64.powi(-24) * VOXEL as f64 * (far + out[0].max(out[1]))
}

/// Corners in metres of loose triangles within bounds, which the first two fix: some anywhere, some on a lattice along the
/// axes of the grid, half of those hard.
fn crowd(rng: &mut Rng, turned: &Turned, [low, high]: [DVec3; 2]) -> Vec<[DVec3; 3]> {
    let extent = high - low;
    let step = |from: DVec3, to: DVec3, axis: usize| from + (to - from) / 16.0 * DVec3::AXES[axis];
    let fixing = [(low, high), (high, low)].map(|(a, b)| [a, step(a, b, 0), step(a, b, 1)]);
    let mut point = |scale: f64, around: DVec3| {
        let any = DVec3::new(rng.f64(), rng.f64(), rng.f64());
        (around + scale * (any - 0.5) * extent).clamp(low, high)
    };
    let mut loose: Vec<[DVec3; 3]> = Vec::new();
    for (number, scale) in [(900, 0.06), (150, 0.3), (20, 1.0)] {
        loose.extend((0..number).map(|_| {
            let around = point(1.0, (low + high) / 2.0);
            [(); 3].map(|()| point(scale, around))
        }));
    }
    let region = Region { low: [0; 3], high: turned.grid.size.map(|n| n * VOXEL) };
    let mut some = |number, voxels: i64, step: i64| {
        let triangles = region.triangles(rng, number, voxels * VOXEL, step);
        [hardened(triangles.clone(), step), triangles].concat()
    };
    let along = [some(400, 2, HALF / 4), some(60, 8, HALF)].concat();
    // Odd units, so that what is rounded on the way there is not snapped to another.
    let world = |unit: Point| turned.world(DVec3::from_array(unit.map(|x| (x + 1) as f64 / VOXEL as f64)));
    let inside = |t: &[DVec3; 3]| t.iter().all(|p| p.cmpge(low).all() && p.cmple(high).all());
    loose.extend(along.into_iter().map(|t| t.map(world)).filter(inside));
    [&fixing[..], &loose].concat()
}

fn scene_of(triangles: &[[DVec3; 3]]) -> Scene {
    let corners = triangles.iter().flatten().map(|corner| corner.as_vec3().to_array()).collect();
    Model { parts: vec![Part::new(corners)], ..Model::default() }.load()
}

/// Turns of all sorts; the last grid covers a part of the scene, and beyond it along x.
fn turns() -> Vec<Turn> {
    let mut rng = Rng::with_seed(21);
    let mut random = |resolution| Turn::random(&mut rng, resolution);
    vec![
        random(24),
        random(33),
        Turn::new(32, 45.0, 0.0, 0.0),
        Turn::new(20, 0.0, -90.0, 10.0),
        Turn { cover: [1.25, 0.5, 0.4], ..random(24) },
    ]
}

/// Random triangles in a scene that is no cube and not around the origin.
#[test]
fn voxels_are_exact_in_any_turn() {
    let mut rng = Rng::with_seed(22);
    for turn in turns() {
        let bounds = [DVec3::new(-1.5, 2.0, -9.0), DVec3::new(2.0, 4.0, -6.5)];
        let turned = turn.around(bounds[0], bounds[1]);
        let scene = unwrapped(scene_of(&crowd(&mut rng, &turned, bounds)));
        let sure = sure(&turned, bounds);
        assert!(sure < 1.0, "{sure}");
        let triangles = corners::snapped(&scene, &turned.grid, |world| turned.place(world), sure);
        let outside = |t: &&Triangle| oracle::voxels_around(t, turned.grid.size).next().is_none();
        let out = triangles.iter().filter(outside).count();
        assert_eq!(out > 100, turn.cover[1] < 1.0, "{turn:?}: {out} of {} lie outside", triangles.len());
        let name = format!("{turn:?}");
        Case { name: &name, scene: &scene, grid: &turned.grid, triangles: &triangles, control: 300 }.check();
        let touched = oracle::count(&triangles, turned.grid.size, Rule::Conservative, Ties::Count);
        let found = through_atlas(&scene, &turned.grid, 3.0);
        assert_eq!(beyond(&found, &touched), 0, "{turn:?}");
        assert!(oracle::filled(&found) * 2 > oracle::filled(&touched), "{turn:?}");
    }
}

/// By quarters about each axis no position is rounded: the voxels of triangles whose coordinates are swapped and mirrored
/// as the turn says.
#[test]
fn quarter_turns_permute() {
    let lattice = Lattice::oblong(24, [1.0, 0.5, 0.75]);
    let mut rng = Rng::with_seed(23);
    let region = Region::scene(&lattice);
    let mut some =
        |number, voxels: i64, step| hardened(region.triangles(&mut rng, number, voxels * VOXEL, step), step);
    let triangles = lattice.fixed(&[some(600, 2, 512), some(200, 6, 1), some(40, 10, 2048)].concat());
    let scene = lattice.scene(&triangles);
    // Which of the world's axes each of the grid's lies along, and whether against it.
    for (angles, axes) in [
        ([90.0, 0.0, 0.0], [(2, true), (1, false), (0, false)]),
        ([0.0, 90.0, 0.0], [(0, false), (2, false), (1, true)]),
        ([0.0, 0.0, 90.0], [(1, false), (0, true), (2, false)]),
        ([-90.0, 0.0, 180.0], [(2, true), (1, true), (0, true)]),
    ] {
        let [yaw, pitch, roll] = angles;
        let turn = Turn::new(24, yaw, pitch, roll);
        let place = |p: Point| -> Point {
            axes.map(|(axis, against)| {
                let (first, last) = (lattice.low[axis], lattice.high[axis]);
                lattice.low[0] + if against { last - p[axis] } else { p[axis] - first }
            })
        };
        let size = axes.map(|(axis, _)| lattice.grid.size[axis]);
        let grid = Grid { part: "grid/turned", knobs: turn.knobs(), size };
        let permuted: Vec<Triangle> = triangles.iter().map(|t| t.map(place)).collect();
        let name = format!("{angles:?}");
        Case { name: &name, scene: &scene, grid: &grid, triangles: &permuted, control: 300 }.check();
    }
}

/// Not turned, every word of the sums is that of `grid/box`.
#[test]
fn not_turned_it_is_a_box() {
    let mut rng = Rng::with_seed(24);
    let bounds = [DVec3::new(-1.3, 2.1, -9.7), DVec3::new(2.2, 4.5, -6.9)];
    for resolution in [2, 31, 64] {
        let turn = Turn::new(resolution, 0.0, 0.0, 0.0);
        let turned = turn.around(bounds[0], bounds[1]);
        let scene = scene_of(&crowd(&mut rng, &turned, bounds));
        let knobs = vec![("resolution", resolution.to_string())];
        let aligned = Grid { part: "grid/box", knobs, size: turned.grid.size };
        let [expected, found] =
            [&aligned, &turned.grid].map(|grid| Sums::of(&scene, grid, METHODS[0], Rule::Thin));
        assert_eq!(expected.differences(&found), 0, "{resolution}");
        if resolution > 2 {
            let tilted = Grid { knobs: Turn { roll: 0.01, ..turn }.knobs(), ..turned.grid };
            let tilted = Sums::of(&scene, &tilted, METHODS[0], Rule::Thin);
            assert!(expected.differences(&tilted) > 100, "the control");
        }
    }
}

/// Normals are those of the world, and the surface lies where it is.
#[test]
fn surfaces_stay_where_they_are() {
    let turn = Turn::new(48, 25.0, -40.0, 70.0);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-point.glb");
    let scene = scene::load(&path).expect("the scene");
    let [low, high] = [scene.bounds.min, scene.bounds.max].map(|corner| corner.as_dvec3());
    let turned = turn.around(low, high);
    let sums = Sums::of(&scene, &turned.grid, METHODS[0], Rule::Thin);
    let mut walls = 0;
    for voxel in sums.filled() {
        let means = sums.means(voxel);
        // Voxels that a single wall fills, or the sides of a block.
        if means.normal.length() < 0.999 {
            continue;
        }
        let world = turned.world(DVec3::from_array(voxel.map(|i| i as f64)) + means.within);
        let wall = [0, 1, 2].into_iter().find(|axis| means.normal[*axis].abs() > 0.999);
        if let Some(axis) = wall.filter(|axis| *axis != 1) {
            let off = (world[axis] - low[axis]).abs().min((world[axis] - high[axis]).abs());
            walls += usize::from(off < 0.001);
        }
    }
    assert!(walls > 1000, "{walls} voxels of walls along the world's axes");
}

/// The inside of closed meshes, by winding numbers of the corners as they are snapped.
#[test]
fn the_inside_is_where_meshes_go_around() {
    let solid = Solid {
        shape: Shape::Torus { ring: 8.0, tube: 4.5 },
        center: DVec3::splat(20.3),
        turned: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7),
    };
    let part = Lattice::cube(40).part(&solid.triangles());
    let scene = Model { parts: vec![part], ..Model::default() }.load();
    let bounds = [scene.bounds.min, scene.bounds.max].map(|corner| corner.as_dvec3());
    let turned = Turn::new(32, 33.0, 61.0, -15.0).around(bounds[0], bounds[1]);
    let (grid, size) = (&turned.grid, turned.grid.size);
    let mesh = corners::snapped(&scene, grid, |world| turned.place(world), sure(&turned, bounds));
    let parts = [("grid", grid.part), ("payload", "payload/bits"), ("voxelize", "voxelize/solid")];
    let request = Request {
        pipeline: "occupancy".to_owned(),
        size: [8, 8],
        sets: grid.knobs.iter().map(|(knob, value)| ((*knob).to_owned(), value.clone())).collect(),
        parts: parts.map(|(role, part)| (role.to_owned(), part.to_owned())).to_vec(),
        ..Request::default()
    };
    let image = run(&request, "occupancy", &scene).expect("solid voxels");
    let (mut inside, mut wrong, mut shifted) = (0, 0, 0);
    for i in (0..size.into_iter().product::<i64>()).step_by(7) {
        let voxel = [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])];
        let around = |offset: i64| winding(&mesh, voxel.map(|i| i * VOXEL + offset)).abs() > 0.5;
        let right = around(HALF);
        let filled = image.data[number(voxel, size)] > 0.0;
        inside += usize::from(right);
        wrong += usize::from(filled != right);
        shifted += usize::from(filled != around(0));
    }
    println!("{inside} inside, {wrong} wrong; with corners for centres {shifted}");
    assert!(inside > 100, "{inside}");
    assert_eq!(wrong, 0, "of {inside}");
    assert!(shifted > 20, "the control: {shifted}");
}
