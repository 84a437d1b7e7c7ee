//! Features: what conditions of a pipeline can ask about a scene, as numbers, flags and vectors.
//!
//! [`NAMES`] says what there is without a scene at hand; [`features`] gives the values, in the same order. [`SLOW`] and
//! [`slow`] are the same for what takes long.

use super::Scene;
use super::environment::Environment;
use super::image::{Image, SECOND_UV};
use super::layout::{DIRECTIONAL, DOUBLE_SIDED, Material, POINT, SPOT, VertexExtra};
use glam::{UVec4, Vec3};

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
    "scene.center" Vector "Centre of that box, in metres." = scene.bounds.center().to_array();
    "scene.emissive" Flag "Some triangle gives off light." = used.iter().any(|m| m.emission != Vec3::ZERO);
    "scene.max_emission" Number "Greatest emission of a triangle's material in a colour, W/(sr·m²); 0 without."
        = used.iter().fold(0.0, |greatest, m| f64::from(m.emission.max_element()).max(greatest));
    "scene.textured" Flag "Some triangle has an image for its colour or its emission."
        = used.iter().any(|m| m.base_color_image.y > 0 || m.emission_image.y > 0);
    "scene.roughness_textured" Flag "Some triangle has an image for its metalness and roughness."
        = used.iter().any(|m| m.roughness_image.y > 0);
    "scene.normal_mapped" Flag "Some triangle has an image for its normals." = normal_mapped(used);
    "scene.second_uv" Flag "Some image is looked up by a second set of texture coordinates." = second_uv(used);
    "scene.vertex_colors" Flag "Some vertex has a colour other than white." = vertex_colors(scene);
    "scene.vertex_extras" Flag "Some vertex has a normal map's tangent, a second set of texture coordinates, or a colour."
        = normal_mapped(used) || second_uv(used) || vertex_colors(scene);
    "scene.masked" Flag "Some triangle has holes where its alpha is low."
        = used.iter().any(|m| m.alpha_cutoff > 0.0);
    "scene.double_sided" Flag "Some triangle has a double-sided material."
        = used.iter().any(|m| m.flags & DOUBLE_SIDED != 0);
    "scene.min_roughness" Number "Least roughness of a triangle's material, images included; 1 without triangles."
        = used.iter().fold(1.0, |least, m| {
            f64::from(m.roughness * range(scene, m.roughness_image, ROUGHNESS)[0]).min(least)
        });
    "scene.max_metallic" Number "Greatest metalness of a triangle's material, images included; 0 without triangles."
        = used.iter().fold(0.0, |greatest, m| {
            f64::from(m.metallic * range(scene, m.roughness_image, METALNESS)[1]).max(greatest)
        });
    "scene.moving" Flag "Some triangle moves, at some time." = scene.still_triangles < scene.triangles.len();
    "scene.duration" Number "Seconds until the scene's longest motion starts again; 0 without any."
        = scene.motion.duration();
    "lights.point" Number "Number of point lights." = lights(scene, POINT);
    "lights.spot" Number "Number of spot lights." = lights(scene, SPOT);
    "lights.directional" Number "Number of directional lights." = lights(scene, DIRECTIONAL);
    "lights.total" Number "Number of lights, not counting emissive triangles." = scene.lights.len() as f64;
    "views.total" Number "Number of views: six for each point light, one for each other light."
        = scene.views.len() as f64;
    "scene.environment" Flag "Light comes from far away." = scene.environment.is_some();
    "scene.environment_width" Number "Columns of the environment's picture; 0 without." = environment(scene, |e| e.width.into());
    "scene.environment_height" Number "Rows of the environment's picture; 0 without."
        = environment(scene, |e| e.height.into());
    "scene.environment_levels" Number "Mip levels of the environment's picture; 0 without."
        = environment(scene, |e| e.levels.into());
    "scene.environment_rows" Number "Index of the element of the environment's first row; see the buffer `environment`."
        = environment(scene, |e| e.first_row() as f64);
    "scene.environment_turn" Number "Radians by which the environment is turned about the vertical axis."
        = environment(scene, |e| e.turn.into());
    "cameras.total" Number "Number of cameras." = scene.cameras.len() as f64;
}

/// Features that take long to find out: what a pipeline is told only if one of its files has the name.
pub const SLOW: &[FeatureName] = &[
    FeatureName {
        name: "scene.atlas_extent",
        kind: FeatureKind::Number,
        meaning: "Side of the square in which the buffer `atlas` lays out all surfaces, in metres.",
    },
    FeatureName {
        name: "scene.atlas_lost",
        kind: FeatureKind::Number,
        meaning: "Number of triangles without area, which have no place there.",
    },
];

