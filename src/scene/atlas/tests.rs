//! The layout against its own promises: a place for every triangle, no two in the same place, lengths kept.

use super::mesh::{Mesh, meshes};
use super::unwrap::{UNWRAPPER, Unwrapped, one_by_one, unwrap};
use super::{Atlas, stretch};
use crate::scene::layout::{Instance, Triangle, Vertex};
use crate::scene::{Scene, generate, load};
use glam::{DMat4, DQuat, DVec2, DVec3, Vec2, Vec3};
use proptest::prelude::*;
use std::f64::consts::PI;

fn scene(triangles: &[[Vec3; 3]], transforms: &[DMat4]) -> Scene {
    let vertices = triangles.iter().flatten();
    let vertices = vertices.map(|p| Vertex { position: *p, u: 0.0, normal: Vec3::Z, v: 0.0 }).collect();
    let placed = |instance: usize| {
        let first = |i: usize| 3 * i as u32;
        (0..triangles.len()).map(move |i| Triangle {
            a: first(i),
            b: first(i) + 1,
            c: first(i) + 2,
            instance: instance as u32,
        })
    };
    Scene {
        vertices,
        triangles: (0..transforms.len()).flat_map(placed).collect(),
        instances: transforms.iter().map(|transform| Instance::placed(transform, 0)).collect(),
        ..Scene::default()
    }
}

fn generated(name: usize) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let (file, make) = generate::ALL[name];
    let path = folder.path().join(file);
    std::fs::write(&path, make()).unwrap();
    load(&path).unwrap()
}

