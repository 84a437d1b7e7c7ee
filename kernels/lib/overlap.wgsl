// Which voxels a triangle touches: exact tests, 26-separating (the triangle meets the closed cube) and 6-separating
// (it meets the voxel's three axes in projection: thin, and still without holes that a path over faces could take).
//
// Source: R 4.1, figures 4.4 and 4.5, with these corrections (R = Rauwendaal 2013): the tests of the planes yz and zx
// use p_yz and p_zx; bounds are floors, loops inclusive; 6-separating takes one voxel for each column, the one that
// holds the plane at the column's centre. Everything is in units of voxels, in a space turned so that the largest
// component of the normal is z, and relative to the first voxel of the triangle's bounds: the products then are as
// small as the triangle is, and f32 is exact enough for small triangles.

/// The half-planes `a·p.x + b·p.y + c ≥ 0` of three edges; a component for each edge.
struct HalfPlanes {
    a: vec3f,
    b: vec3f,
    c: vec3f,
}

struct Overlap {
    xy: HalfPlanes,
    yz: HalfPlanes,
    zx: HalfPlanes,
    /// z where the plane meets the column of voxel (0, 0): first and last, and their slopes over x and y.
    z_first: f32,
    z_last: f32,
    slope: vec2f,
    /// Zero-area triangles touch nothing.
    valid: bool,
}

/// Half-planes of one projection. `u`, `v`: the corners' coordinates; `facing`: the sign that makes the edges' normals
/// point inwards, 0 where the projection is a line (all tests then pass, and the other projections decide).
fn half_planes(u: vec3f, v: vec3f, facing: f32, thin: bool) -> HalfPlanes {
    let a = -facing * (v.yzx - v);
    let b = facing * (u.yzx - u);
    // Conservative: the corner of the voxel that lies furthest inside. Thin: the end of its axes that does.
    let conservative = max(a, vec3f(0.0)) + max(b, vec3f(0.0)) - a * u - b * v;
    let axes = 0.5 * max(abs(a), abs(b)) + a * (0.5 - u) + b * (0.5 - v);
    return HalfPlanes(a, b, select(conservative, axes, thin));
}

fn inside(planes: HalfPlanes, p: vec2f) -> bool {
    return all(planes.a * p.x + planes.b * p.y + planes.c >= vec3f(0.0));
}

/// 0, 1, 2: which axis becomes z, that is the dominant one of the normal.
fn dominant_axis(n: vec3f) -> u32 {
    let size = abs(n);
    if size.z >= size.x && size.z >= size.y {
        return 2u;
    }
    return select(1u, 0u, size.x >= size.y);
}

/// R eq. 4.1: x dominant yzx, y dominant zxy.
fn turn(p: vec3f, axis: u32) -> vec3f {
    return select(select(p, p.zxy, axis == 1u), p.yzx, axis == 0u);
}

/// Inverse of `turn`.
fn turn_back(p: vec3i, axis: u32) -> vec3i {
    return select(select(p, p.yzx, axis == 1u), p.zxy, axis == 0u);
}

/// Prepares a triangle whose corners are turned and relative.
fn overlap_of(p: array<vec3f, 3>, thin: bool) -> Overlap {
    let x = vec3f(p[0].x, p[1].x, p[2].x);
    let y = vec3f(p[0].y, p[1].y, p[2].y);
    let z = vec3f(p[0].z, p[1].z, p[2].z);
    let n = cross(p[1] - p[0], p[2] - p[1]);
    let up = n * sign(n.z);
    let valid = up.z > 0.0;
    let scale = 1.0 / select(1.0, up.z, valid);
    let d = dot(up, p[0]);
    // Over the column's square the plane reaches from its lowest to its highest corner.
    let low = d - max(up.x, 0.0) - max(up.y, 0.0);
    let high = d - min(up.x, 0.0) - min(up.y, 0.0);
    let middle = d - 0.5 * (up.x + up.y);
    return Overlap(
        half_planes(x, y, sign(n.z), thin),
        half_planes(y, z, sign(n.x), thin),
        half_planes(z, x, sign(n.y), thin),
        select(low, middle, thin) * scale,
        select(high, middle, thin) * scale,
        -up.xy * scale,
        valid,
    );
}

/// First and last voxel of column (p.x, p.y) whose slab the plane meets.
fn column_range(o: Overlap, p: vec2f) -> vec2f {
    let shift = dot(o.slope, p);
    return floor(vec2f(o.z_first, o.z_last) + shift);
}
