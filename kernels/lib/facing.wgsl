// How a triangle lies: its normal's signs, and the axis that it is nearest to. Single floats decide where they can be
// sure; where not, integers do (lib/wide).

import lib/math;
import lib/units;
import lib/wide;

/// Bounds what single floats lose in the tests here and in lib/overlap, in parts of the sizes of the terms: 16
/// roundings.
const DOUBT: f32 = 1.9073486e-6;
/// Differences of units up to this are whole single floats.
const MOST_EXACT: f32 = 16777216.0;

fn difference_of_products(a: i32, b: i32, c: i32, d: i32) -> vec2u {
    return sum_64(product_64(a, b), negative_64(product_64(c, d)));
}

/// Of the triangle's plane: the product of two edges, in units².
fn normal_of(p: array<vec3i, 3>) -> array<vec2u, 3> {
    let u = p[1] - p[0];
    let v = p[2] - p[1];
    return array(
        difference_of_products(u.y, v.z, u.z, v.y),
        difference_of_products(u.z, v.x, u.x, v.z),
        difference_of_products(u.x, v.y, u.y, v.x),
    );
}

struct Facing {
    /// Signs of the normal's components; zero for a triangle without area.
    signs: vec3i,
    /// The normal over its largest component's size, to the nearest 2^-19 or so.
    normal: vec3f,
    /// 0, 1, 2: the axis of the normal's largest component; of equal ones z, then x. Without area, the one along which
    /// the triangle is shortest.
    axis: u32,
}

/// The first of z, x, y whose value is largest.
fn largest_axis(v: vec3f) -> u32 {
    return select(select(1u, 0u, v.x >= v.y), 2u, v.z >= v.x && v.z >= v.y);
}

fn facing_of(p: array<vec3i, 3>) -> Facing {
    let u = vec3f(p[1] - p[0]);
    let v = vec3f(p[2] - p[1]);
    let one = u.yzx * v.zxy;
    let other = u.zxy * v.yzx;
    let n = one - other;
    let doubt = 0.125 * DOUBT * (abs(one) + abs(other));
    let size = abs(n);
    let axis = largest_axis(size);
    let whole = max(norm_max(u), norm_max(v)) < MOST_EXACT;
    // Zero is sure where both products are.
    let signs = all((size > doubt) | (doubt == vec3f(0.0)));
    let behind = select(size + doubt + doubt[axis], vec3f(0.0), vec3u(0u, 1u, 2u) == vec3u(axis));
    if whole && signs && all(behind < vec3f(size[axis])) && norm_max(doubt) < DOUBT * size[axis] {
        return Facing(vec3i(sign(n)), n / size[axis], axis);
    }
    return exact_facing_of(p);
}

/// The same in integers, for slivers and ties.
fn exact_facing_of(p: array<vec3i, 3>) -> Facing {
    let n = normal_of(p);
    let signs = vec3i(sign_64(n[0]), sign_64(n[1]), sign_64(n[2]));
    if all(signs == vec3i(0)) {
        let size = max(p[0], max(p[1], p[2])) - min(p[0], min(p[1], p[2]));
        return Facing(signs, vec3f(0.0), largest_axis(-vec3f(size)));
    }
    let x = absolute_64(n[0]);
    let y = absolute_64(n[1]);
    let z = absolute_64(n[2]);
    let z_leads = !less_64(z, x) && !less_64(z, y);
    let axis = select(select(1u, 0u, !less_64(x, y)), 2u, z_leads);
    return Facing(signs, vec3f(float_64(n[0]), float_64(n[1]), float_64(n[2])) / abs(float_64(n[axis])), axis);
}

/// R eq. 4.1, so that `axis` becomes z: for x yzx, for y zxy.
fn turn(p: vec3i, axis: u32) -> vec3i {
    return select(select(p, p.zxy, axis == 1u), p.yzx, axis == 0u);
}

/// Inverse of `turn`.
fn turn_back(p: vec3i, axis: u32) -> vec3i {
    return select(select(p, p.yzx, axis == 1u), p.zxy, axis == 0u);
}

fn turned(facing: Facing, axis: u32) -> Facing {
    let n = facing.normal;
    let normal = select(select(n, n.zxy, axis == 1u), n.yzx, axis == 0u);
    return Facing(turn(facing.signs, axis), normal, (facing.axis + 5u - axis) % 3u);
}