/// A ball of triangles, twice `n`² of them; some at the poles have no area.
fn ball(n: u32) -> Vec<[Vec3; 3]> {
    let at = |i: u32, j: u32| {
        let (polar, around) = (PI * f64::from(j) / f64::from(n), 2.0 * PI * f64::from(i % n) / f64::from(n));
        DVec3::new(polar.sin() * around.cos(), polar.cos(), polar.sin() * around.sin()).as_vec3()
    };
    let quads = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

fn area_in_space(corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners;
    0.5 * (b - a).cross(c - a).length()
}

fn area(corners: &[DVec2; 3]) -> f64 {
    let [a, b, c] = corners;
    0.5 * (b - a).perp_dot(c - a)
}

/// All triangles of the scene in the square, as a kernel finds them in the buffer.
fn in_square(scene: &Scene, atlas: &Atlas) -> Vec<[DVec2; 3]> {
    let pairs = atlas.pairs();
    let corner = |triangle: usize, corner: u32| {
        let instance = scene.triangles[triangle].instance as usize;
        let float = |pair: usize| Vec2::from(pairs[pair].map(f32::from_bits));
        let [scale, first] = pairs[2 * instance + 1];
        let pair = first.wrapping_add(3 * triangle as u32 + corner);
        (float(2 * instance) + f32::from_bits(scale) * float(pair as usize)).as_dvec2()
    };
    (0..scene.triangles.len()).map(|t| [0, 1, 2].map(|c| corner(t, c))).collect()
}

/// Samples of a square grid that lie in more than one triangle, and those that lie in any.
fn overlaps(triangles: &[[DVec2; 3]], samples: usize) -> (usize, usize) {
    let mut counts = vec![0_u8; samples * samples];
    let n = samples as f64;
    for triangle in triangles {
        // Off the lattice of binary fractions, on which the edges of simple shapes lie.
        let place = |i: usize| (i as f64 + 0.437_128) / n;
        let low = triangle.iter().copied().reduce(DVec2::min).unwrap() * n;
        let high = triangle.iter().copied().reduce(DVec2::max).unwrap() * n;
        for y in low.y as usize..samples.min(high.y as usize + 1) {
            for x in low.x as usize..samples.min(high.x as usize + 1) {
                let p = DVec2::new(place(x), place(y));
                let side = |i: usize| (triangle[(i + 1) % 3] - triangle[i]).perp_dot(p - triangle[i]);
                if (0..3).all(|i| side(i) > 1e-12) {
                    counts[y * samples + x] += 1;
                }
            }
        }
    }
    (counts.iter().filter(|count| **count > 1).count(), counts.iter().filter(|count| **count > 0).count())
}

/// Sees that a layout is one, and says how many triangles have no place. Rounded to floats, corners may be off by some
/// millionths, and a sample may lie in two triangles there.
fn check(scene: &Scene, atlas: &Atlas) -> usize {
    let placed = in_square(scene, atlas);
    assert!(placed.iter().flatten().all(|p| p.min_element() >= 0.0 && p.max_element() <= 1.0 + 1e-6));
    let (twice, covered) = overlaps(&placed, 2048);
    assert!(twice * 100_000 <= covered, "{twice} of {covered} samples lie in two triangles");
    let all: f64 = placed.iter().map(area).sum();
    assert!((covered as f64 / 2048.0_f64.powi(2) - all).abs() < 0.01, "{covered} {all}");
    let lost = placed.iter().filter(|t| area(t) <= 0.0).count();
    assert_eq!(lost, atlas.lost);
    lost
}

/// Area in the square over that in the world, in m², of each triangle that has a place.
fn ratios(scene: &Scene, atlas: &Atlas) -> Vec<f64> {
    let world = |t: &Triangle| {
        let [x, y, z, w] = scene.instances[t.instance as usize].to_world.map(|c| c.truncate().as_dvec3());
        area_in_space([t.a, t.b, t.c].map(|corner| {
            let p = scene.vertices[corner as usize].position.as_dvec3();
            x * p.x + y * p.y + z * p.z + w
        }))
    };
    let square = in_square(scene, atlas);
    let ratio = |(t, placed): (&Triangle, &[DVec2; 3])| area(placed) * atlas.extent.powi(2) / world(t);
    let all = scene.triangles.iter().zip(&square).filter(|(_, placed)| area(placed) > 0.0);
    let mut ratios: Vec<f64> = all.map(ratio).collect();
    ratios.sort_by(f64::total_cmp);
    ratios
}

#[test]
fn flat_surfaces_keep_their_shape() {
    let scene = generated(0);
    let atlas = Atlas::of(&scene, None);
    assert_eq!(check(&scene, &atlas), 0);
    let ratios = ratios(&scene, &atlas);
    assert_eq!(ratios.len(), scene.triangles.len());
    assert!((ratios[0] - 1.0).abs() < 1e-4 && (ratios[ratios.len() - 1] - 1.0).abs() < 1e-4, "{ratios:?}");
    let used = scene.triangles.len();
    let world: f64 = meshes(&scene).0.iter().map(|mesh| mesh.area() * mesh.unit.powi(2)).sum();
    assert!(world / atlas.extent.powi(2) > 0.4, "{used} triangles fill {}", world / atlas.extent.powi(2));
}

#[test]
fn curved_surfaces_are_hardly_distorted() {
    let scene = scene(&ball(48), &[DMat4::from_scale(DVec3::splat(2.0))]);
    let atlas = Atlas::of(&scene, None);
    assert_eq!(check(&scene, &atlas), 96, "at the poles");
    let ratios = ratios(&scene, &atlas);
    assert!(ratios[0] > 0.5 && ratios[ratios.len() - 1] < 2.0, "{} {}", ratios[0], ratios[ratios.len() - 1]);
    assert!((ratios[ratios.len() / 2] - 1.0).abs() < 0.02, "{}", ratios[ratios.len() / 2]);
}

#[test]
fn triangles_one_by_one_are_a_layout_too() {
    let triangles = ball(24);
    let mesh = Mesh::new(triangles.iter().copied());
    let unwrapped = one_by_one(&mesh);
    assert_eq!((unwrapped.corners.len(), unwrapped.lost()), (triangles.len(), 48));
    let size = f64::from(unwrapped.size.max_element());
    let placed: Vec<_> =
        unwrapped.corners.iter().map(|corners| corners.map(|p| p.as_dvec2() / size)).collect();
    assert_eq!(overlaps(&placed, 2048).0, 0);
    for (corners, triangle) in placed.iter().zip(&mesh.triangles).filter(|(corners, _)| area(corners) > 0.0) {
        let space = mesh.corners(*triangle);
        for i in 0..3 {
            let lengths =
                [space[i].distance(space[(i + 1) % 3]), corners[i].distance(corners[(i + 1) % 3]) * size];
            assert!((lengths[0] - lengths[1]).abs() < 1e-6, "{lengths:?}");
        }
    }
}

/// A control for the counting of overlaps.
#[test]
fn overlaps_are_seen() {
    let triangle = [DVec2::ZERO, DVec2::new(0.5, 0.0), DVec2::new(0.0, 0.5)];
    let (twice, covered) = overlaps(&[triangle, triangle.map(|p| p + 0.01)], 512);
    assert!(twice > 10_000 && covered > twice);
}

#[test]
fn instances_share_a_mesh_and_have_places_of_their_own() {
    let turned = DMat4::from_rotation_translation(DQuat::from_rotation_y(0.7), DVec3::new(1e3, 2.0, 3.0));
    let mirrored = DMat4::from_scale(DVec3::new(-3.0, 3.0, 3.0));
    let scene = scene(&ball(12), &[DMat4::IDENTITY, turned, mirrored]);
    let atlas = Atlas::of(&scene, None);
    assert_eq!((atlas.unwrapped, atlas.meshes.len()), (1, 1));
    check(&scene, &atlas);
    let placed = in_square(&scene, &atlas);
    let area_of = |instance: usize| placed.chunks_exact(2 * 12 * 12).nth(instance).unwrap().iter().map(area);
    let areas = [0, 1, 2].map(|instance| area_of(instance).sum::<f64>());
    assert!(
        (areas[1] / areas[0] - 1.0).abs() < 1e-4 && (areas[2] / areas[0] - 9.0).abs() < 1e-3,
        "{areas:?}"
    );
}

#[test]
fn stretch_is_the_largest_singular_value() {
    let turn = |angle: f64| DMat4::from_quat(DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle));
    for scale in
        [DVec3::ONE, DVec3::new(1.0, 1.0, 0.9), DVec3::new(2.0, -1e-9, 3.0), DVec3::new(1e-12, 0.0, 0.0)]
    {
        let found = stretch(&Instance::placed(&(turn(0.3) * DMat4::from_scale(scale) * turn(1.1)), 0));
        let expected = scale.abs().max_element();
        assert!((found / expected - 1.0).abs() < 1e-6, "{scale}: {found}");
    }
    assert_eq!(stretch(&Instance::placed(&DMat4::from_scale(DVec3::ZERO), 0)), 0.0);
}

