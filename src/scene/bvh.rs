//! A bounding volume hierarchy over the scene's triangles, for kernels that trace rays; built by obvhs.
//!
//! It is one list of records of [`RECORD`] words (32 B): a grid, the root, the other inner nodes, and then triangles, which
//! take two records each. Positions are metres from the centre of [`Scene::bounds`], so that a scene far from the origin
//! loses no more precision than its own transforms have. Boxes are whole numbers of 16 bits on the grid, rounded
//! outwards and one more: half the memory of floats, and no ray is lost by rounding.
//!
//! | words | of the grid |
//! |---|---|
//! | 0–2, 4–6 | f32: where it begins, and its step, along x, y, z |
//!
//! | words | of a node: boxes of its two children, and where these are |
//! |---|---|
//! | 0, 2, 4 | along x, y, z: least (bits 0–15) and greatest (16–31) of the first child |
//! | 1, 3, 5 | the same of the second |
//! | 6, 7 | the first child, the second: bit 31 set for a leaf, bits 27–30 its number of triangles, bits 0–26 the record of a node or of a leaf's first triangle |
//!
//! | words | of a triangle |
//! |---|---|
//! | 0–2, 4–6, 8–10 | its corners |
//! | 3, 7, 11 | the corners' vertices |
//! | 12, 13 | its instance, its index |
//! | 14 | f32: how likely a ray to an emitter chosen by [`super::emitters`] ends in a unit of its area, 1/m² |
//! | 15 | bit 0: its material has holes |
//!
//! A leaf without triangles stands for a child that is not there.

use super::Scene;
use super::emitters::emitting;
use glam::{DVec3, Vec3};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;

pub const RECORD: usize = 8;
/// Records of a triangle.
const OF_TRIANGLE: usize = 2;
/// Where the root is: after the grid.
const ROOT: usize = 1;
/// Inner nodes above any triangle, root included. A kernel's stack holds that many.
pub const MOST_DEPTH: usize = 48;
/// Triangles of a leaf. Measured with the Cornell box: 1, 2, 4, 8 took 245, 210, 218, 249 ms.
const MOST_IN_LEAF: u32 = 8;
const LEAF: u32 = 1 << 31;
const COUNT_SHIFT: u32 = 27;

const MASKED: u32 = 1;

/// A subtree before it is laid out: what the builder made, or a run of its triangles to be halved.
enum Part<'a> {
    Node(&'a Bvh2, usize),
    Run(&'a [u32]),
}

/// The records' words. As long for all poses of a scene: padded with zeros where something moves.
pub fn words(scene: &Scene) -> Vec<u32> {
    let corners = corners(scene);
    let boxes: Vec<Aabb> = corners.iter().map(|c| Aabb::from_points(&c.map(Into::into))).collect();
    let params = BvhBuildParams { max_prims_per_leaf: MOST_IN_LEAF, ..BvhBuildParams::medium_build() };
    let tree = build_bvh2(&boxes, params, &mut std::time::Duration::default());
    let grid = Grid::around(&boxes);
    let mut writer = Writer { words: grid.words().to_vec(), grid, boxes: &boxes, leaves: Vec::new() };
    let root = match deepest(&tree) {
        0 => Part::Run(&[]),
        1..=MOST_DEPTH => Part::Node(&tree, 0),
        // Halves of the list, which is in the builder's order, are far from the best tree but never deep.
        _ => Part::Run(&tree.primitive_indices),
    };
    writer.root(&root);
    let Writer { mut words, leaves, .. } = writer;
    let first_triangle = words.len() / RECORD;
    // Triangles come after all nodes, leaf by leaf.
    let mut next = first_triangle;
    let mut order = Vec::with_capacity(corners.len());
    for Leaf { at, triangles } in leaves {
        words[at] = leaf(next, triangles.len());
        next += OF_TRIANGLE * triangles.len();
        order.extend(triangles);
    }
    let densities = densities(scene, &corners);
    words.reserve(order.len() * OF_TRIANGLE * RECORD);
    for triangle in order {
        words.extend(record(scene, triangle, &corners[triangle as usize], densities[triangle as usize]));
    }
    if scene.still_triangles < scene.triangles.len() {
        words.resize((ROOT + 1 + (1 + OF_TRIANGLE) * scene.triangles.len()) * RECORD, 0);
    }
    words
}

/// Corners of all triangles in the world, from the centre of the bounds.
pub(super) fn corners(scene: &Scene) -> Vec<[Vec3; 3]> {
    let center = scene.bounds.center();
    let placed = |triangle: &super::Triangle| {
        let [x, y, z, w] =
            scene.instances[triangle.instance as usize].to_world.map(|c| c.truncate().as_dvec3());
        [triangle.a, triangle.b, triangle.c].map(|corner| {
            let p: DVec3 = scene.vertices[corner as usize].position.as_dvec3();
            (x * p.x + y * p.y + z * p.z + (w - center)).as_vec3()
        })
    };
    scene.triangles.iter().map(placed).collect()
}

/// By triangle: how likely a unit of its area is the end of a ray to an emitter.
fn densities(scene: &Scene, corners: &[[Vec3; 3]]) -> Vec<f32> {
    let mut densities = vec![0.0; corners.len()];
    for (triangle, probability) in emitting(scene, corners) {
        let area = area(&corners[triangle]);
        densities[triangle] = if area > 0.0 { (f64::from(probability) / area) as f32 } else { 0.0 };
    }
    densities
}

/// In m².
pub(super) fn area([a, b, c]: &[Vec3; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| p.as_dvec3());
    0.5 * (b - a).cross(c - a).length()
}

fn record(scene: &Scene, triangle: u32, corners: &[Vec3; 3], density: f32) -> [u32; OF_TRIANGLE * RECORD] {
    let placed = scene.triangles[triangle as usize];
    let material = scene.instances[placed.instance as usize].material;
    let masked = scene.materials[material as usize].alpha_cutoff > 0.0;
    let [a, b, c] = corners.map(|corner| corner.to_array().map(f32::to_bits));
    [
        a[0],
        a[1],
        a[2],
        placed.a,
        b[0],
        b[1],
        b[2],
        placed.b,
        c[0],
        c[1],
        c[2],
        placed.c,
        placed.instance,
        triangle,
        density.to_bits(),
        if masked { MASKED } else { 0 },
    ]
}

/// Inner nodes on the longest way down; 1 for a single leaf, 0 without triangles.
fn deepest(tree: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut open: Vec<(usize, usize)> = tree.nodes.first().map(|_| (0, 1)).into_iter().collect();
    while let Some((node, depth)) = open.pop() {
        deepest = deepest.max(depth);
        let node = &tree.nodes[node];
        if !node.is_leaf() {
            let first = node.first_index as usize;
            open.extend([(first, depth + 1), (first + 1, depth + 1)]);
        }
    }
    deepest
}

/// Triangles of a leaf, and the word that is to say where they are.
struct Leaf {
    at: usize,
    triangles: Vec<u32>,
}

/// What boxes are rounded to.
struct Grid {
    begin: Vec3,
    step: Vec3,
}

impl Grid {
    /// Steps from end to end, with one to spare on either side.
    const STEPS: f32 = 65533.0;

    fn around(boxes: &[Aabb]) -> Self {
        let all = boxes.iter().copied().reduce(|a, b| a.union(&b));
        let all = all.unwrap_or(Aabb { min: Vec3::ZERO.into(), max: Vec3::ZERO.into() });
        let step = (Vec3::from(all.max) - Vec3::from(all.min)).max(Vec3::splat(1e-30)) / Self::STEPS;
        Self { begin: Vec3::from(all.min) - step, step }
    }

    fn words(&self) -> [u32; RECORD] {
        let [begin, step] = [self.begin, self.step].map(|v| v.to_array().map(f32::to_bits));
        [begin[0], begin[1], begin[2], 0, step[0], step[1], step[2], 0]
    }

    /// Least and greatest along each axis, one step beyond what holds the box.
    fn words_of(&self, around: &Aabb) -> [u32; 3] {
        let low = (Vec3::from(around.min) - self.begin) / self.step;
        let high = (Vec3::from(around.max) - self.begin) / self.step;
        // Casts cut off below 0 and above 65535.
        std::array::from_fn(|axis| {
            let least = (low[axis].floor() - 1.0) as u16;
            let greatest = (high[axis].ceil() + 1.0) as u16;
            u32::from(least) | u32::from(greatest) << 16
        })
    }
}

struct Writer<'a> {
    words: Vec<u32>,
    grid: Grid,
    boxes: &'a [Aabb],
    leaves: Vec<Leaf>,
}

