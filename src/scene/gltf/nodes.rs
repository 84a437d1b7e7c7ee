//! The node hierarchy: which nodes the scene has, and where they are in the world.

use super::notes::{Fault, Notes};
use glam::{DMat4, DQuat, DVec3};
use gltf::json::{self, Root};

/// A node of the scene that is loaded.
pub struct Placed<'a> {
    pub index: usize,
    pub node: &'a json::Node,
    pub to_world: DMat4,
}

/// The nodes of the default scene, parents before children: of scene 0 where the file names none, and all nodes where it
/// has no scenes. Loops and nodes with two parents are faults.
pub fn placed<'a>(root: &'a Root, notes: &mut Notes) -> Vec<Placed<'a>> {
    let count = root.nodes.len();
    let parents = parents(root, notes);
    let chosen = root.scene.map_or(0, |scene| scene.value());
    let mut open: Vec<(usize, DMat4)> = Vec::new();
    match root.scenes.get(chosen) {
        Some(scene) => {
            for (i, node) in scene.nodes.iter().enumerate().rev() {
                match parents.get(node.value()) {
                    Some(None) => open.push((node.value(), DMat4::IDENTITY)),
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
            open.extend(roots.map(|node| (node, DMat4::IDENTITY)));
        }
        None => notes.fault("/scene", Fault::beyond("scene", chosen, root.scenes.len())),
    }
    let mut placed = Vec::new();
    let mut seen = vec![false; count];
    // Each node has at most one parent, so only a scene that lists a root twice can reach a node twice.
    while let Some((index, parent)) = open.pop() {
        if std::mem::replace(&mut seen[index], true) {
            notes.fault(
                format_args!("/scenes/{chosen}/nodes"),
                Fault::new("gltf-nodes", format!("node {index} is listed twice")),
            );
            continue;
        }
        let node = &root.nodes[index];
        let local = notes.catch(format_args!("/nodes/{index}"), local(node));
        let to_world = parent * local.unwrap_or(DMat4::IDENTITY);
        let children = node.children.iter().flatten().rev();
        open.extend(
            children
                .map(|child| (child.value(), to_world))
                .filter(|(child, _)| parents.get(*child) == Some(&Some(index))),
        );
        placed.push(Placed { index, node, to_world });
    }
    placed
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
