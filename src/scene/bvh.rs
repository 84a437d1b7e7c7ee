//! A bounding volume hierarchy over the scene's triangles, for kernels that trace rays; built by obvhs.
//!
//! It is a list of records of [`RECORD`] words (16 B): the grid, the root, the other inner nodes, and then the triangles.
//! Nodes have up to eight children (Ylitie, Karras and Laine 2017): fewer steps for a ray, more alike from ray to ray.
//! Positions are metres from the centre of [`Scene::bounds`], so that a scene far from the origin loses no more precision
//! than its own transforms have. Boxes are whole numbers of 16 bits on the grid, rounded outwards and one more, so that no
//! ray is lost by rounding; and then of 8 bits from the corner of their node, rounded outwards again.
//!
//! | words | of the grid, 2 records |
//! |---|---|
//! | 0–2, 4–6 | f32: where it begins, and its step, along x, y, z |
//!
//! | words | of a node, 5 records |
//! |---|---|
//! | 0 | its corner along x (bits 0–15) and y (16–31), on the grid |
//! | 1 | its corner along z (0–15); binary logarithms of its children's unit along x (16–19), y (20–23), z (24–27), in steps of the grid |
//! | 2, 3 | the record of its first child that is a node, and of the first triangle in its leaves |
//! | 4, 5 | a byte for each child: 0 for none, 128 for a node, else a leaf: its first triangle among the node's (bits 0–4), and how many (5–6) |
//! | 6, 7 and 8, 9 | a byte for each child: least and greatest along x, in its unit from its corner |
//! | 10–13, 14–17 | the same along y, z |
//! | 18 | bit i: child i is a node; these follow each other in this order |
//!
//! A child's number tells on which side of its node's middle it lies, as far as that is free to choose: bits 2, 1, 0 are
//! set for the far side along x, y, z. So a ray visits near children first by going through numbers in an order of its own.
//!
//! | words | of a triangle, 4 records |
//! |---|---|
//! | 0–2, 4–6, 8–10 | its corners |
//! | 3, 7, 11 | the corners' vertices |
//! | 12, 13 | its instance, its index |
//! | 14 | f32: how likely a ray to an emitter chosen by [`super::emitters`] ends in a unit of its area, 1/m² |
//! | 15 | bit 0: its material has holes |

use super::Scene;
use super::emitters::emitting;
use glam::{DVec3, Vec3};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;

pub const RECORD: usize = 4;
/// Records of a triangle, and of a node.
const OF_TRIANGLE: usize = 4;
const OF_NODE: usize = 5;
/// Where the root is: after the grid.
const ROOT: usize = 2;
const CHILDREN: usize = 8;
/// Inner nodes above any triangle, root included. A kernel's stack holds that many.
pub const MOST_DEPTH: usize = 32;
const MOST_IN_LEAF: u32 = 3;
const NODE: u8 = 128;
const COUNT_SHIFT: u32 = 5;

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
    let root = if tree.nodes.is_empty() { Part::Run(&[]) } else { Part::Node(&tree, 0) };
    let mut layout = Layout::of(&root, &boxes);
    if layout.depth > MOST_DEPTH {
        // Halves of the list, which is in the builder's order, are far from the best tree but never deep.
        layout = Layout::of(&Part::Run(&tree.primitive_indices), &boxes);
    }
    let densities = densities(scene, &corners);
    let Layout { mut words, triangles, .. } = layout;
    words.reserve(triangles.len() * OF_TRIANGLE * RECORD);
    for triangle in triangles {
        words.extend(record(scene, triangle, &corners[triangle as usize], densities[triangle as usize]));
    }
    if scene.still_triangles < scene.triangles.len() {
        // Of nodes with fewer than eight children, which then are leaves all, there are at least two triangles in each:
        // so there are at most four nodes to seven triangles, and the root.
        let count = scene.triangles.len();
        words.resize((ROOT + OF_NODE * (count * 4 / 7 + 2) + OF_TRIANGLE * count) * RECORD, 0);
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

    fn words(&self) -> [u32; ROOT * RECORD] {
        let [begin, step] = [self.begin, self.step].map(|v| v.to_array().map(f32::to_bits));
        [begin[0], begin[1], begin[2], 0, step[0], step[1], step[2], 0]
    }

    /// Least and greatest along each axis, one step beyond what holds the box.
    fn cells(&self, around: &Aabb) -> [[u16; 2]; 3] {
        let low = (Vec3::from(around.min) - self.begin) / self.step;
        let high = (Vec3::from(around.max) - self.begin) / self.step;
        // Casts cut off below 0 and above 65535.
        std::array::from_fn(|axis| [(low[axis].floor() - 1.0) as u16, (high[axis].ceil() + 1.0) as u16])
    }
}

/// All nodes, laid out.
struct Layout {
    /// Of the grid and the nodes.
    words: Vec<u32>,
    /// In the order of the records to come.
    triangles: Vec<u32>,
    /// Inner nodes on the longest way down.
    depth: usize,
}