#[test]
fn what_was_unwrapped_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let cache = folder.path().join("atlases");
    let scene = scene(&ball(12), &[DMat4::IDENTITY]);
    let files = || -> Vec<_> { std::fs::read_dir(&cache).unwrap().map(|e| e.unwrap().path()).collect() };
    let first = Atlas::of(&scene, Some(&cache));
    assert_eq!((first.unwrapped, files().len()), (1, 1));
    let again = || {
        let atlas = Atlas::of(&scene, Some(&cache));
        assert_eq!(atlas.pairs(), first.pairs());
        atlas.unwrapped
    };
    assert_eq!(again(), 0, "it is kept");
    let file = &files()[0];
    let whole = std::fs::read(file).unwrap();
    let damaged = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        bytes
    };
    for bytes in [
        Vec::new(),
        whole[..40].to_vec(),
        damaged(3),
        damaged(whole.len() - 1),
        [&whole[..], &[0; 24]].concat(),
    ] {
        std::fs::write(file, bytes).unwrap();
        assert_eq!(again(), 1, "it is damaged");
        assert_eq!(std::fs::read(file).unwrap(), whole, "it is made again");
    }
    // One vertex elsewhere is another mesh.
    let mut other = scene.clone();
    other.vertices[100].position.x += 0.01;
    assert_eq!(Atlas::of(&other, Some(&cache)).unwrapped, 1);
    // A folder that can't be made costs time only.
    assert_eq!(Atlas::of(&scene, Some(&file.join("no folder"))).pairs(), first.pairs());
}

#[test]
fn motion_without_deformation_changes_nothing() {
    let cache = tempfile::tempdir().unwrap();
    let mut scene = scene(&ball(12), &[DMat4::IDENTITY, DMat4::from_scale(DVec3::splat(0.5))]);
    let before = Atlas::of(&scene, Some(cache.path()));
    let moved = DMat4::from_rotation_translation(DQuat::from_rotation_x(1.0), DVec3::new(1.0, 2.0, 3.0));
    scene.instances[0] = Instance::placed(&moved, 0);
    let after = Atlas::of(&scene, Some(cache.path()));
    assert_eq!((before.unwrapped, after.unwrapped), (1, 0));
    assert!((before.extent / after.extent - 1.0).abs() < 1e-6);
    for (a, b) in in_square(&scene, &before).iter().flatten().zip(in_square(&scene, &after).iter().flatten())
    {
        assert!(a.distance(*b) < 1e-6, "{a} {b}");
    }
    // Kept with the scene: moving it later does not even look.
    scene.atlas.set(std::sync::Arc::new(after)).unwrap();
    let kept = scene.atlas() as *const Atlas;
    scene.pose(1.0);
    assert_eq!(scene.atlas() as *const Atlas, kept);
}

#[test]
fn the_version_that_made_it_is_the_version_there_is() {
    let (name, version) = UNWRAPPER.split_once(' ').unwrap();
    let locked = format!("name = \"{name}\"\nversion = \"{version}\"\n");
    assert!(include_str!("../../../Cargo.lock").contains(&locked));
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        (-4_i8..4).prop_map(f32::from),
        -1.0_f32..1.0,
        Just(0.0),
        Just(-0.0),
        Just(1e-30),
        Just(1e-45),
        Just(1e18),
        (-1.0_f32..1.0).prop_map(|x| x * 1e-7),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Soups of triangles that share corners by chance: without area, slivers, far apart, doubled.
    #[test]
    fn anything_is_laid_out(
        points in prop::collection::vec([coordinate(), coordinate(), coordinate()], 1..20),
        triangles in prop::collection::vec([0_usize..1000, 0..1000, 0..1000], 0..40),
    ) {
        let corner = |i: usize| Vec3::from(points[i % points.len()]);
        let mesh = Mesh::new(triangles.iter().map(|t| t.map(corner)));
        for unwrapped in [unwrap(&mesh, |_| ()), one_by_one(&mesh)] {
            let Unwrapped { corners, size } = &unwrapped;
            prop_assert_eq!(corners.len(), triangles.len());
            let within = |p: &Vec2| p.is_finite() && p.cmpge(Vec2::ZERO).all() && p.cmple(*size).all();
            prop_assert!(corners.iter().flatten().all(within));
            for (corners, triangle) in corners.iter().zip(&mesh.triangles) {
                let placed = area(&corners.map(|p| p.as_dvec2()));
                let space = area_in_space(mesh.corners(*triangle));
                prop_assert!(placed > 0.0 || space < 1e-5, "lost: {}", space);
                prop_assert!(placed < 2.1 * space + 1e-5, "{} of {}", placed, space);
            }
        }
    }
}