impl<'a> Writer<'a> {
    /// Depth first, so that a child often lies beside its parent. A root that is a leaf gets a node above it.
    fn root(&mut self, root: &Part<'a>) {
        let children = root.children().unwrap_or_else(|| [root.alike(), Part::Run(&[])]);
        let mut open = vec![(None, children)];
        while let Some((at, children)) = open.pop() {
            let record = self.words.len();
            if let Some(at) = at {
                self.words[at] = (record / RECORD) as u32;
            }
            self.words.resize(record + RECORD, 0);
            for (which, child) in children.into_iter().enumerate().rev() {
                for (axis, word) in self.grid.words_of(&child.bounds(self.boxes)).into_iter().enumerate() {
                    self.words[record + 2 * axis + which] = word;
                }
                let at = record + 6 + which;
                match child.children() {
                    Some(children) => open.push((Some(at), children)),
                    None => self.leaves.push(Leaf { at, triangles: child.triangles() }),
                }
            }
        }
    }
}

fn leaf(first: usize, count: usize) -> u32 {
    LEAF | (count as u32) << COUNT_SHIFT | first as u32
}

impl<'a> Part<'a> {
    fn alike(&self) -> Self {
        match self {
            Part::Node(tree, node) => Part::Node(tree, *node),
            Part::Run(run) => Part::Run(run),
        }
    }

    /// `None` for a leaf.
    fn children(&self) -> Option<[Self; 2]> {
        match self {
            Part::Node(tree, node) => {
                let node = &tree.nodes[*node];
                let first = node.first_index as usize;
                (!node.is_leaf()).then(|| [Part::Node(tree, first), Part::Node(tree, first + 1)])
            }
            Part::Run(run) => (run.len() > MOST_IN_LEAF as usize).then(|| {
                let (left, right) = run.split_at(run.len() / 2);
                [Part::Run(left), Part::Run(right)]
            }),
        }
    }

    fn triangles(&self) -> Vec<u32> {
        match self {
            Part::Node(tree, node) => {
                let node = &tree.nodes[*node];
                let first = node.first_index as usize;
                tree.primitive_indices[first..first + node.prim_count as usize].to_vec()
            }
            Part::Run(run) => run.to_vec(),
        }
    }

    fn bounds(&self, boxes: &[Aabb]) -> Aabb {
        match self {
            Part::Node(tree, node) => *tree.nodes[*node].aabb(),
            Part::Run([]) => Aabb { min: Vec3::ZERO.into(), max: Vec3::ZERO.into() },
            Part::Run(run) => run.iter().fold(Aabb::empty(), |all, t| all.union(&boxes[*t as usize])),
        }
    }
}
