//! What a file says of itself, without reading a mesh or a picture.

use super::file::File;
use super::nodes::{self, Movers};
use super::notes::Notes;
use crate::problem::Result;
use gltf::json::Root;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use std::collections::BTreeMap;
use std::path::Path;

/// Numbers of things in the scene of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outline {
    /// Each instance counted, as the file's own counts have it.
    pub triangles: u64,
    /// All materials of the file, used or not.
    pub materials: usize,
    /// Lights without extent.
    pub lights: usize,
    pub cameras: usize,
}

/// The outline of the file at `path`. Errors: as for loading, of the document, its buffers and its nodes.
pub(in crate::scene) fn read(path: &Path) -> Result<Outline> {
    let mut notes = Notes::new(&path.display().to_string());
    let file = File::open(path, &mut notes)?;
    let root = &file.root;
    let mut outline = Outline { materials: root.materials.len(), ..Outline::default() };
    let still = Movers { tracks: BTreeMap::new(), added: &[] };
    for placed in nodes::placed(root, still, &mut notes).0 {
        let mesh = placed.node.mesh.and_then(|mesh| root.meshes.get(mesh.value()));
        let triangles = mesh.into_iter().flat_map(|mesh| &mesh.primitives).map(|p| triangles(root, p));
        outline.triangles = triangles.fold(outline.triangles, u64::saturating_add);
        let light = placed.node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        outline.lights += usize::from(light.is_some());
        outline.cameras += usize::from(placed.node.camera.is_some());
    }
    notes.finish()?;
    Ok(outline)
}

fn triangles(root: &Root, primitive: &Primitive) -> u64 {
    let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions)).copied();
    let corners = primitive.indices.filter(|_| positions.is_some()).or(positions);
    let count = corners.and_then(|list| root.accessors.get(list.value())).map_or(0, |list| list.count.0);
    match primitive.mode {
        Checked::Valid(Mode::Triangles) => count / 3,
        Checked::Valid(Mode::TriangleStrip | Mode::TriangleFan) => count.saturating_sub(2),
        _ => 0,
    }
}
