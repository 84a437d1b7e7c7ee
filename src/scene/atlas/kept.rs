//! Unwrapped meshes, kept by content: a file for each, named by a hash of all that it depends on. It holds a hash of
//! the rest, and the corners; what is not whole, or not of this mesh, is made again.

use super::mesh::Mesh;
use super::unwrap::{UNWRAPPER, Unwrapped, options, unwrap};
use super::watch::Watched;
use bytemuck::cast_slice;
use glam::Vec2;
use std::path::{Path, PathBuf};

/// Changes whenever what was kept before is not what would be made now.
const FORMAT: u32 = 1;

/// The mesh laid out, and whether that was done now.
pub fn get(mesh: &Mesh, folder: Option<&Path>, watched: &Watched) -> (Unwrapped, bool) {
    let file = folder.map(|folder| file(folder, mesh));
    if let Some(unwrapped) = file.as_ref().and_then(|file| read(file, mesh)) {
        watched.done(mesh);
        return (unwrapped, false);
    }
    let unwrapped = unwrap(mesh, |share| watched.part(mesh, share));
    watched.done(mesh);
    if let Some(file) = file {
        // Where nothing can be kept, it is made again next time.
        let _kept = write(&file, &unwrapped);
    }
    (unwrapped, true)
}

fn file(folder: &Path, mesh: &Mesh) -> PathBuf {
    let mut hash = blake3::Hasher::new();
    let options = options(mesh.area(), mesh.triangles.len());
    let about = format!("{FORMAT} {UNWRAPPER} {options:?} {}", mesh.positions.len());
    hash.update(&blake3::hash(about.as_bytes()).as_bytes()[..]);
    hash.update(cast_slice(&mesh.positions));
    hash.update(cast_slice(&mesh.triangles));
    folder.join(format!("{}.atlas", &hash.finalize().to_hex()[..32]))
}

fn read(file: &Path, mesh: &Mesh) -> Option<Unwrapped> {
    let content = std::fs::read(file).ok()?;
    let (hash, corners) = content.split_at_checked(blake3::OUT_LEN)?;
    let whole = blake3::hash(corners).as_bytes() == hash
        && corners.len() == size_of::<[Vec2; 3]>() * mesh.triangles.len();
    whole.then(|| Unwrapped::new(bytemuck::pod_collect_to_vec(corners)))
}

fn write(file: &Path, unwrapped: &Unwrapped) -> crate::problem::Result<()> {
    let corners: &[u8] = cast_slice(&unwrapped.corners);
    if let Some(folder) = file.parent() {
        // What follows says it if that failed.
        let _made = std::fs::create_dir_all(folder);
    }
    crate::picture::write_bytes(file, &[blake3::hash(corners).as_bytes(), corners].concat())
}
