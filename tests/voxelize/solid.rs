//! Solid voxels against winding numbers.

use crate::lattice::Lattice;
use crate::meshes::{Shape, Solid};
use crate::oracle::{HALF, Point, Triangle, VOXEL, number, snapped};
use crate::voxelizer::run;
use fastrand::Rng;
use glam::{DQuat, DVec3, EulerRot};
use std::f64::consts::TAU;
use voxgi::session::Request;

const SIDE: i64 = 64;

/// How often a closed mesh goes around a point: the solid angle of all its triangles from there, over 4π (Van Oosterom
/// and Strackee 1983, "The Solid Angle of a Plane Triangle").
pub fn winding(triangles: &[Triangle], point: Point) -> f64 {
    let angle = |triangle: &Triangle| {
        let [a, b, c] = triangle.map(|corner| {
            DVec3::from_array([0, 1, 2].map(|axis| (corner[axis] - point[axis]) as f64 / VOXEL as f64))
        });
        let [la, lb, lc] = [a, b, c].map(DVec3::length);
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    triangles.iter().map(angle).sum::<f64>() / (2.0 * TAU)
}

/// Balls, tori and boxes, turned anyhow, one in each corner of the grid.
fn solids() -> Vec<Solid> {
    let mut rng = Rng::with_seed(7);
    (0..8_usize)
        .map(|i| {
            let shape = match i % 3 {
                0 => Shape::Ball { radius: 9.0 + rng.f64() },
                1 => Shape::Torus { ring: 7.0, tube: 3.0 + rng.f64() },
                _ => Shape::Cuboid { half: DVec3::new(3.5 + rng.f64(), 5.0, 7.0 * rng.f64()) },
            };
            let mut at = |axis: usize| [16.0, 47.0][i >> axis & 1] + rng.f64();
            let center = DVec3::new(at(0), at(1), at(2));
            let turned =
                DQuat::from_euler(EulerRot::XYZ, TAU * i as f64 / 7.3, 0.4 + i as f64, 1.1 * i as f64);
            Solid { shape, center, turned }
        })
        .collect()
}

#[test]
fn the_inside_is_where_meshes_go_around() {
    let solids = solids();
    let meshes: Vec<Vec<Triangle>> = solids.iter().map(Solid::triangles).collect();
    let lattice = Lattice::cube(SIDE);
    let scene = lattice.scene(&lattice.fixed(&meshes.concat()));
    let part = |role: &str, name: &str| (role.to_owned(), name.to_owned());
    let request = Request {
        pipeline: "occupancy".to_owned(),
        size: [8, 8],
        sets: vec![("resolution".to_owned(), SIDE.to_string())],
        parts: vec![part("payload", "payload/bits"), part("voxelize", "voxelize/solid")],
        ..Request::default()
    };
    let image = run(&request, "occupancy", &scene)
        .unwrap_or_else(|problems| panic!("{:?}", problems.iter().collect::<Vec<_>>()));
    let filled = |voxel: Point| image.data[number(voxel, [SIDE; 3])] > 0.0;
    let (mut inside, mut wrong, mut shifted) = (0, 0, 0);
    for (solid, mesh) in solids.iter().zip(&meshes) {
        let mesh = snapped(mesh);
        let low = (solid.center - 14.0).to_array().map(|x| x.floor() as i64);
        // Every third voxel along x; rows are along x too, so that each is looked at.
        for i in 0..9 * 28 * 28 {
            let (x, y, z) = (i % 9, i / 9 % 28, i / (9 * 28));
            let voxel = [low[0] + 3 * x + z % 3, low[1] + y, low[2] + z];
            let around = |offset: i64| winding(&mesh, voxel.map(|i| i * VOXEL + offset)).abs() > 0.5;
            let right = around(HALF);
            inside += usize::from(right);
            wrong += usize::from(filled(voxel) != right);
            shifted += usize::from(filled(voxel) != around(0));
        }
    }
    println!("{inside} inside, {wrong} wrong; with corners for centres {shifted}");
    assert!(inside > 2000, "{inside}");
    assert_eq!(wrong, 0);
    assert!(shifted > 500, "the control: {shifted}");
}