impl Layout {
    /// Breadth first, so that the nodes among the children of one follow each other.
    fn of<'a>(root: &Part<'a>, boxes: &[Aabb]) -> Self {
        let grid = Grid::around(boxes);
        let mut layout = Self { words: grid.words().to_vec(), triangles: Vec::new(), depth: 0 };
        let mut level: Vec<Part<'a>> = vec![root.alike()];
        while !level.is_empty() {
            layout.depth += 1;
            let mut next = layout.words.len() / RECORD + OF_NODE * level.len();
            let mut below = Vec::new();
            for part in level {
                let before = below.len();
                layout.node(&part, boxes, &grid, next, &mut below);
                next += OF_NODE * (below.len() - before);
            }
            level = below;
        }
        let first = (layout.words.len() / RECORD) as u32;
        for node in layout.words[ROOT * RECORD..].chunks_exact_mut(OF_NODE * RECORD) {
            node[3] = first + node[3] * OF_TRIANGLE as u32;
        }
        layout
    }

    /// Adds a node; `first`: the record of the first of its children that are nodes, which go to `below`.
    fn node<'a>(
        &mut self,
        part: &Part<'a>,
        boxes: &[Aabb],
        grid: &Grid,
        first: usize,
        below: &mut Vec<Part<'a>>,
    ) {
        let children = part.wide(boxes);
        let cells: Vec<[[u16; 2]; 3]> =
            children.iter().map(|child| grid.cells(&child.bounds(boxes))).collect();
        let corner: [u16; 3] =
            std::array::from_fn(|axis| cells.iter().map(|c| c[axis][0]).min().unwrap_or(0));
        let end: [u16; 3] = std::array::from_fn(|axis| cells.iter().map(|c| c[axis][1]).max().unwrap_or(0));
        let units: [u32; 3] = std::array::from_fn(|axis| {
            let extent = u32::from(end[axis] - corner[axis]);
            (0..16).find(|unit| extent.div_ceil(1 << unit) <= 255).unwrap_or(15)
        });
        let mut node = [0; OF_NODE * RECORD];
        node[0] = u32::from(corner[0]) | u32::from(corner[1]) << 16;
        node[1] = u32::from(corner[2]) | units[0] << 16 | units[1] << 20 | units[2] << 24;
        // Of triangles not the record yet, but the number.
        (node[2], node[3]) = (first as u32, self.triangles.len() as u32);
        let begin = self.triangles.len();
        for (slot, child) in slots(&cells).into_iter().enumerate() {
            let Some(child) = child else { continue };
            let byte = |node: &mut [u32], word: usize, value: u8| {
                node[word + slot / 4] |= u32::from(value) << (8 * (slot % 4));
            };
            for axis in 0..3 {
                let [low, high] = cells[child][axis].map(|cell| u32::from(cell - corner[axis]));
                byte(&mut node, 6 + 4 * axis, (low >> units[axis]) as u8);
                byte(&mut node, 8 + 4 * axis, high.div_ceil(1 << units[axis]) as u8);
            }
            if children[child].children().is_some() {
                node[18] |= 1 << slot;
                byte(&mut node, 4, NODE);
                below.push(children[child].alike());
            } else {
                let leaf = children[child].triangles();
                byte(&mut node, 4, ((leaf.len() << COUNT_SHIFT) | (self.triangles.len() - begin)) as u8);
                self.triangles.extend(leaf);
            }
        }
        self.words.extend(node);
    }
}

/// Which child gets which number: best pairs first, by how far it lies on that side.
fn slots(cells: &[[[u16; 2]; 3]]) -> [Option<usize>; CHILDREN] {
    let middle = |c: &[[u16; 2]; 3]| c.map(|[low, high]| i64::from(low) + i64::from(high));
    let middles: Vec<[i64; 3]> = cells.iter().map(middle).collect();
    let sum: [i64; 3] = std::array::from_fn(|axis| middles.iter().map(|m| m[axis]).sum());
    let score = |child: usize, slot: usize| -> i64 {
        let off = |axis: usize| middles[child][axis] * middles.len() as i64 - sum[axis];
        (0..3).map(|axis| if slot & (4 >> axis) == 0 { -off(axis) } else { off(axis) }).sum()
    };
    let mut pairs: Vec<(i64, usize, usize)> = (0..cells.len())
        .flat_map(|child| (0..CHILDREN).map(move |slot| (child, slot)))
        .map(|(child, slot)| (-score(child, slot), child, slot))
        .collect();
    pairs.sort_unstable();
    let (mut slots, mut placed) = ([None; CHILDREN], [false; CHILDREN]);
    for (_, child, slot) in pairs {
        if !placed[child] && slots[slot].is_none() {
            (placed[child], slots[slot]) = (true, Some(child));
        }
    }
    slots
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

    /// Up to eight children, the largest taken apart first; itself if it is a leaf.
    fn wide(&self, boxes: &[Aabb]) -> Vec<Self> {
        let mut children = vec![self.alike()];
        while children.len() < CHILDREN {
            let area = |at: &usize| children[*at].bounds(boxes).half_area();
            let inner = (0..children.len()).filter(|at| children[*at].children().is_some());
            let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else { break };
            if let Some(two) = children[largest].children() {
                children.splice(largest..=largest, two);
            }
        }
        children.retain(|child| !child.is_empty());
        children
    }

    fn is_empty(&self) -> bool {
        matches!(self, Part::Run([]))
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
