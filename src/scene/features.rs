//! Features: what conditions of a pipeline can ask about a scene, as numbers, flags and vectors.
//!
//! [`NAMES`] says what there is without a scene at hand; [`features`] gives the values, in the same order.

use super::Scene;
use super::layout::{DIRECTIONAL, DOUBLE_SIDED, Material, POINT, SPOT};
use glam::Vec3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feature {
    Number(f64),
    Flag(bool),
    Vector([f64; 3]),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeatureKind {
    Number,
    Flag,
    Vector,
}

impl Feature {
    pub fn kind(&self) -> FeatureKind {
        match self {
            Feature::Number(_) => FeatureKind::Number,
            Feature::Flag(_) => FeatureKind::Flag,
            Feature::Vector(_) => FeatureKind::Vector,
        }
    }
}

/// Name, kind and meaning of one feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FeatureName {
    pub name: &'static str,
    pub kind: FeatureKind,
    pub meaning: &'static str,
}

/// Declares [`NAMES`] and [`features`] from one table, so that neither can miss an entry of the other.
macro_rules! features {
    ($scene:ident, $used:ident; $($name:literal $kind:ident $meaning:literal = $value:expr;)+) => {
        pub const NAMES: &[FeatureName] = &[
            $(FeatureName { name: $name, kind: FeatureKind::$kind, meaning: $meaning }),+
        ];

        /// All features of `scene`, in the order of [`NAMES`].
        pub fn features($scene: &Scene) -> Vec<(&'static str, Feature)> {
            let $used = &used_materials($scene);
            vec![$(($name, Feature::$kind($value))),+]
        }
    };
}

features! { scene, used;
    "scene.triangles" Number "Number of triangles, each instance counted." = scene.triangles.len() as f64;
    "scene.still_triangles" Number "Number of triangles that no motion moves." = scene.still_triangles as f64;
    "scene.vertices" Number "Number of vertices." = scene.vertices.len() as f64;
    "scene.materials" Number "Number of materials." = scene.materials.len() as f64;
    "scene.instances" Number "Number of placings of mesh parts." = scene.instances.len() as f64;
    "scene.min" Vector "Least corner of the box around all triangles, in metres." = vector(scene.bounds.min);
    "scene.max" Vector "Greatest corner of the box around all triangles, in metres." = vector(scene.bounds.max);
    "scene.emissive" Flag "Some triangle gives off light." = used.iter().any(|m| m.emission != Vec3::ZERO);
    "scene.max_emission" Number "Greatest emission of a triangle's material in a colour, W/(sr·m²); 0 without."
        = used.iter().fold(0.0, |greatest, m| f64::from(m.emission.max_element()).max(greatest));
    "scene.textured" Flag "Some triangle has an image for its colour or its emission."
        = used.iter().any(|m| m.base_color_image.y > 0 || m.emission_image.y > 0);
    "scene.masked" Flag "Some triangle has holes where its alpha is low."
        = used.iter().any(|m| m.alpha_cutoff > 0.0);
    "scene.double_sided" Flag "Some triangle has a double-sided material."
        = used.iter().any(|m| m.flags & DOUBLE_SIDED != 0);
    "scene.min_roughness" Number "Least roughness of a triangle's material; 1 without triangles."
        = used.iter().fold(1.0, |least, m| f64::from(m.roughness).min(least));
    "scene.max_metallic" Number "Greatest metalness of a triangle's material; 0 without triangles."
        = used.iter().fold(0.0, |greatest, m| f64::from(m.metallic).max(greatest));
    "scene.moving" Flag "Some triangle moves, at some time." = scene.still_triangles < scene.triangles.len();
    "scene.duration" Number "Seconds until the scene's longest motion starts again; 0 without any."
        = scene.motion.duration();
    "lights.point" Number "Number of point lights." = lights(scene, POINT);
    "lights.spot" Number "Number of spot lights." = lights(scene, SPOT);
    "lights.directional" Number "Number of directional lights." = lights(scene, DIRECTIONAL);
    "lights.total" Number "Number of lights, not counting emissive triangles." = scene.lights.len() as f64;
    "views.total" Number "Number of views: six for each point light, one for each other light."
        = scene.views.len() as f64;
    "cameras.total" Number "Number of cameras." = scene.cameras.len() as f64;
}

fn vector(v: Vec3) -> [f64; 3] {
    v.as_dvec3().to_array()
}

fn lights(scene: &Scene, kind: u32) -> f64 {
    scene.lights.iter().filter(|light| light.kind == kind).count() as f64
}

/// The materials that some triangle has; a file may hold others.
fn used_materials(scene: &Scene) -> Vec<Material> {
    let mut used = vec![false; scene.materials.len()];
    for triangle in &scene.triangles {
        let instance = scene.instances.get(triangle.instance as usize);
        if let Some(flag) = instance.and_then(|i| used.get_mut(i.material as usize)) {
            *flag = true;
        }
    }
    scene.materials.iter().zip(used).filter_map(|(material, used)| used.then_some(*material)).collect()
}
