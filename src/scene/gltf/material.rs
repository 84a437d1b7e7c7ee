//! Materials, with their images where they are used.

use super::file::File;
use super::notes::{Fault, Notes};
use super::texture::Textures;
use crate::scene::layout::{DOUBLE_SIDED, Material, UNLIT};
use glam::{UVec4, Vec3};
use gltf::json::material::{AlphaMode, Material as Json};
use gltf::json::validation::Checked;

/// The material of primitives that name none: white, metallic and rough, as glTF says.
pub fn default() -> Material {
    Material {
        base_color: Vec3::ONE,
        alpha_cutoff: 0.0,
        emission: Vec3::ZERO,
        flags: 0,
        base_color_image: UVec4::ZERO,
        emission_image: UVec4::ZERO,
        metallic: 1.0,
        roughness: 1.0,
        pad: [0; 2],
    }
}

/// The material `json` without its images.
pub fn read(json: &Json, pointer: &str, notes: &mut Notes) -> Material {
    let surface = &json.pbr_metallic_roughness;
    let mut unit = |field: &str, value: f32| {
        if !(-1e-3..=1.001).contains(&value) {
            let fault = Fault::new("gltf-value", format!("{value} is not between 0 and 1"));
            notes.fault(format_args!("{pointer}/{field}"), fault);
        }
        value.clamp(0.0, 1.0)
    };
    let [r, g, b, alpha] =
        surface.base_color_factor.0.map(|value| unit("pbrMetallicRoughness/baseColorFactor", value));
    let metallic = unit("pbrMetallicRoughness/metallicFactor", surface.metallic_factor.0);
    let roughness = unit("pbrMetallicRoughness/roughnessFactor", surface.roughness_factor.0);
    let [er, eg, eb] = json.emissive_factor.0.map(|value| unit("emissiveFactor", value));
    let extensions = json.extensions.as_ref();
    let strength =
        extensions.and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
    if !(strength.is_finite() && strength >= 0.0) {
        let fault =
            Fault::new("gltf-value", format!("the emissive strength {strength} is negative or not finite"));
        notes.fault(format_args!("{pointer}/extensions/KHR_materials_emissive_strength"), fault);
    }
    if matches!(json.alpha_mode, Checked::Invalid) {
        notes.fault(format_args!("{pointer}/alphaMode"), Fault::new("gltf-value", "no such alpha mode"));
    }
    let unlit = extensions.is_some_and(|e| e.unlit.is_some());
    Material {
        base_color: Vec3::new(r, g, b),
        alpha_cutoff: alpha_cutoff(json, alpha),
        emission: Vec3::new(er, eg, eb) * strength,
        flags: if json.double_sided { DOUBLE_SIDED } else { 0 } | if unlit { UNLIT } else { 0 },
        metallic,
        roughness,
        ..default()
    }
}

/// What a texel's alpha must reach. The factor on alpha is the same for all texels, so it divides the cutoff instead;
/// a factor of 0 leaves nothing, which no texel's alpha can change.
fn alpha_cutoff(json: &Json, factor: f32) -> f32 {
    const OUT_OF_REACH: f32 = 2.0;
    match json.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => {
            let cutoff = json.alpha_cutoff.unwrap_or_default().0.clamp(0.0, OUT_OF_REACH);
            if cutoff == 0.0 { 0.0 } else { (cutoff / factor.max(f32::MIN_POSITIVE)).min(OUT_OF_REACH) }
        }
        _ => 0.0,
    }
}

/// The set of texture coordinates that the material needs, if any: that of its colour, or else of its emission.
pub fn uv_set(json: &Json) -> Option<u32> {
    let color = json.pbr_metallic_roughness.base_color_texture.as_ref();
    color.or(json.emissive_texture.as_ref()).map(|info| info.tex_coord)
}

/// Fills in the images, and notes what the material has that isn't drawn. For materials in use only.
pub fn finish(
    material: &mut Material,
    json: &Json,
    pointer: &str,
    file: &mut File,
    textures: &mut Textures,
    notes: &mut Notes,
) {
    let uv_set = uv_set(json);
    let surface = &json.pbr_metallic_roughness;
    let color = surface.base_color_texture.as_ref();
    let emission = json.emissive_texture.as_ref().filter(|_| material.emission != Vec3::ZERO);
    for (info, field, image) in [
        (color, "pbrMetallicRoughness/baseColorTexture", &mut material.base_color_image),
        (emission, "emissiveTexture", &mut material.emission_image),
    ] {
        let Some(info) = info else { continue };
        if Some(info.tex_coord) != uv_set {
            notes.lack("texture with coordinates of its own", "left out");
            continue;
        }
        if info.extensions.as_ref().is_some_and(|e| e.texture_transform.is_some()) {
            notes.lack("texture transform", "left out");
        }
        let reference = textures.reference(file, info.index, notes);
        let reference = notes.catch(format_args!("{pointer}/{field}"), reference).flatten();
        *image = reference.unwrap_or_default();
    }
    if matches!(json.alpha_mode, Checked::Valid(AlphaMode::Blend)) {
        notes.lack("translucent material", "rendered opaque");
    }
    let maps = [
        (json.normal_texture.is_some(), "normal map"),
        (surface.metallic_roughness_texture.is_some(), "metallic-roughness texture"),
        (json.occlusion_texture.is_some(), "occlusion texture"),
    ];
    for (_, what) in maps.iter().filter(|(there, _)| *there) {
        notes.lack(what, "left out");
    }
    for name in json.extensions.iter().flat_map(|e| e.others.keys()) {
        match name.as_str() {
            "KHR_materials_transmission" => notes.lack("transmissive material", "rendered opaque"),
            _ => notes.lack(&format!("use of {name}"), "left out"),
        }
    }
}
