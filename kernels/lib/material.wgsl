// Materials, and their images looked up by hand in one buffer of texels.
//
// Texture coordinates come as both sets that a vertex has (xy, zw), footprints as the width in each set that one sample
// stands for. A texture transform stretches the footprint by the root of its determinant.
// Cost of a filtered lookup: 4 texels (4 B each) for each of 1 or 2 mip levels; a texture transform is 24 B.

import lib/color;
import lib/math;

struct Material {
    base_color: vec3f,
    /// 0: opaque.
    alpha_cutoff: f32,
    /// Radiance that leaves the front, W/(sr·m²).
    emission: vec3f,
    flags: u32,
    base_color_image: vec4u,
    emission_image: vec4u,
    /// Normals in the space of tangent, bitangent and normal.
    normal_image: vec4u,
    /// Green: roughness, blue: metalness.
    roughness_image: vec4u,
    base_color_uv: mat3x2f,
    emission_uv: mat3x2f,
    normal_uv: mat3x2f,
    roughness_uv: mat3x2f,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
}

const MATERIAL_DOUBLE_SIDED: u32 = 1u;

const IMAGE_NEAREST: u32 = 16u;
const IMAGE_SRGB: u32 = 32u;
const IMAGE_SECOND_UV: u32 = 64u;
const IMAGE_TRANSFORMED: u32 = 128u;

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
    // Coordinates so far away have lost their fraction; beyond, they would overflow.
    let at = clamp(uv, vec2f(-1048576.0), vec2f(1048576.0)) * vec2f(size);
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

/// The footprint of a pixel, its longer side, from how its coordinates change to the right and downwards.
fn footprint_of(x: vec4f, y: vec4f) -> vec2f {
    return vec2f(max(length(x.xy), length(y.xy)), max(length(x.zw), length(y.zw)));
}

/// xy: the set of texture coordinates that the image uses; z: its footprint.
fn image_place(image: vec4u, uv: vec4f, footprint: vec2f) -> vec3f {
    @if(scene.second_uv) {
        if (image.w & IMAGE_SECOND_UV) != 0u {
            return vec3f(uv.zw, footprint.y);
        }
    }
    return vec3f(uv.xy, footprint.x);
}

fn transformed_place(place: vec3f, transform: mat3x2f) -> vec3f {
    let stretch = sqrt(abs(determinant(mat2x2f(transform[0], transform[1]))));
    return vec3f(transform * vec3f(place.xy, 1.0), place.z * stretch);
}

/// Albedo (rgb) and opacity (a).
fn base_color_at(material: u32, uv: vec4f, footprint: vec2f) -> vec4f {
    var color = vec4f(materials[material].base_color, 1.0);
    @if(scene.textured) {
        let image = materials[material].base_color_image;
        var place = image_place(image, uv, footprint);
        if (image.w & IMAGE_TRANSFORMED) != 0u {
            place = transformed_place(place, materials[material].base_color_uv);
        }
        color *= image_at(image, place.xy, place.z);
    }
    return color;
}

/// Radiance that leaves the front, W/(sr·m²).
fn emission_at(material: u32, uv: vec4f, footprint: vec2f) -> vec3f {
    var emission = materials[material].emission;
    @if(scene.textured) {
        if any(emission != vec3f(0.0)) {
            let image = materials[material].emission_image;
            var place = image_place(image, uv, footprint);
            if (image.w & IMAGE_TRANSFORMED) != 0u {
                place = transformed_place(place, materials[material].emission_uv);
            }
            emission *= image_at(image, place.xy, place.z).rgb;
        }
    }
    return emission;
}

/// Metalness (x) and roughness (y).
fn metallic_roughness_at(material: u32, uv: vec4f, footprint: vec2f) -> vec2f {
    var gloss = vec2f(materials[material].metallic, materials[material].roughness);
    @if(scene.roughness_textured) {
        let image = materials[material].roughness_image;
        var place = image_place(image, uv, footprint);
        if (image.w & IMAGE_TRANSFORMED) != 0u {
            place = transformed_place(place, materials[material].roughness_uv);
        }
        gloss *= image_at(image, place.xy, place.z).bg;
    }
    return gloss;
}

/// Mean normal within the footprint, along tangent, bitangent and normal: the shorter, the more the surface's normals
/// differ there. (0, 0, 1) where there is no map.
fn normal_map_at(material: u32, uv: vec4f, footprint: vec2f) -> vec3f {
    let image = materials[material].normal_image;
    if image.y == 0u {
        return vec3f(0.0, 0.0, 1.0);
    }
    var place = image_place(image, uv, footprint);
    if (image.w & IMAGE_TRANSFORMED) != 0u {
        place = transformed_place(place, materials[material].normal_uv);
    }
    let map = 2.0 * image_at(image, place.xy, place.z).rgb - 1.0;
    return vec3f(map.xy * materials[material].normal_scale, map.z);
}

/// A unit vector: `map`, as `normal_map_at` gives it, turned to the world. As MikkTSpace has it, `normal` and `tangent`
/// are those of the corners, interpolated and not normalised; where the tangent is zero there is no map.
fn mapped_normal(map: vec3f, normal: vec3f, tangent: vec4f) -> vec3f {
    let plain = unit_or(normal, vec3f(0.0));
    if dot(tangent.xyz, tangent.xyz) < 1e-12 {
        return plain;
    }
    let bitangent = sign(tangent.w) * cross(normal, tangent.xyz);
    return unit_or(map.x * tangent.xyz + map.y * bitangent + map.z * normal, plain);
}

/// Whether a masked material has a hole where its opacity is `alpha`.
fn is_hole(material: u32, alpha: f32) -> bool {
    return alpha < materials[material].alpha_cutoff;
}
