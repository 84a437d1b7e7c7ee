// Which voxels a triangle fills: 26-separating (it meets the closed cube), 6-separating (thin: the plane passes the
// column's middle line in the voxel, and in each projection every edge has an end of the voxel's two axes on its inner
// side; no path over faces leads through, with fewer voxels).
//
// Source: R 4.1, figures 4.4 and 4.5, with these corrections (R = Rauwendaal 2013): the tests of the planes yz and zx
// use p_yz and p_zx; bounds are floors, loops inclusive; 6-separating takes one voxel for each column, the one that
// holds the plane at the column's middle, its upper face not included. A triangle without area fills what it meets as
// a segment or point, whatever the separability.
// Exact: corners are whole numbers of units, odd ones, so that none lies on a face of a voxel or in its middle. Single
// floats decide where they can be sure; where not, integers do (lib/wide). Everything is in a space turned so that the
// largest component of the normal is z (of a segment: its shortest side), and relative to a voxel.

import lib/math;
import lib/wide;

/// Units of a voxel's side.
const UNITS: i32 = 4096;
/// Bounds what single floats lose in the tests here, in parts of the sizes of the terms: 8 roundings.
const DOUBT: f32 = 9.5367432e-7;
/// Corners farther out than this are moved there, in voxels: products must fit.
const OUTMOST: f32 = 131072.0;
/// Differences of units up to this are whole single floats.
const MOST_EXACT: f32 = 16777216.0;

/// The unit that a place along an axis of the grid, in voxels, is snapped to.
fn snapped(p: vec3f) -> vec3i {
    return 2 * vec3i(floor(clamp(p, vec3f(-OUTMOST), vec3f(OUTMOST)) * f32(UNITS / 2))) + 1;
}

/// The voxel along each axis that holds a unit.
fn voxel_of(p: vec3i) -> vec3i {
    // Rounds down; the shift of negative numbers does.
    return p >> vec3u(12u);
}

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

