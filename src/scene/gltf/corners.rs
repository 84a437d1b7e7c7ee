//! Triangles as indices: from lists, strips and fans, with and without indices.

use super::accessor::indices;
use super::file::File;
use super::notes::{Fault, Notes};
use gltf::json::mesh::{Mode, Primitive};

/// The primitive's triangles as indices below `count`, in the windings that glTF gives each mode; `None` if they are
/// faulty. Strips and fans may name a vertex twice in a row, to go on elsewhere; that makes no triangle.
pub fn corners(
    file: &File,
    pointer: &str,
    primitive: &Primitive,
    mode: Mode,
    count: u32,
    notes: &mut Notes,
) -> Option<Vec<[u32; 3]>> {
    let list = match primitive.indices {
        Some(accessor) => notes.catch(format_args!("{pointer}/indices"), indices(file, accessor))?,
        None => (0..count).collect(),
    };
    if let Some(place) = list.iter().position(|index| *index >= count) {
        let index = list[place];
        let message = format!("index {index} (element {place}) is beyond the {count} vertices");
        notes.fault(format_args!("{pointer}/indices"), Fault::new("gltf-index", message));
        return None;
    }
    if mode == Mode::Triangles && list.len() % 3 != 0 || list.len() < 3 {
        notes.lack("incomplete triangle", "left out");
    }
    let whole = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let corners = match mode {
        Mode::TriangleStrip => {
            let odd = |i: usize| i % 2;
            let triangles = list.windows(3).enumerate();
            triangles.map(|(i, w)| [w[0], w[1 + odd(i)], w[2 - odd(i)]]).filter(whole).collect()
        }
        Mode::TriangleFan => {
            let rim = list.get(1..).unwrap_or_default();
            rim.windows(2).map(|w| [w[0], w[1], list[0]]).filter(whole).collect()
        }
        _ => list.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    };
    Some(corners)
}
