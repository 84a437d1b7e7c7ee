//! Materials, with their images where they are used.

use super::file::File;
use super::lookup::{IDENTITY, Lookup, Needs, Slot, lookups};
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
        normal_image: UVec4::ZERO,
        roughness_image: UVec4::ZERO,
        base_color_uv: IDENTITY,
        emission_uv: IDENTITY,
        normal_uv: IDENTITY,
        roughness_uv: IDENTITY,
        metallic: 1.0,
        roughness: 1.0,
        normal_scale: 1.0,
        pad: 0,
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
    let normal_scale = json.normal_texture.as_ref().map_or(1.0, |info| info.scale);
    if !normal_scale.is_finite() {
        let fault = Fault::new("gltf-value", "the scale is not finite");
        notes.fault(format_args!("{pointer}/normalTexture/scale"), fault);
    }
    if matches!(json.alpha_mode, Checked::Invalid) {
        notes.fault(format_args!("{pointer}/alphaMode"), Fault::new("gltf-value", "no such alpha mode"));
    }
    Material {
        base_color: Vec3::new(r, g, b),
        alpha_cutoff: alpha_cutoff(json, alpha),
        emission: Vec3::new(er, eg, eb) * strength,
        flags: if json.double_sided { DOUBLE_SIDED } else { 0 } | if is_unlit(json) { UNLIT } else { 0 },
        metallic,
        roughness,
        normal_scale,
        ..default()
    }
}

fn is_unlit(json: &Json) -> bool {
    json.extensions.as_ref().is_some_and(|e| e.unlit.is_some())
}

/// An unlit surface has its colour whatever the light and from wherever it is seen: it emits that colour on both sides,
/// and reflects nothing.
fn glow(material: &mut Material) {
    material.emission = std::mem::replace(&mut material.base_color, Vec3::ZERO);
    (material.emission_image, material.emission_uv) = (material.base_color_image, material.base_color_uv);
    material.flags |= DOUBLE_SIDED;
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

/// Fills in the images, and notes what the material has that isn't drawn. For materials in use only.
pub fn finish(
    material: &mut Material,
    json: &Json,
    pointer: &str,
    file: &mut File,
    textures: &mut Textures,
    notes: &mut Notes,
) {
    let lookups = lookups(json);
    let needs = Needs::of(&lookups);
    for Lookup { slot, texture, set, transform } in lookups {
        let pointer = format!("{pointer}/{}", slot.pointer());
        let Some(place) = needs.place(set) else {
            notes.lack("texture with a third set of coordinates in one material", "left out");
            continue;
        };
        let Some(transform) = notes.catch(&pointer, transform) else { continue };
        let found = textures.request(file, texture, slot.coding(), &pointer, notes);
        let Some((image, mut sampling)) = notes.catch(&pointer, found).flatten() else { continue };
        (sampling.second_uv, sampling.transformed) = (place == 1, transform.is_some());
        let (reference, uv) = match slot {
            Slot::BaseColor => (&mut material.base_color_image, &mut material.base_color_uv),
            Slot::Emission => (&mut material.emission_image, &mut material.emission_uv),
            Slot::Normal => (&mut material.normal_image, &mut material.normal_uv),
            Slot::Roughness => (&mut material.roughness_image, &mut material.roughness_uv),
        };
        *reference = textures.images[image].reference(sampling);
        *uv = transform.unwrap_or(IDENTITY);
    }
    if is_unlit(json) {
        glow(material);
    }
    if matches!(json.alpha_mode, Checked::Valid(AlphaMode::Blend)) {
        notes.lack("translucent material", "rendered opaque");
    }
    if json.occlusion_texture.is_some() {
        notes.lack("occlusion texture", "not applied: occlusion is simulated");
    }
    for name in json.extensions.iter().flat_map(|e| e.others.keys()) {
        match name.as_str() {
            "KHR_materials_transmission" => notes.lack("transmissive material", "rendered opaque"),
            _ => notes.lack(&format!("use of {name}"), "left out"),
        }
    }
}
