//! The hierarchy that rays go through, read as its documentation says: every triangle once, inside the boxes above
//! it, never
//! deeper than a kernel's stack; and a walk through it finds what a look at every triangle finds.

use super::stage::{Stage, matt};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use voxgi::scene::Scene;
use voxgi::scene::bvh::{MOST_DEPTH, RECORD, words};

type Corners = [Vec3; 3];

/// Records of a triangle; the root comes after the grid.
const OF_TRIANGLE: usize = 4;
const ROOT: usize = 2;

fn scene(triangles: &[Corners]) -> Scene {
    Stage::new().surface(triangles, matt(Vec3::ONE)).seen_from(DVec3::Z, -DVec3::Z)
}

struct Tree<'a>(&'a [u32]);

/// Where a child is.
enum Child {
    Node(usize),
    /// Records of triangles.
    Leaf(Vec<usize>),
}

impl Tree<'_> {
    fn float(&self, word: usize) -> f32 {
        f32::from_bits(self.0[word])
    }

    fn byte(&self, node: usize, word: usize, slot: usize) -> u32 {
        self.0[node * RECORD + word + slot / 4] >> (8 * (slot % 4)) & 255
    }

    /// Children of a node, each with the least and the greatest corner of its box.
    fn children(&self, node: usize) -> Vec<(Child, [DVec3; 2])> {
        let [begin, step] =
            [0, 4].map(|word| DVec3::from_array([0, 1, 2].map(|axis| self.float(word + axis).into())));
        let words = &self.0[node * RECORD..];
        let corner = [words[0] & 0xffff, words[0] >> 16, words[1] & 0xffff];
        let mut children = Vec::new();
        let (mut next, mut offset) = (words[2] as usize, 0);
        for slot in 0..8 {
            let side = |word: usize| {
                let cell = |axis: usize| {
                    let unit = 1 << (words[1] >> (16 + 4 * axis) & 15);
                    f64::from(corner[axis] + self.byte(node, word + 4 * axis, slot) * unit)
                };
                begin + step * DVec3::from_array([0, 1, 2].map(cell))
            };
            let kind = self.byte(node, 4, slot);
            assert_eq!(kind == 128, words[18] >> slot & 1 == 1, "nodes are told twice");
            let child = match kind {
                0 => continue,
                128 => {
                    next += 5;
                    Child::Node(next - 5)
                }
                leaf => {
                    assert_eq!(leaf & 31, offset, "leaves follow each other");
                    let first = words[3] as usize + OF_TRIANGLE * offset as usize;
                    offset += leaf >> 5;
                    Child::Leaf((0..leaf >> 5).map(|i| first + OF_TRIANGLE * i as usize).collect())
                }
            };
            children.push((child, [side(6), side(8)]));
        }
        children
    }

    fn corners(&self, record: usize) -> Corners {
        let at = record * RECORD;
        [0, 4, 8].map(|word| Vec3::from_array([0, 1, 2].map(|axis| self.float(at + word + axis))))
    }

    /// Index and corners of every triangle, as it is met below `node`. `around`: the boxes above.
    fn check(&self, node: usize, around: &mut Vec<[DVec3; 2]>, found: &mut Vec<(u32, Corners)>) {
        assert!(around.len() < MOST_DEPTH, "deeper than a kernel's stack");
        for (child, side) in self.children(node) {
            around.push(side);
            match child {
                Child::Node(child) => {
                    assert!(child > node, "a node comes before its children");
                    self.check(child, around, found);
                }
                Child::Leaf(records) => {
                    for record in records {
                        let corners = self.corners(record);
                        let exact = corners.map(|corner| corner.as_dvec3());
                        let inside = |[low, high]: &[DVec3; 2]| {
                            exact.iter().all(|c| c.cmpge(*low).all() && c.cmple(*high).all())
                        };
                        assert!(around.iter().all(inside), "a triangle sticks out of a box above it");
                        found.push((self.0[record * RECORD + 13], corners));
                    }
                }
            }
            around.pop();
        }
    }

    /// The distance to the nearest triangle, in lengths of `direction`, and how many were looked at.
    fn nearest(&self, node: usize, origin: DVec3, direction: DVec3, looked: &mut usize) -> Option<f64> {
        let enters = |[low, high]: [DVec3; 2]| {
            let [a, b] = [low, high].map(|corner| (corner - origin) / direction);
            // Rays in the plane of a flat box: rounding must not lose it.
            let (begin, end) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
            begin <= end * (1.0 + 1e-9) + 1e-12
        };
        let mut nearest: Option<f64> = None;
        for (child, _) in self.children(node).into_iter().filter(|(_, side)| enters(*side)) {
            let found = match child {
                Child::Node(child) => self.nearest(child, origin, direction, looked),
                Child::Leaf(records) => {
                    *looked += records.len();
                    first(records.into_iter().map(|record| self.corners(record)), origin, direction)
                }
            };
            nearest = [nearest, found].into_iter().flatten().reduce(f64::min);
        }
        nearest
    }
}

/// The nearest of these triangles, by volumes: a ray passes inside all edges if its volumes with them have one sign.
fn first(triangles: impl Iterator<Item = Corners>, origin: DVec3, direction: DVec3) -> Option<f64> {
    let hit = |corners: Corners| {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3() - origin);
        let volumes = [b.cross(c), c.cross(a), a.cross(b)].map(|edge| edge.dot(direction));
        let one_side = volumes.iter().all(|v| *v >= 0.0) || volumes.iter().all(|v| *v <= 0.0);
        let normal = (b - a).cross(c - a);
        let t = normal.dot(a) / normal.dot(direction);
        (one_side && t.is_finite() && t > 0.0).then_some(t)
    };
    triangles.filter_map(hit).reduce(f64::min)
}

