//! The node hierarchy: which nodes the scene has, where they are in the world, and which of them move.

use super::notes::{Fault, Notes};
use crate::scene::motion::{self, Motion, MovingNode, Parent, Pose, Track};
use glam::{DMat4, DQuat, DVec3};
use gltf::json::{self, Root};
use std::collections::BTreeMap;

/// A node of the scene that is loaded.
pub struct Placed<'a> {
    pub index: usize,
    pub node: &'a json::Node,
    /// At rest.
    pub to_world: DMat4,
    /// Index of the moving node, if it moves.
    pub moving: Option<usize>,
}

/// What moves the nodes of a file: its own animations, and what a setting adds.
pub struct Movers<'a> {
    /// By node.
    pub tracks: BTreeMap<usize, Vec<Track>>,
    pub added: &'a [motion::Request],
}

/// The nodes of the default scene, and those of them that move; parents before children. Scene 0 is taken where the file
/// names none, and all nodes where it has no scenes. Loops and nodes with two parents are faults.
pub fn placed<'a>(root: &'a Root, mut movers: Movers<'_>, notes: &mut Notes) -> (Vec<Placed<'a>>, Motion) {
    let count = root.nodes.len();
    let parents = parents(root, notes);
    let chosen = root.scene.map_or(0, |scene| scene.value());
    let mut open: Vec<(usize, Above)> = Vec::new();
    match root.scenes.get(chosen) {
        Some(scene) => {
            for (i, node) in scene.nodes.iter().enumerate().rev() {
                match parents.get(node.value()) {
                    Some(None) => open.push((node.value(), Above::default())),
                    Some(Some(parent)) => {
                        let message = format!("node {node} is no root: it is a child of node {parent}");
                        notes.fault(
                            format_args!("/scenes/{chosen}/nodes/{i}"),
                            Fault::new("gltf-nodes", message),
                        );
                    }
                    None => notes.fault(
                        format_args!("/scenes/{chosen}/nodes/{i}"),
                        Fault::beyond("node", node.value(), count),
                    ),
                }
            }
        }
        None if root.scene.is_none() => {
            let roots = (0..count).rev().filter(|node| parents[*node].is_none());
            open.extend(roots.map(|node| (node, Above::default())));
        }
        None => notes.fault("/scene", Fault::beyond("scene", chosen, root.scenes.len())),
    }
    let mut placed = Vec::new();
    let mut moves = Motion::default();
    let mut seen = vec![false; count];
    // Each node has at most one parent, so only a scene that lists a root twice can reach a node twice.
    while let Some((index, above)) = open.pop() {
        if std::mem::replace(&mut seen[index], true) {
            notes.fault(
                format_args!("/scenes/{chosen}/nodes"),
                Fault::new("gltf-nodes", format!("node {index} is listed twice")),
            );
            continue;
        }
        let node = &root.nodes[index];
        let local = notes.catch(format_args!("/nodes/{index}"), local(node)).unwrap_or(DMat4::IDENTITY);
        let to_world = above.to_world * local;
        let moving = movers.of(index, node, local, above, notes).map(|node| {
            moves.nodes.push(node);
            moves.nodes.len() - 1
        });
        let children = node.children.iter().flatten().rev();
        open.extend(
            children
                .map(|child| (child.value(), Above { to_world, moving }))
                .filter(|(child, _)| parents.get(*child) == Some(&Some(index))),
        );
        placed.push(Placed { index, node, to_world, moving });
    }
    (placed, moves)
}

/// What stands above a node: its parent's transform at rest, and the parent's index among those that move.
#[derive(Clone, Copy, Default)]
struct Above {
    to_world: DMat4,
    moving: Option<usize>,
}

