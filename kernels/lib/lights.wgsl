// Light that arrives from the scene's point, spot and directional lights, and whether a light map lets it through.
//
// Irradiance is that of a surface facing the light, W/m²: I/r² for point and spot lights (I in W/sr), the light's own
// for directional ones. Spot cones: KHR_lights_punctual's formula; `range` is ignored.
// Cost: a light 64 B; a look into its map a view (112 B) and 4 depth texels, filtered by the comparing sampler.

import lib/spot;

struct Light {
    position: vec3f,
    kind: u32,
    /// Of travel.
    direction: vec3f,
    first_view: u32,
    intensity: vec3f,
    cos_outer: f32,
    cos_inner: f32,
    view_count: u32,
}

const LIGHT_SPOT: u32 = 1u;
const LIGHT_DIRECTIONAL: u32 = 2u;

struct View {
    view_projection: mat4x4f,
    position: vec3f,
    light: u32,
    direction: vec3f,
    face: u32,
    near: f32,
    far: f32,
    /// Width that the map covers at unit distance; of a directional light, at any.
    texel: f32,
}

struct Lighting {
    total: u32,
}

var<uniform> lighting: Lighting;
var<storage, read> lights: array<Light>;
var<storage, read> views: array<View>;
/// A layer for each view; reversed depth: 1 at the near plane, 0 where there is nothing.
var light_depth: texture_depth_2d_array;
/// Linear, passes where the reference is greater or equal: nearer to the light than what the map holds.
var light_sampler: sampler_comparison;

/// What a light sends to a point.
struct Arrival {
    /// Unit vector.
    to_light: vec3f,
    irradiance: vec3f,
}

fn arrival(light: Light, position: vec3f) -> Arrival {
    if light.kind == LIGHT_DIRECTIONAL {
        return Arrival(-light.direction, light.intensity);
    }
    let d = light.position - position;
    // Finite at the light itself, where no direction is right.
    let squared_distance = max(dot(d, d), 1e-12);
    let to_light = d * inverseSqrt(squared_distance);
    var falloff = 1.0 / squared_distance;
    if light.kind == LIGHT_SPOT {
        falloff *= spot_share(dot(-to_light, light.direction), light.cos_outer, light.cos_inner);
    }
    return Arrival(to_light, light.intensity * falloff);
}

/// Which face of a cube a direction goes through: +x, -x, +y, -y, +z, -z.
fn cube_face(d: vec3f) -> u32 {
    let size = abs(d);
    if size.x >= size.y && size.x >= size.z {
        return select(1u, 0u, d.x >= 0.0);
    }
    if size.y >= size.z {
        return select(3u, 2u, d.y >= 0.0);
    }
    return select(5u, 4u, d.z >= 0.0);
}

fn view_of(light: Light, position: vec3f) -> u32 {
    if light.view_count == 6u {
        return light.first_view + cube_face(position - light.position);
    }
    return light.first_view;
}

/// Share of the light, 0 to 1, that reaches a point of a surface with unit normal `n` (either side).
///
/// The map holds depths at the centres of its texels and blends four of them, each up to L = √2 texels aside. Seen at
/// angle α from its normal, a plane's depth there is L tan α off; moving the point by m along the normal, to the
/// light's side, gains m / cos α, so that m ≥ L sin α clears it: 1.5 texels do at any angle. `slack` (metres) is what
/// the caller knows its point to be off; it moves the point towards the light.
fn visibility(light: Light, arrival_: Arrival, position: vec3f, n: vec3f, slack: f32) -> f32 {
    let number = view_of(light, position);
    let size = f32(textureDimensions(light_depth).x);
    let depth = dot(position - views[number].position, views[number].direction);
    let distance = select(max(depth, 0.0), 1.0, light.kind == LIGHT_DIRECTIONAL);
    let texel = views[number].texel / size * distance;
    let side = select(-1.0, 1.0, dot(n, arrival_.to_light) >= 0.0);
    let moved = position + n * (side * 1.5 * texel) + arrival_.to_light * (slack + 0.01 * texel);
    let clip = views[number].view_projection * vec4f(moved, 1.0);
    if clip.w <= 0.0 {
        return 1.0;
    }
    let ndc = clip.xyz / clip.w;
    let uv = vec2f(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y);
    return textureSampleCompareLevel(light_depth, light_sampler, uv, i32(number), clamp(ndc.z, 0.0, 1.0));
}