/// All that must hold of the hierarchy over these triangles.
fn check(triangles: &[Corners]) {
    let scene = scene(triangles);
    let words = words(&scene);
    assert!(words.len() >= RECORD && words.len().is_multiple_of(RECORD));
    let mut found = Vec::new();
    Tree(&words).check(ROOT, &mut Vec::new(), &mut found);
    // What scenes that move leave room for.
    let nodes = (words.len() / RECORD - ROOT - OF_TRIANGLE * triangles.len()) / 5;
    assert!(nodes <= triangles.len() * 4 / 7 + 2, "{nodes} nodes");
    found.sort_by_key(|(index, _)| *index);
    assert!(found.iter().map(|(index, _)| *index).eq(0..triangles.len() as u32), "each triangle once");
    let center = scene.bounds.center();
    for ((_, found), corners) in found.iter().zip(triangles) {
        let placed = corners.map(|corner| (corner.as_dvec3() - center).as_vec3());
        assert_eq!(*found, placed, "metres from the middle of the bounds");
    }
}

fn coordinate() -> impl Strategy<Value = f32> {
    // Whole numbers make coplanar and degenerate triangles, and boxes without thickness.
    prop_oneof![2 => -10f32..10.0, 1 => (-3i8..4).prop_map(f32::from)]
}

fn corner() -> impl Strategy<Value = Vec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from)
}

/// Triangles of all sorts, some with corners that coincide, some several times.
fn soup() -> impl Strategy<Value = Vec<Corners>> {
    let triangle = prop_oneof![
        5 => [corner(), corner(), corner()],
        1 => corner().prop_map(|c| [c; 3]),
        1 => [corner(), corner()].prop_map(|[a, b]| [a, b, b]),
    ];
    let several = (triangle, prop_oneof![9 => Just(1usize), 1 => 2..20usize])
        .prop_map(|(triangle, times)| vec![triangle; times]);
    prop::collection::vec(several, 0..60).prop_map(|lists| lists.concat())
}

proptest! {
    #[test]
    fn soups_are_held_whole(triangles in soup()) {
        check(&triangles);
    }

    /// Each twice as far away and as large as the one before: trees over them lean to one side.
    #[test]
    fn chains_are_not_too_deep(count in 1usize..120, copies in 1usize..4, axis in corner()) {
        let link = |i: usize| {
            let scale = (i as f32 - 60.0).exp2();
            let corners = [axis, axis + Vec3::X, axis + Vec3::Y];
            [corners.map(|corner| corner * scale * 0.05)].repeat(copies)
        };
        check(&(0..count).flat_map(link).collect::<Vec<_>>());
    }

    #[test]
    fn a_walk_finds_the_nearest(triangles in soup(), eye in corner(), at in prop::collection::vec(corner(), 30)) {
        let scene = scene(&triangles);
        let words = words(&scene);
        let center = scene.bounds.center();
        let placed = triangles.iter().map(|t| t.map(|corner| (corner.as_dvec3() - center).as_vec3()));
        let origin = eye.as_dvec3() + DVec3::new(0.123, 0.0456, -0.0789);
        for target in at {
            let direction = target.as_dvec3() - origin;
            let nearest = Tree(&words).nearest(ROOT, origin, direction, &mut 0);
            prop_assert_eq!(nearest, first(placed.clone(), origin, direction));
        }
    }
}

/// As far out and as small as a scene may be.
#[test]
fn extremes_are_held() {
    let at = |scale: f32| {
        [Vec3::new(-scale, 0.0, scale), Vec3::new(scale, -scale, 0.0), Vec3::new(0.0, scale, -scale)]
    };
    check(&[at(voxgi::scene::FARTHEST)]);
    check(&[at(voxgi::scene::FARTHEST), at(1.0), at(1e-18), at(0.0)]);
    check(&(0..40).map(|i| at(10f32.powi(i - 20).min(voxgi::scene::FARTHEST))).collect::<Vec<_>>());
}

#[test]
fn few_triangles_and_many_alike() {
    let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
    for count in [0, 1, 2, 3, 4, 8, 9, 16, 24, 25, 1000] {
        check(&vec![triangle; count]);
    }
}

/// A hierarchy is of use: of a thousand triangles in a row a ray meets few. And a box that is too small is noticed.
#[test]
fn a_walk_leaves_out_most() {
    let row: Vec<Corners> = (0..1000)
        .map(|i| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|corner| corner + Vec3::X * 2.0 * i as f32))
        .collect();
    let scene = scene(&row);
    let mut words = words(&scene);
    let mut looked = 0;
    let origin = DVec3::new(0.2 + 2.0 * 333.0, 0.2, 5.0) - scene.bounds.center();
    let through = |words: &[u32], looked: &mut usize| {
        Tree(words).nearest(ROOT, origin, DVec3::new(1e-9, 1e-9, -1.0), looked)
    };
    assert!(through(&words, &mut looked).is_some_and(|t| (t - 5.0).abs() < 1e-6));
    assert!(looked <= 32, "{looked} looked at");
    // Boxes that end where they begin.
    for axis in 0..3 {
        for half in 0..2 {
            let word = ROOT * RECORD + 6 + 4 * axis + half;
            words[word + 2] = words[word];
        }
    }
    assert!(std::panic::catch_unwind(|| Tree(&words).check(ROOT, &mut Vec::new(), &mut Vec::new())).is_err());
}
