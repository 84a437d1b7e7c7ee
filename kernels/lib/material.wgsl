// Materials, and their images looked up by hand in one buffer of texels.
//
// Cost of a filtered lookup: 4 texels (4 B each) for each of 1 or 2 mip levels.

import lib/color;

struct Material {
    base_color: vec3f,
    /// 0: opaque.
    alpha_cutoff: f32,
    /// Radiance that leaves the front, W/(sr·m²).
    emission: vec3f,
    flags: u32,
    base_color_image: vec4u,
    emission_image: vec4u,
    metallic: f32,
    roughness: f32,
}

const MATERIAL_DOUBLE_SIDED: u32 = 1u;

const IMAGE_NEAREST: u32 = 16u;
const IMAGE_SRGB: u32 = 32u;

var<storage, read> materials: array<Material>;
/// RGBA8, red in the lowest byte; the mip levels of an image one after another, images one after another.
var<storage, read> texels: array<u32>;

/// A texel index brought into [0, size): mode 0 repeats, 1 clamps, 2 mirrors.
fn wrap_texel(index: i32, size: i32, mode: u32) -> i32 {
    if mode == 1u {
        return clamp(index, 0, size - 1);
    }
    let period = select(size, 2 * size, mode == 2u);
    let within = ((index % period) + period) % period;
    return select(within, period - 1 - within, within >= size);
}

fn texel_at(image: vec4u, offset: u32, size: vec2i, at: vec2i) -> vec4f {
    let x = wrap_texel(at.x, size.x, image.w & 3u);
    let y = wrap_texel(at.y, size.y, (image.w >> 2u) & 3u);
    let raw = unpack4x8unorm(texels[offset + u32(y * size.x + x)]);
    if (image.w & IMAGE_SRGB) != 0u {
        return vec4f(srgb_decode(raw.rgb), raw.a);
    }
    return raw;
}

/// One mip level at texture coordinates `uv`, bilinear; linear light.
fn image_level(image: vec4u, uv: vec2f, level: u32, nearest: bool) -> vec4f {
    var offset = image.x;
    var size = vec2i(image.yz);
    for (var i = 0u; i < level; i++) {
        offset += u32(size.x * size.y);
        size = max(size / 2, vec2i(1));
    }
    let at = uv * vec2f(size);
    if nearest {
        return texel_at(image, offset, size, vec2i(floor(at)));
    }
    let corner = floor(at - 0.5);
    let weight = at - 0.5 - corner;
    let low = vec2i(corner);
    let top = mix(
        texel_at(image, offset, size, low),
        texel_at(image, offset, size, low + vec2i(1, 0)),
        weight.x,
    );
    let bottom = mix(
        texel_at(image, offset, size, low + vec2i(0, 1)),
        texel_at(image, offset, size, low + vec2i(1, 1)),
        weight.x,
    );
    return mix(top, bottom, weight.y);
}

/// An image in linear light; `footprint` is the width in uv that one sample stands for. White where there is no image.
fn image_at(image: vec4u, uv: vec2f, footprint: f32) -> vec4f {
    if image.y == 0u {
        return vec4f(1.0);
    }
    let last = f32(max((image.w >> 8u) & 255u, 1u) - 1u);
    let width = footprint * sqrt(f32(image.y) * f32(image.z));
    let level = clamp(log2(max(width, 1e-6)), 0.0, last);
    let fine = u32(level);
    let part = level - f32(fine);
    let nearest = (image.w & IMAGE_NEAREST) != 0u && width < 1.0;
    let sharp = image_level(image, uv, fine, nearest);
    if part == 0.0 {
        return sharp;
    }
    return mix(sharp, image_level(image, uv, fine + 1u, false), part);
}

/// Albedo (rgb) and opacity (a).
fn base_color_at(material: u32, uv: vec2f, footprint: f32) -> vec4f {
    return vec4f(materials[material].base_color, 1.0) * image_at(materials[material].base_color_image, uv, footprint);
}

/// Radiance that leaves the front, W/(sr·m²).
fn emission_at(material: u32, uv: vec2f, footprint: f32) -> vec3f {
    let factor = materials[material].emission;
    if all(factor == vec3f(0.0)) {
        return vec3f(0.0);
    }
    return factor * image_at(materials[material].emission_image, uv, footprint).rgb;
}

/// Whether a masked material has a hole where its opacity is `alpha`.
fn is_hole(material: u32, alpha: f32) -> bool {
    return alpha < materials[material].alpha_cutoff;
}