impl Movers<'_> {
    /// The node as one that moves, if it or its parent does.
    fn of(
        &mut self,
        index: usize,
        node: &json::Node,
        local: DMat4,
        above: Above,
        notes: &mut Notes,
    ) -> Option<MovingNode> {
        let mut tracks = self.tracks.remove(&index).unwrap_or_default();
        if node.matrix.is_some() && !tracks.is_empty() {
            notes.lack("animation of a node that has a matrix", "not played");
            tracks.clear();
        }
        let request = self.added.iter().find(|request| Some(&request.node) == node.name.as_ref());
        if tracks.is_empty() && request.is_none() && above.moving.is_none() {
            return None;
        }
        let origin = (above.to_world * local).transform_point3(DVec3::ZERO);
        Some(MovingNode {
            parent: above.moving.map_or(Parent::Still(above.to_world), Parent::Moving),
            rest: Pose::at_rest(node, local),
            tracks,
            added: request.map(|request| request.about(origin)),
            carries: Vec::new(),
        })
    }
}

impl Pose {
    /// A node's own numbers, which animations replace one by one; of one that has a matrix instead (which can't be animated
    /// then, but can be carried along), the matrix.
    fn at_rest(node: &json::Node, local: DMat4) -> Self {
        if node.matrix.is_some() {
            return Self::Matrix(local);
        }
        let rotation = node.rotation.unwrap_or_default().0.map(f64::from);
        let rotation = DQuat::from_array(rotation);
        Self::Parts {
            translation: vector(node.translation.unwrap_or_default()),
            rotation: if rotation.length() > 1e-6 { rotation.normalize() } else { DQuat::IDENTITY },
            scale: vector(node.scale.unwrap_or([1.0; 3])),
        }
    }
}

/// The parent of each node. Faults: a child that isn't there, a second parent, a loop.
fn parents(root: &Root, notes: &mut Notes) -> Vec<Option<usize>> {
    let count = root.nodes.len();
    let mut parents: Vec<Option<usize>> = vec![None; count];
    for (index, node) in root.nodes.iter().enumerate() {
        for (i, child) in node.children.iter().flatten().enumerate() {
            let pointer = format_args!("/nodes/{index}/children/{i}").to_string();
            match parents.get_mut(child.value()) {
                None => notes.fault(pointer, Fault::beyond("node", child.value(), count)),
                Some(slot @ None) => *slot = Some(index),
                Some(Some(first)) => {
                    let message = format!("node {child} already has the parent {first}");
                    notes.fault(pointer, Fault::new("gltf-nodes", message));
                }
            }
        }
    }
    // Whoever climbs from a node of a loop never comes to a root. Each node is climbed over once.
    let mut walk = vec![0; count];
    for start in 0..count {
        let mut at = start;
        while walk[at] == 0 {
            walk[at] = start + 1;
            match parents[at] {
                Some(parent) => at = parent,
                None => break,
            }
        }
        if walk[at] == start + 1 && parents[at].is_some() {
            let message = format!("node {at} is its own ancestor");
            notes.fault(format_args!("/nodes/{at}"), Fault::new("gltf-nodes", message));
        }
    }
    parents
}

/// The node's own transform. Fault: a number that isn't finite.
fn local(node: &json::Node) -> Result<DMat4, Fault> {
    let local = match node.matrix {
        Some(matrix) => DMat4::from_cols_array(&matrix.map(f64::from)),
        None => {
            let rotation = node.rotation.unwrap_or_default().0.map(f64::from);
            let rotation = DQuat::from_array(rotation);
            let length = rotation.length();
            if !(length > 1e-6 && length.is_finite()) {
                return Err(Fault::new("gltf-value", "the rotation is no unit quaternion"));
            }
            DMat4::from_scale_rotation_translation(
                vector(node.scale.unwrap_or([1.0; 3])),
                rotation / length,
                vector(node.translation.unwrap_or_default()),
            )
        }
    };
    let affine = local.row(3) == glam::DVec4::W;
    match local.is_finite() {
        true if affine => Ok(local),
        true => Err(Fault::new("gltf-value", "the matrix is not affine: its fourth row is not 0 0 0 1")),
        false => Err(Fault::new("gltf-value", "the transform is not finite")),
    }
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(v.map(f64::from))
}
