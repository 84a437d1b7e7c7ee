// Light from infinitely far away, by direction: a picture of all directions with mip levels, looked up by hand.
//
// Columns go around the vertical axis, the middle one along -z and from there towards +x; rows go from +y down to -y.
// Cost of a lookup: 8 texels of 16 B.

struct EnvironmentFacts {
    environment_width: u32,
    environment_height: u32,
    environment_levels: u32,
    /// Where the elements of the rows begin; see `lib/environment_choice`.
    environment_rows: u32,
    /// Radians.
    environment_turn: f32,
}

var<uniform> scene: EnvironmentFacts;
/// The levels one after another, then an element for each row.
var<storage, read> environment: array<vec4f>;

fn environment_level(at: vec2f, level: u32) -> vec3f {
    var offset = 0u;
    var size = vec2u(scene.environment_width, scene.environment_height);
    for (var i = 0u; i < level; i++) {
        offset += size.x * size.y;
        size = max(size / 2u, vec2u(1u));
    }
    let place = at * vec2f(size) - 0.5;
    let low = floor(place);
    let weight = place - low;
    let columns = (vec2i(i32(low.x)) + vec2i(0, 1) + i32(size.x)) % i32(size.x);
    let rows = clamp(vec2i(i32(low.y)) + vec2i(0, 1), vec2i(0), vec2i(i32(size.y) - 1)) * i32(size.x);
    let top = mix(environment[offset + u32(rows.x + columns.x)], environment[offset + u32(rows.x + columns.y)], weight.x);
    let low_row =
        mix(environment[offset + u32(rows.y + columns.x)], environment[offset + u32(rows.y + columns.y)], weight.x);
    return mix(top, low_row, weight.y).rgb;
}

/// Where a direction is in the picture: columns and rows from 0 to 1.
fn environment_point(direction: vec3f) -> vec2f {
    // Straight up and down there is no angle, and what atan2 gives is not defined.
    let upright = abs(direction.x) + abs(direction.z) < 1e-12;
    let around = atan2(select(direction.x, 0.0, upright), select(-direction.z, 1.0, upright)) - scene.environment_turn;
    // On lavapipe acos is off by up to 1.6e-4, atan2 by 4e-6.
    let down = atan2(select(length(direction.xz), 0.0, upright), direction.y);
    return vec2f(fract(around / 6.2831853 + 0.5), down / 3.1415927);
}

/// Mean radiance that comes from around the unit vector `direction`, over `width` radians; W/(sr·m²).
fn environment_at(direction: vec3f, width: f32) -> vec3f {
    let at = environment_point(direction);
    let texel = 3.1415927 / f32(scene.environment_height);
    let level = clamp(log2(max(width / texel, 1e-6)), 0.0, f32(scene.environment_levels - 1u));
    let fine = u32(level);
    let part = level - f32(fine);
    let sharp = environment_level(at, fine);
    if part == 0.0 {
        return sharp;
    }
    return mix(sharp, environment_level(at, fine + 1u), part);
}
