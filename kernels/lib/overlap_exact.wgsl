// Whether a triangle fills a voxel, in integers: the last word where single floats are not sure (lib/overlap).

import lib/facing;
import lib/units;
import lib/wide;

/// A triangle whose voxels are asked for; corners and voxels are relative to some voxel.
struct Asked {
    /// Of a triangle without area: its ends, the second one twice.
    corners: array<vec3i, 3>,
    /// Signs of the normal; all 1 for a triangle without area.
    signs: vec3i,
    /// 1 along the axis of the normal's largest component, else 0.
    lead: vec3i,
    thin: bool,
    /// Without area.
    flat: bool,
}

fn longest_side(v: vec3i) -> i32 {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

/// Ends of what has no area: the corners that are farthest apart; the second one twice.
fn ends_of(p: array<vec3i, 3>) -> array<vec3i, 3> {
    var begin = p[0];
    var end = p[1];
    if longest_side(p[2] - p[1]) > longest_side(end - begin) {
        begin = p[1];
        end = p[2];
    }
    if longest_side(p[0] - p[2]) > longest_side(end - begin) {
        begin = p[2];
        end = p[0];
    }
    return array(begin, end, end);
}

fn asked_of(corners: array<vec3i, 3>, facing: Facing, thin: bool) -> Asked {
    let lead = vec3i(vec3u(0u, 1u, 2u) == vec3u(facing.axis));
    if all(facing.signs == vec3i(0)) {
        return Asked(ends_of(corners), vec3i(1), lead, false, true);
    }
    return Asked(corners, facing.signs, lead, thin, false);
}

/// One edge's test for a voxel of a projection, in integers.
fn exactly_inside(begin: vec2i, end: vec2i, facing: i32, thin: bool, voxel: vec2i) -> bool {
    let a = -facing * (end.y - begin.y);
    let b = facing * (end.x - begin.x);
    let reach = select(0, UNITS / 2, thin);
    let base = voxel * UNITS + reach - begin;
    var value = sum_64(product_64(a, base.x), product_64(b, base.y));
    if thin {
        value = sum_64(value, product_64(UNITS / 2, max(abs(a), abs(b))));
    } else {
        value = sum_64(value, sum_64(product_64(UNITS, max(a, 0)), product_64(UNITS, max(b, 0))));
    }
    return !is_negative_64(value);
}

/// On which side of the plane through a corner, with normal n, what lies at `begin` from that corner is.
fn side_of(n: array<vec2u, 3>, begin: vec3i) -> i32 {
    let xy = sum_128(product_128(n[0], begin.x), product_128(n[1], begin.y));
    return sign_128(sum_128(xy, product_128(n[2], begin.z)));
}

/// Whether the plane meets the voxel: in its middle line along the normal's axis, thin; anywhere, conservative.
fn plane_meets(asked: Asked, voxel: vec3i) -> bool {
    let n = normal_of(asked.corners);
    let low = voxel * UNITS - asked.corners[0];
    if asked.thin {
        let begin = low + (1 - asked.lead) * (UNITS / 2);
        let up = dot(asked.lead, asked.signs);
        return up * side_of(n, begin) <= 0 && up * side_of(n, begin + asked.lead * UNITS) > 0;
    }
    let behind = low + select(vec3i(0), vec3i(UNITS), asked.signs < vec3i(0));
    let before = low + select(vec3i(0), vec3i(UNITS), asked.signs > vec3i(0));
    return side_of(n, behind) <= 0 && side_of(n, before) >= 0;
}

fn inside_all_edges(asked: Asked, voxel: vec3i) -> bool {
    for (var i = 0u; i < 3u; i++) {
        let begin = asked.corners[i];
        let end = asked.corners[select(i + 1u, 0u, i == 2u)];
        if !exactly_inside(begin.xy, end.xy, asked.signs.z, asked.thin, voxel.xy)
            || !exactly_inside(begin.yz, end.yz, asked.signs.x, asked.thin, voxel.yz)
            || !exactly_inside(begin.zx, end.zx, asked.signs.y, asked.thin, voxel.zx) {
            return false;
        }
    }
    return true;
}

/// Whether the triangle fills a voxel of its bounds, by the tests that are asked for.
fn exactly_fills(asked: Asked, voxel: vec3i, asked_edges: bool, asked_plane: bool) -> bool {
    if asked_edges && !inside_all_edges(asked, voxel) {
        return false;
    }
    return !asked_plane || asked.flat || plane_meets(asked, voxel);
}