/// All features of `scene` that take long, in the order of [`SLOW`].
pub fn slow(scene: &Scene) -> Vec<(&'static str, Feature)> {
    let atlas = scene.atlas();
    let values = [atlas.extent, atlas.lost as f64].map(Feature::Number);
    SLOW.iter().map(|feature| feature.name).zip(values).collect()
}

/// Of an effect: its flag, and what conditions are told besides of a scene that has it, and of one that has not.
type Effect = (&'static str, &'static [(&'static str, Feature)], &'static [(&'static str, Feature)]);

const EFFECTS: &[Effect] = &[
    (
        "scene.emissive",
        &[("scene.max_emission", Feature::Number(1.0))],
        &[("scene.max_emission", Feature::Number(0.0))],
    ),
    ("scene.textured", &[], &[]),
    ("scene.roughness_textured", &[], &[]),
    ("scene.normal_mapped", &[("scene.vertex_extras", Feature::Flag(true))], &[]),
    ("scene.second_uv", &[("scene.vertex_extras", Feature::Flag(true))], &[]),
    ("scene.vertex_colors", &[("scene.vertex_extras", Feature::Flag(true))], &[]),
    ("scene.masked", &[], &[]),
    ("scene.moving", &[], &[]),
    (
        "scene.environment",
        &[
            ("scene.environment_width", Feature::Number(1.0)),
            ("scene.environment_height", Feature::Number(1.0)),
            ("scene.environment_levels", Feature::Number(1.0)),
        ],
        &[
            ("scene.environment_width", Feature::Number(0.0)),
            ("scene.environment_height", Feature::Number(0.0)),
            ("scene.environment_levels", Feature::Number(0.0)),
        ],
    ),
];

/// The flags of all effects.
pub fn effects() -> impl Iterator<Item = &'static str> {
    EFFECTS.iter().map(|(name, ..)| *name)
}

/// What conditions are told to leave the effect `name` out. `None` if `scene` has nothing of it, or there is none.
pub fn without(scene: &Scene, name: &str) -> Option<Vec<(&'static str, Feature)>> {
    let (name, _, others) = EFFECTS.iter().find(|(known, ..)| *known == name)?;
    let present = features(scene).contains(&(*name, Feature::Flag(true)));
    present.then(|| [(*name, Feature::Flag(false))].iter().chain(*others).copied().collect())
}

/// For each effect that `scene` has nothing of, its flag's name and the features of a scene that has some.
pub fn missing_effects(scene: &Scene) -> Vec<(&'static str, Vec<(&'static str, Feature)>)> {
    let features = features(scene);
    let missing = EFFECTS.iter().filter(|(name, ..)| features.contains(&(*name, Feature::Flag(false))));
    missing
        .map(|(name, others, _)| {
            (*name, [(*name, Feature::Flag(true))].iter().chain(*others).copied().collect())
        })
        .collect()
}

fn environment(scene: &Scene, of: impl Fn(&Environment) -> f64) -> f64 {
    scene.environment.as_ref().map_or(0.0, of)
}

fn vector(v: Vec3) -> [f64; 3] {
    v.as_dvec3().to_array()
}

/// Channels of an image of metalness and roughness.
const ROUGHNESS: usize = 1;
const METALNESS: usize = 2;

/// Least and greatest value in a channel of the image; 1 where there is no image.
fn range(scene: &Scene, reference: UVec4, channel: usize) -> [f32; 2] {
    let referred = |image: &&Image| reference.y > 0 && image.offset == reference.x;
    let image = scene.images.iter().find(referred);
    image.map_or([1.0; 2], |image| {
        [image.least, image.greatest].map(|texel| f32::from(texel[channel]) / 255.0)
    })
}

fn normal_mapped(used: &[Material]) -> bool {
    used.iter().any(|m| m.normal_image.y > 0)
}

fn second_uv(used: &[Material]) -> bool {
    let images = |m: &Material| [m.base_color_image, m.emission_image, m.normal_image, m.roughness_image];
    used.iter().flat_map(images).any(|image| image.y > 0 && image.w & SECOND_UV != 0)
}

fn vertex_colors(scene: &Scene) -> bool {
    scene.vertex_extras.iter().any(|extra| extra.color != VertexExtra::NONE.color)
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
