// Where rays leave a surface, so that they do not meet it again.

import lib/math;

/// A point from which rays leave a surface on the side of `normal`, unit length: moved by `slack`, see `slack_of`.
fn leaving(position: vec3f, normal: vec3f, slack: f32) -> vec3f {
    return position + normal * slack;
}

/// For points of a triangle, metres: a bound of their rounding errors, as a sum of products of corners and weights has them
/// (Pharr, Jakob, Humphreys, "Physically Based Rendering", 6.8), with the room that intersections need (Wächter and
/// Binder 2019: 256 units in the last place).
fn slack_of(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    return max(norm_max(a), max(norm_max(b), norm_max(c))) * 1.5258789e-5;
}