/// How a triangle lies.
struct Facing {
    /// Signs of the normal's components; zero for a triangle without area.
    signs: vec3i,
    /// The normal over its largest component's size, to the nearest 2^-19 or so.
    normal: vec3f,
    /// 0, 1, 2: the axis that becomes z: of the largest component of the normal; of equal ones z, then x. Without area,
    /// the one along which it is shortest.
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
    let doubt = 0.25 * DOUBT * (abs(one) + abs(other));
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

/// R eq. 4.1: x dominant yzx, y dominant zxy.
fn turn(p: vec3i, axis: u32) -> vec3i {
    return select(select(p, p.zxy, axis == 1u), p.yzx, axis == 0u);
}

fn turned(facing: Facing) -> Facing {
    let n = facing.normal;
    let normal = select(select(n, n.zxy, facing.axis == 1u), n.yzx, facing.axis == 0u);
    return Facing(turn(facing.signs, facing.axis), normal, facing.axis);
}

/// Inverse of `turn`.
fn turn_back(p: vec3i, axis: u32) -> vec3i {
    return select(select(p, p.yzx, axis == 1u), p.zxy, axis == 0u);
}

/// Half-planes `a·p.x + b·p.y + c ≥ 0` of three edges over voxels p; a component for each edge. Within `doubt` of 0 they
/// are not sure.
struct HalfPlanes {
    a: vec3f,
    b: vec3f,
    c: vec3f,
    doubt: vec3f,
}

struct Overlap {
    /// Of a triangle without area: its ends, the second one twice.
    corners: array<vec3i, 3>,
    /// Signs of the normal; all 1 for a triangle without area.
    signs: vec3i,
    thin: bool,
    flat: bool,
    xy: HalfPlanes,
    yz: HalfPlanes,
    zx: HalfPlanes,
    /// z, in voxels, where the plane meets the column of voxel (0, 0): first and last, their slopes, and the doubt.
    z_first: f32,
    z_last: f32,
    slope: vec2f,
    z_doubt: f32,
}

/// Half-planes of one projection. `u`, `v`: the corners' coordinates; `facing`: the sign that makes the edges' normals
/// point inwards, 0 where the projection is a line (all tests then pass, and the others decide); `extent`: the greatest
/// voxel that is asked for.
fn half_planes(u: vec3i, v: vec3i, facing: i32, thin: bool, extent: vec2i) -> HalfPlanes {
    let side = f32(UNITS);
    let at_u = vec3f(u);
    let at_v = vec3f(v);
    let a = vec3f(-facing * (v.yzx - v));
    let b = vec3f(facing * (u.yzx - u));
    // Conservative: the corner of the voxel that lies furthest inside. Thin: the end of its axes that does.
    let conservative = side * (max(a, vec3f(0.0)) + max(b, vec3f(0.0))) - a * at_u - b * at_v;
    let axes = 0.5 * side * (max(abs(a), abs(b)) + a + b) - a * at_u - b * at_v;
    let reach = vec2f(extent + 2) * side;
    let doubt = DOUBT * (abs(a) * (reach.x + abs(at_u)) + abs(b) * (reach.y + abs(at_v)));
    // Corners that fall together have no edge between them.
    let c = select(select(conservative, axes, thin), vec3f(1.0), (a == vec3f(0.0)) & (b == vec3f(0.0)));
    return HalfPlanes(a * side, b * side, c, doubt);
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

/// The tests of one projection for voxel `p`; `u`, `v`: its coordinates, `facing`: the component of the normal across.
fn inside(o: Overlap, planes: HalfPlanes, u: u32, v: u32, facing: u32, p: vec2i) -> bool {
    let value = planes.a * f32(p.x) + planes.b * f32(p.y) + planes.c;
    if any(value < -planes.doubt) {
        return false;
    }
    if all(value > planes.doubt) {
        return true;
    }
    return edge_holds(o, u, v, facing, o.corners[0], o.corners[1], p)
        && edge_holds(o, u, v, facing, o.corners[1], o.corners[2], p)
        && edge_holds(o, u, v, facing, o.corners[2], o.corners[0], p);
}

fn edge_holds(o: Overlap, u: u32, v: u32, facing: u32, begin: vec3i, end: vec3i, p: vec2i) -> bool {
    return exactly_inside(vec2i(begin[u], begin[v]), vec2i(end[u], end[v]), o.signs[facing], o.thin, p);
}

/// Prepares a triangle whose corners are turned and relative, and whose `facing` is turned; voxels from 0 to `size` will be asked
/// for.
fn overlap_of(p: array<vec3i, 3>, facing: Facing, thin: bool, size: vec3i) -> Overlap {
    var out: Overlap;
    out.flat = all(facing.signs == vec3i(0));
    out.corners = p;
    out.signs = facing.signs;
    out.thin = thin && !out.flat;
    if out.flat {
        out.corners = ends_of(p);
        out.signs = vec3i(1);
    }
    let c = out.corners;
    let x = vec3i(c[0].x, c[1].x, c[2].x);
    let y = vec3i(c[0].y, c[1].y, c[2].y);
    let z = vec3i(c[0].z, c[1].z, c[2].z);
    out.xy = half_planes(x, y, out.signs.z, out.thin, size.xy);
    out.yz = half_planes(y, z, out.signs.x, out.thin, size.yz);
    out.zx = half_planes(z, x, out.signs.y, out.thin, size.zx);
    let up = facing.normal * f32(out.signs.z);
    let corner = vec3f(c[0]) / f32(UNITS);
    let d = dot(up, corner);
    // Over the column's square the plane reaches from its lowest to its highest corner.
    let low = d - max(up.x, 0.0) - max(up.y, 0.0);
    let high = d - min(up.x, 0.0) - min(up.y, 0.0);
    let middle = d - 0.5 * (up.x + up.y);
    out.z_first = select(low, middle, out.thin);
    out.z_last = select(high, middle, out.thin);
    out.slope = -up.xy;
    let far = abs(corner) + vec3f(size) + 2.0;
    // The normal is off by more than what is computed with it.
    out.z_doubt = 4.0 * DOUBT * (far.x + far.y + far.z);
    return out;
}

/// First and last column of row y that may lie between the edges: no column outside does.
fn row_range(o: Overlap, y: i32) -> vec2i {
    let rest = o.xy.b * f32(y) + o.xy.c + o.xy.doubt;
    let ends = -rest / select(o.xy.a, vec3f(1.0), o.xy.a == vec3f(0.0));
    // Divisions may be off by some roundings.
    let slack = 0.01 + 1e-6 * abs(ends);
    let low = select(vec3f(-1e6), ends - slack, o.xy.a > vec3f(0.0));
    let high = select(vec3f(1e6), ends + slack, o.xy.a < vec3f(0.0));
    return vec2i(i32(ceil(max(low.x, max(low.y, low.z)))), i32(floor(min(high.x, min(high.y, high.z)))));
}

/// First and last voxel of column p whose slab the plane may meet, and those between which it surely does.
fn column_range(o: Overlap, p: vec2i) -> vec4i {
    if o.flat {
        let range = line_range(o.corners[0], o.corners[1], p);
        return vec4i(range, range);
    }
    let shift = dot(o.slope, vec2f(p));
    let ends = vec2f(o.z_first, o.z_last) + shift;
    return vec4i(floor(vec4f(ends - vec2f(o.z_doubt, -o.z_doubt), ends + vec2f(o.z_doubt, -o.z_doubt))));
}

/// On which side of the plane through a corner, with normal n, what lies at `begin` from that corner is.
fn side_of(n: array<vec2u, 3>, begin: vec3i) -> i32 {
    let xy = sum_128(product_128(n[0], begin.x), product_128(n[1], begin.y));
    return sign_128(sum_128(xy, product_128(n[2], begin.z)));
}

/// Whether the plane meets the voxel: in its middle line along z, thin; anywhere, conservative.
fn plane_meets(o: Overlap, voxel: vec3i) -> bool {
    let n = normal_of(o.corners);
    let low = voxel * UNITS - o.corners[0];
    if o.thin {
        let middle = low + vec3i(UNITS / 2, UNITS / 2, 0);
        return o.signs.z * side_of(n, middle) <= 0 && o.signs.z * side_of(n, middle + vec3i(0, 0, UNITS)) > 0;
    }
    let behind = low + select(vec3i(0), vec3i(UNITS), o.signs < vec3i(0));
    let before = low + select(vec3i(0), vec3i(UNITS), o.signs > vec3i(0));
    return side_of(n, behind) <= 0 && side_of(n, before) >= 0;
}

/// Whether the triangle fills a voxel of its bounds; `range`: of its column.
fn fills(o: Overlap, range: vec4i, voxel: vec3i) -> bool {
    return inside(o, o.yz, 1u, 2u, 0u, voxel.yz)
        && inside(o, o.zx, 2u, 0u, 1u, voxel.zx)
        && ((voxel.z >= range.z && voxel.z <= range.w) || plane_meets(o, voxel));
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

/// Least and greatest voxel of column p that a segment may meet. It is no longer along z than along x and y, so there
/// are few.
fn line_range(first: vec3i, last: vec3i, p: vec2i) -> vec2i {
    let begin = vec3f(first) / f32(UNITS);
    let along = vec3f(last - first) / f32(UNITS);
    let x_leads = abs(along.x) >= abs(along.y);
    let start = select(begin.y, begin.x, x_leads);
    let length = select(along.y, along.x, x_leads);
    let enters = f32(select(p.y, p.x, x_leads)) - start;
    let slope = along.z / select(length, 1.0, length == 0.0);
    let a = begin.z + slope * enters;
    let b = begin.z + slope * (enters + 1.0);
    let doubt = DOUBT * (abs(begin.x) + abs(begin.y) + abs(begin.z) + abs(enters) + 2.0);
    return vec2i(i32(floor(min(a, b) - doubt)), i32(floor(max(a, b) + doubt)));
}
