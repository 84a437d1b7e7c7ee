//! Scenes: triangles with materials, lights and cameras, from glTF files and settings, ready for kernels.
//!
//! World space is glTF's: metres, right-handed, y up. Colours are linear Rec. 709. Light is radiometric: point and spot
//! lights in W/sr, directional lights in W/m² on a surface that faces them, emission in W/(sr·m²); glTF's
//! candela, lux and nits are taken as such, without the factor of 683 lm/W.
//!
//! ```no_run
//! let scene = voxgi::scene::load("scenes/cornell-box.glb".as_ref())?;
//! println!("{} triangles in {:?}", scene.triangles.len(), scene.bounds);
//! # Ok::<(), voxgi::problem::Problems>(())
//! ```
//!
//! | file | what |
//! |---|---|
//! | [`layout`] | the types of the lists, as kernels see them |
//! | [`buffers`] | the lists as bytes |
//! | [`views`] | the scene as its lights see it |
//! | [`environment`] | light from far away |
//! | [`emitters`] | all that gives light, to choose from |
//! | [`bvh`] | the triangles as rays find them |
//! | [`atlas`] | the surfaces laid out flat |
//! | [`features`] | what conditions can ask about a scene |
//! | [`generate`] | scenes made by a command |
//! | [`listing`] | what scenes a folder has |

pub mod atlas;
mod bounds;
pub mod buffers;
pub mod bvh;
mod camera;
mod course;
pub mod emitters;
pub mod environment;
pub mod features;
pub mod generate;
mod gltf;
mod image;
mod instance;
pub mod layout;
mod lights;
pub mod listing;
pub mod motion;
mod setting;
#[cfg(test)]
mod tests;
pub mod views;

pub use bounds::Bounds;
pub use camera::{Camera, Lens};
pub use image::Image;

use crate::problem::{Problem, Result};
use environment::Environment;
use layout::{Instance, Light, Material, Triangle, Vertex, VertexExtra, View};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// How far from the origin a scene may reach in metres, lights and cameras with it: f32 holds the squares of distances.
pub const FARTHEST: f32 = 1e18;

/// A scene as loaded. Every index in it is in range, every number finite.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The file's name without extension.
    pub name: String,
    /// All files that were read; the scene changes only if one of them does.
    pub files: Vec<PathBuf>,
    pub vertices: Vec<Vertex>,
    /// As many as vertices, or none where no vertex needs any.
    pub vertex_extras: Vec<VertexExtra>,
    /// Those of an instance follow each other; those that some motion moves come last.
    pub triangles: Vec<Triangle>,
    /// How many triangles come before those that move.
    pub still_triangles: usize,
    pub instances: Vec<Instance>,
    pub materials: Vec<Material>,
    pub images: Vec<Image>,
    /// All images with their mip levels; see [`Image`].
    pub texels: Vec<u32>,
    pub lights: Vec<Light>,
    pub views: Vec<View>,
    pub environment: Option<Environment>,
    /// At least one.
    pub cameras: Vec<Camera>,
    /// Of all triangles, in the world, at all times.
    pub bounds: Bounds,
    pub motion: motion::Motion,
    /// Made when [`Scene::atlas`] is first asked for.
    pub atlas: OnceLock<Arc<atlas::Atlas>>,
    /// What the files have and the scene doesn't.
    pub lacks: Vec<Lack>,
}

/// Something that a file asks for and that is done otherwise: "2 transmissive materials are rendered opaque".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lack {
    /// In the singular.
    pub what: String,
    pub count: usize,
    pub instead: String,
}

impl fmt::Display for Lack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.count {
            1 => write!(f, "1 {} is {}", self.what, self.instead),
            count => {
                // The noun comes before what qualifies it: "set of vertex colours", "texture in a format …".
                let split =
                    [" of ", " in ", " with", " that "].iter().filter_map(|w| self.what.find(w)).min();
                let (noun, rest) = self.what.split_at(split.unwrap_or(self.what.len()));
                let plural = if noun.ends_with("sh") { "es" } else { "s" };
                write!(f, "{count} {noun}{plural}{rest} are {}", self.instead)
            }
        }
    }
}

/// Loads a scene: a glTF file (`.gltf`, `.glb`), or a setting (`.ron`), which names one and adds to it.
///
/// Errors: `scene-file` if it can't be read, `scene-kind` for another extension, `setting…` and `gltf-…` for
/// what is wrong inside.
pub fn load(path: &Path) -> Result<Scene> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let scene = match extension.as_str() {
        "gltf" | "glb" => gltf::load(path, &[])?,
        "ron" => setting::load(path)?,
        _ => {
            let message = format!("`{}` is no scene that voxgi can read", path.display());
            let help = "scenes are glTF files (.gltf, .glb) and settings (.ron)";
            return Err(Problem::input("scene-kind", message).help(help).into());
        }
    };
    Ok(scene.finish())
}

impl Scene {
    /// Adds what follows from the rest: where all is at the beginning, views, a camera if there is none, what views
    /// can't show.
    fn finish(mut self) -> Self {
        self.pose(0.0);
        self.views = views::fit(&mut self.lights, &self.bounds);
        if self.cameras.is_empty() {
            self.cameras.push(Camera::framing(&self.bounds));
        }
        let wide = self.lights.iter().filter(|light| views::wider_than_view(light)).count();
        if wide > 0 {
            self.lacks.push(Lack {
                what: "spot light wider than 170°".to_owned(),
                count: wide,
                instead: "seen by its view only within 170°".to_owned(),
            });
        }
        self
    }

    /// The box around these triangles, where they are now; `None` if a corner is beyond [`FARTHEST`] in the world.
    fn world_bounds(&self, triangles: std::ops::Range<usize>) -> Option<Bounds> {
        let corners = self.triangles[triangles].iter().flat_map(|triangle| {
            let to_world = self.instances[triangle.instance as usize].to_world;
            let [x, y, z, w] = to_world.map(|column| column.truncate());
            [triangle.a, triangle.b, triangle.c].map(|corner| {
                let p = self.vertices[corner as usize].position;
                x * p.x + y * p.y + z * p.z + w
            })
        });
        let mut near = true;
        let bounds = Bounds::around(corners.inspect(|corner| near &= is_near(*corner)));
        near.then_some(bounds.unwrap_or_default())
    }
}

/// Whether all coordinates are within [`FARTHEST`]; NaN is not.
fn is_near(point: glam::Vec3) -> bool {
    point.abs().cmple(glam::Vec3::splat(FARTHEST)).all()
}
