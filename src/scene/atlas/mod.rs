//! The scene's surfaces laid out flat, without overlap, in one square: a place for each point of every surface, so that
//! kernels can draw what belongs to surfaces into a texture, or look it up there.
//!
//! Each mesh is unwrapped once, in its own space ([`unwrap`]); instances share what their mesh has, and each has a
//! rectangle of its own ([`shelves`]) that is as much larger as its transform stretches most. So a length on a surface
//! is about as long in the square, and no rigid motion changes anything. Meshes are kept by content ([`kept`]).
//!
//! What has no area has no place: its corners coincide there, and [`Atlas::lost`] counts it.
//!
//! As the buffer `atlas` it is a list of pairs of words (8 B each), the bits of f32 but for `first`, in this order:
//!
//! | pairs | of each instance |
//! |---|---|
//! | 0 | `offset`, where its rectangle begins, in the square [0, 1]² |
//! | 1 | `scale`, and the u32 `first` |
//!
//! | pairs | of each triangle of each mesh |
//! |---|---|
//! | 0–2 | its corners in the mesh's rectangle |
//!
//! Corner `c` of triangle `t` of the scene, of instance `i`, is pair `first[i] + 3 · t + c` (modulo 2³²), and in the
//! square `offset[i] + scale[i] · corner`. The side of the square is [`Atlas::extent`] metres: a texture of n² texels
//! has `n / extent` of them to a metre.

mod kept;
mod mesh;
mod shelves;
#[cfg(test)]
mod tests;
mod unwrap;
mod watch;

pub use unwrap::Unwrapped;
pub use watch::watch;

use super::Scene;
use super::layout::Instance;
use glam::{DMat3, DVec2, DVec3, Vec2};
use rayon::prelude::*;
use shelves::Shelves;
use std::path::Path;
use std::sync::Arc;
use watch::Watched;

/// A gap between the rectangles of instances: the root of the area of all, over this.
const GAPS: f64 = 2048.0;

/// The layout of a scene, as it was when it was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    /// Side of the square in metres of the world.
    pub extent: f64,
    /// Triangles of the scene that have no place, each instance counted.
    pub lost: usize,
    /// Meshes that were unwrapped for it; the others were kept from before.
    pub unwrapped: usize,
    places: Vec<Place>,
    meshes: Vec<Arc<Unwrapped>>,
}

/// Of an instance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Place {
    offset: Vec2,
    scale: f32,
    /// The pair of the first corner of the instance's first triangle, less three times that triangle's number.
    first: u32,
}

impl Atlas {
    /// Of `scene` where it is now; meshes come from the folder `cache` as far as they are there, and go there. A folder
    /// that can't be written to only costs the time of unwrapping again.
    pub fn of(scene: &Scene, cache: Option<&Path>) -> Self {
        let (meshes, runs) = mesh::meshes(scene);
        let watched = Watched::new(&meshes);
        let made: Vec<(Arc<Unwrapped>, bool)> = meshes
            .par_iter()
            .map(|mesh| {
                let (unwrapped, new) = kept::get(mesh, cache, &watched);
                (Arc::new(unwrapped), new)
            })
            .collect();
        watched.end();
        let unwrapped = made.iter().filter(|(_, new)| *new).count();
        let sheets: Vec<Arc<Unwrapped>> = made.into_iter().map(|(sheet, _)| sheet).collect();
        let scales: Vec<f64> =
            runs.iter().map(|run| meshes[run.mesh].unit * stretch(&scene.instances[run.instance])).collect();
        let sizes = runs.iter().zip(&scales).map(|(run, scale)| sheets[run.mesh].size.as_dvec2() * *scale);
        let sizes: Vec<DVec2> = sizes.collect();
        let gap = sizes.iter().map(|size| size.element_product()).sum::<f64>().sqrt() / GAPS;
        let Shelves { places: offsets, side } = shelves::pack(&sizes, gap);
        let mut places = vec![Place::default(); scene.instances.len()];
        let mut firsts = Vec::with_capacity(sheets.len());
        let mut next = 2 * places.len();
        for sheet in &sheets {
            firsts.push(next);
            next += 3 * sheet.corners.len();
        }
        for ((run, offset), scale) in runs.iter().zip(offsets).zip(scales) {
            places[run.instance] = Place {
                offset: (offset / side).as_vec2(),
                scale: (scale / side) as f32,
                // Wraps around, as the kernels' sum does.
                first: (firsts[run.mesh] as u32).wrapping_sub(3 * run.first as u32),
            };
        }
        let lost = runs.iter().map(|run| sheets[run.mesh].lost()).sum();
        Self { extent: side, lost, unwrapped, places, meshes: sheets }
    }

    /// The buffer's content.
    pub fn pairs(&self) -> Vec<[u32; 2]> {
        let bits = |p: Vec2| p.to_array().map(f32::to_bits);
        let places = self.places.iter().flat_map(|p| [bits(p.offset), [p.scale.to_bits(), p.first]]);
        let corners = self.meshes.iter().flat_map(|mesh| mesh.corners.iter().flatten().copied().map(bits));
        places.chain(corners).collect()
    }
}

impl Scene {
    /// The scene's layout, made when it is first asked for (which can take seconds) and then kept with the scene.
    pub fn atlas(&self) -> &Atlas {
        self.atlas.get_or_init(|| {
            // Where there is no folder, nothing is kept.
            let folder = crate::cache::folder_of_user().ok().map(|folder| folder.join("atlases"));
            Arc::new(Atlas::of(self, folder.as_deref()))
        })
    }
}

/// How much the instance's transform stretches what it stretches most: its largest singular value.
fn stretch(instance: &Instance) -> f64 {
    let [x, y, z, _] = instance.to_world.map(|column| column.truncate().as_dvec3());
    let linear = DMat3::from_cols(x, y, z);
    let largest = [x, y, z].iter().fold(0.0_f64, |largest, column| largest.max(column.abs().max_element()));
    if largest == 0.0 {
        return 0.0;
    }
    let linear = linear * largest.recip();
    let squared = linear.transpose() * linear;
    // The power method. The vector that is stretched most is not square to all three axes.
    let stretched = |axis: DVec3| {
        let along = (0..64).fold(axis, |v, _| (squared * v).try_normalize().unwrap_or(DVec3::ZERO));
        (linear * along).length()
    };
    largest * [DVec3::X, DVec3::Y, DVec3::Z].into_iter().map(stretched).fold(0.0, f64::max)
}
