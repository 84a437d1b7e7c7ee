// Small functions that are finite for every finite argument.

const PI: f32 = 3.14159265;

/// `v` scaled to length 1; `otherwise` where `v` is zero (or so short that its square is).
fn unit_or(v: vec3f, otherwise: vec3f) -> vec3f {
    let squared = dot(v, v);
    if squared > 1e-30 {
        return v * inverseSqrt(squared);
    }
    return otherwise;
}

/// The integer nearest to x (of two, the even one), for sizes up to 2^22: the sum's lowest bits are it. A conversion
/// would be checked for what no integer can hold, which made conversions the dearest steps of the voxelizers
/// (lavapipe).
fn nearest_integer(x: f32) -> i32 {
    return bitcast<i32>(x + 12582912.0) - 0x4b400000;
}

/// The same for each component.
fn nearest_integers(x: vec3f) -> vec3i {
    return bitcast<vec3i>(x + 12582912.0) - 0x4b400000;
}

/// Sum of the absolute components.
fn norm_1(v: vec3f) -> f32 {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

/// Largest absolute component.
fn norm_max(v: vec3f) -> f32 {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

/// A rotation whose second column is `n` (unit length): takes directions around y to directions around `n`.
/// Continuous except at n.z = 0 (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
fn frame_around(n: vec3f) -> mat3x3f {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    return mat3x3f(
        vec3f(1.0 + s * n.x * n.x * a, s * b, -s * n.x),
        n,
        vec3f(b, s + n.y * n.y * a, -n.y),
    );
}

/// Normals that turn away from the triangle's own side would light it from behind: then it is `otherwise`.
fn outward(normal: vec3f, face_normal: vec3f, otherwise: vec3f) -> vec3f {
    return select(otherwise, normal, dot(normal, face_normal) > 0.0);
}

/// The z of the cross product: twice the area between them, positive if `b` is counterclockwise of `a`.
fn cross_2(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}
