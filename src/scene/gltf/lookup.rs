//! How a material looks up its textures, and what its vertices must have for it.

use super::notes::Fault;
use super::texture::Coding;
use glam::Vec2;
use gltf::json::Index;
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::material::Material;
use gltf::json::texture::{Info, Texture};

/// What a material has an image for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    BaseColor,
    Emission,
    Normal,
    Roughness,
}

impl Slot {
    /// Of the texture, within the material.
    pub fn pointer(self) -> &'static str {
        match self {
            Slot::BaseColor => "pbrMetallicRoughness/baseColorTexture",
            Slot::Emission => "emissiveTexture",
            Slot::Normal => "normalTexture",
            Slot::Roughness => "pbrMetallicRoughness/metallicRoughnessTexture",
        }
    }

    pub fn coding(self) -> Coding {
        match self {
            Slot::BaseColor | Slot::Emission => Coding::Srgb,
            Slot::Normal | Slot::Roughness => Coding::Linear,
        }
    }
}

/// Columns of a `mat3x2f` for (u, v, 1).
pub type Transform = [Vec2; 3];

pub const IDENTITY: Transform = [Vec2::X, Vec2::Y, Vec2::ZERO];

/// One texture of a material.
pub struct Lookup {
    pub slot: Slot,
    pub texture: Index<Texture>,
    /// Which of the file's sets of texture coordinates it uses.
    pub set: u32,
    /// `None` where it would change nothing.
    pub transform: Result<Option<Transform>, Fault>,
}

/// The textures that have an effect.
pub fn lookups(material: &Material) -> Vec<Lookup> {
    let surface = &material.pbr_metallic_roughness;
    let emits = material.emissive_factor.0.iter().any(|factor| *factor != 0.0);
    let plain = |slot, info: &Info| {
        let extension = info.extensions.as_ref().and_then(|e| e.texture_transform.clone());
        lookup(slot, info.index, info.tex_coord, Ok(extension))
    };
    let normal = material.normal_texture.as_ref().map(|info| {
        let extension = info.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
        let extension = extension.map(|value| serde_json::from_value(value.clone())).transpose();
        let extension = extension
            .map_err(|error| Fault::new("gltf-value", format!("the texture transform is wrong: {error}")));
        lookup(Slot::Normal, info.index, info.tex_coord, extension)
    });
    let color = surface.base_color_texture.as_ref().map(|info| plain(Slot::BaseColor, info));
    let emission =
        material.emissive_texture.as_ref().filter(|_| emits).map(|info| plain(Slot::Emission, info));
    let roughness = surface.metallic_roughness_texture.as_ref().map(|info| plain(Slot::Roughness, info));
    [color, emission, normal, roughness].into_iter().flatten().collect()
}

fn lookup(
    slot: Slot,
    texture: Index<Texture>,
    set: u32,
    extension: Result<Option<TextureTransform>, Fault>,
) -> Lookup {
    match extension {
        Ok(None) => Lookup { slot, texture, set, transform: Ok(None) },
        Ok(Some(extension)) => {
            let set = extension.tex_coord.unwrap_or(set);
            Lookup { slot, texture, set, transform: transform(&extension) }
        }
        Err(fault) => Lookup { slot, texture, set, transform: Err(fault) },
    }
}

/// Scaled, then turned, then moved; the turn is counter-clockwise on the image, whose v points down.
fn transform(extension: &TextureTransform) -> Result<Option<Transform>, Fault> {
    let [offset, scale] = [extension.offset.0, extension.scale.0].map(Vec2::from);
    let (sin, cos) = extension.rotation.0.sin_cos();
    let transform = [Vec2::new(cos, -sin) * scale.x, Vec2::new(sin, cos) * scale.y, offset];
    if !transform.iter().all(|column| column.is_finite()) {
        return Err(Fault::new("gltf-value", "the texture transform is not finite"));
    }
    Ok(Some(transform).filter(|transform| *transform != IDENTITY))
}

/// What a material takes from its vertices.
#[derive(Clone, Debug, Default)]
pub struct Needs {
    /// The file's sets of texture coordinates that become the vertices' first and second.
    pub sets: [Option<u32>; 2],
    pub normal_map: Option<NormalMap>,
}

/// The coordinates that tangents follow.
#[derive(Clone, Copy, Debug)]
pub struct NormalMap {
    /// 0 or 1: the vertices' first or second texture coordinates.
    pub place: usize,
    pub transform: Transform,
}

impl Needs {
    pub fn of(lookups: &[Lookup]) -> Self {
        let mut all: Vec<u32> = lookups.iter().map(|lookup| lookup.set).collect();
        all.sort_unstable();
        all.dedup();
        let mut needs = Self { sets: [0, 1].map(|place| all.get(place).copied()), normal_map: None };
        let normal = lookups.iter().find(|lookup| lookup.slot == Slot::Normal);
        needs.normal_map = normal.and_then(|lookup| {
            let transform = lookup.transform.as_ref().ok()?.unwrap_or(IDENTITY);
            Some(NormalMap { place: needs.place(lookup.set)?, transform })
        });
        needs
    }

    /// Where vertices have the file's set: 0 or 1, or nowhere.
    pub fn place(&self, set: u32) -> Option<usize> {
        self.sets.iter().position(|held| *held == Some(set))
    }
}
