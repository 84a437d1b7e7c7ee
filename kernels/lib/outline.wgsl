// Voxelizing by the rasterizer: a triangle is drawn along an axis, a pixel for each column of voxels, so much larger that
// every column which it may meet has its centre inside; fragments then test exactly.
//
// Source: R 4.1.2, eq. 4.2 with the offsets of the edges as separability asks for: half the voxel's extent across the
// edge. (As printed, with inward normals, it shrinks the triangle.) At a small angle the moved edges meet far away:
// where that makes a larger triangle than one around the oriented bounds along the longest side, or around the bounds
// themselves, that one is drawn. Triangles that reach far out of the grid are drawn as their bounds in it.
// Attributes are not interpolated: over the larger triangle that would extrapolate, without bounds for slivers. The
// payload finds them at the point nearest to the voxel's centre, as for every other method.

import lib/columns;

/// Added to offsets, in pixels: the rasterizer snaps corners to 256ths, and single floats are off by less.
const OUTLINE_MARGIN: f32 = 0.02;
/// The sine of the smallest angle at which moved edges are taken to meet.
const LEAST_SINE: f32 = 0.05;
/// In pixels. Larger triangles are drawn as their bounds.
const LONGEST_OUTLINE: f32 = 4096.0;

fn direction_of(v: vec2f) -> vec2f {
    return v / max(length(v), 1e-12);
}

/// How far an edge with direction `e` is moved outwards.
fn offset_of(e: vec2f, thin: bool) -> f32 {
    let n = abs(e);
    return 0.5 * select(n.x + n.y, max(n.x, n.y), thin) + OUTLINE_MARGIN;
}

struct Outline {
    corners: array<vec2f, 3>,
    area: f32,
}

/// The right triangle around a rectangle: `corner`, and its sides doubled.
fn around(corner: vec2f, u: vec2f, v: vec2f) -> Outline {
    return Outline(array(corner, corner + 2.0 * u, corner + 2.0 * v), 2.0 * abs(cross_2(u, v)));
}

/// Its edges moved outwards, where all its angles are large enough; else one without an end.
fn moved_edges(p: array<vec2f, 3>, thin: bool) -> Outline {
    let e = array(direction_of(p[1] - p[0]), direction_of(p[2] - p[1]), direction_of(p[0] - p[2]));
    let l = vec3f(offset_of(e[0], thin), offset_of(e[1], thin), offset_of(e[2], thin));
    let sines = vec3f(cross_2(e[2], e[0]), cross_2(e[0], e[1]), cross_2(e[1], e[2]));
    let size = abs(sines);
    if min(size.x, min(size.y, size.z)) < LEAST_SINE {
        return Outline(p, 1e30);
    }
    // With the other winding both the sine and the outward side change their signs.
    let corners = array(
        p[0] + (l.x * e[2] - l.z * e[0]) / size.x,
        p[1] + (l.y * e[0] - l.x * e[1]) / size.y,
        p[2] + (l.z * e[1] - l.y * e[2]) / size.z,
    );
    return Outline(corners, 0.5 * abs(cross_2(corners[1] - corners[0], corners[2] - corners[0])));
}

/// Around its bounds along its longest side.
fn oriented(p: array<vec2f, 3>) -> Outline {
    let sides = array(p[1] - p[0], p[2] - p[1], p[0] - p[2]);
    var longest = sides[0];
    longest = select(longest, sides[1], dot(sides[1], sides[1]) > dot(longest, longest));
    longest = select(longest, sides[2], dot(sides[2], sides[2]) > dot(longest, longest));
    var u = direction_of(longest);
    u = select(u, vec2f(1.0, 0.0), dot(u, u) < 0.5);
    let v = vec2f(-u.y, u.x);
    let along = vec3f(dot(u, p[0]), dot(u, p[1]), dot(u, p[2]));
    let across = vec3f(dot(v, p[0]), dot(v, p[1]), dot(v, p[2]));
    // Half a voxel's diagonal.
    let reach = 0.7072 + OUTLINE_MARGIN;
    let low = vec2f(min(along.x, min(along.y, along.z)), min(across.x, min(across.y, across.z))) - reach;
    let high = vec2f(max(along.x, max(along.y, along.z)), max(across.x, max(across.y, across.z))) + reach;
    return around(u * low.x + v * low.y, u * (high.x - low.x), v * (high.y - low.y));
}

/// The triangle that is drawn, in voxels from `placed.first`.
fn outline_of(placed: Placed, thin: bool) -> Outline {
    let end = vec2f(placed.size.xy + 1);
    let bounds = around(vec2f(0.0), vec2f(end.x, 0.0), vec2f(0.0, end.y));
    let p = array(
        vec2f(placed.corners[0].xy) / f32(UNITS),
        vec2f(placed.corners[1].xy) / f32(UNITS),
        vec2f(placed.corners[2].xy) / f32(UNITS),
    );
    let far = max(max(abs(p[0]), abs(p[1])), abs(p[2]));
    if max(far.x, far.y) > LONGEST_OUTLINE {
        return bounds;
    }
    var best = oriented(p);
    if bounds.area < best.area {
        best = bounds;
    }
    let moved = moved_edges(p, thin);
    if moved.area < best.area {
        best = moved;
    }
    return best;
}

/// Where a vertex of what is drawn for a triangle that meets the grid lies, in a square as wide as the grid's longest
/// side. Columns are along the triangle's z.
fn outline_vertex(placed: Placed, vertex: u32, separability: u32) -> vec4f {
    let outline = outline_of(placed, separability == THIN && any(placed.facing.signs != vec3i(0)));
    let side = f32(max(values.grid_size.x, max(values.grid_size.y, values.grid_size.z)));
    let at = 2.0 / side * (outline.corners[vertex] + vec2f(placed.first.xy)) - 1.0;
    return vec4f(at.x, -at.y, 0.5, 1.0);
}

/// `Placed` as vertices hand it on: corners; w: the triangle, its axis and its normal's, its signs; two bits each.
fn packed_corners(placed: Placed) -> array<vec4i, 3> {
    let signs = placed.facing.signs + 1;
    let axes = placed.axis + 4u * placed.facing.axis;
    let more = vec3i(i32(placed.triangle), i32(axes), signs.x + 4 * signs.y + 16 * signs.z);
    let c = placed.corners;
    return array(vec4i(c[0], more.x), vec4i(c[1], more.y), vec4i(c[2], more.z));
}

fn placed_by(corners: array<vec4i, 3>, normal: vec3f, first: vec3i, size: vec3i) -> Placed {
    let c = corners;
    let signs = vec3i(c[2].w & 3, (c[2].w >> 2u) & 3, c[2].w >> 4u) - 1;
    let facing = Facing(signs, normal, u32(c[1].w) >> 2u);
    return Placed(u32(c[0].w), array(c[0].xyz, c[1].xyz, c[2].xyz), facing, first, size, true, u32(c[1].w) & 3u);
}

/// The column of a pixel, from `placed.first`.
fn column_at(clip: vec4f, placed: Placed) -> vec2f {
    return floor(clip.xy) - vec2f(placed.first.xy);
}

fn is_column(p: vec2f, placed: Placed) -> bool {
    return all(p >= vec2f(0.0)) && all(p <= vec2f(placed.size.xy));
}
