// The piece of a triangle that lies in a voxel: how large it is, and where its middle is.
//
// Seen along the axis that the normal is nearest to it is a convex polygon: bounded by the triangle's edges, by four
// sides of the voxel, and by the two lines in which the plane leaves it through the others. Each of the nine adds the
// part of it that the others leave to integrals along the border (Green); no polygon is stored.
// Errors: ca. 1e-6 of a voxel's face for triangles of up to ten voxels, more for larger ones, as single floats have it.

import lib/math;
import lib/nearest;

struct Piece {
    /// In faces of a voxel; at most the square root of 2.
    area: f32,
    /// In voxels. Of a piece too small to know it, the triangle's point that is nearest to the voxel's middle.
    middle: vec3f,
    /// Of the corners, for the point where images are looked up.
    weights: vec3f,
}

/// What is smaller has no middle worth the name.
const LEAST_PIECE: f32 = 1e-4;

/// The triangle's edges and plane, seen along z from the voxel's middle.
struct Seen {
    /// Inside of an edge is where start + inward·p is not negative; a component for each edge.
    start: vec3f,
    inward_x: vec3f,
    inward_y: vec3f,
    /// Of the plane, at p: z = height + slope·p.
    height: f32,
    slope: vec2f,
}

/// The part of a range of t in which `at + along·t` is not negative in any component.
fn cut(range: vec2f, at: vec3f, along: vec3f) -> vec2f {
    let one = 1.0 / select(along, vec3f(1e-20), along == vec3f(0.0));
    let t = -at * one;
    let low = select(vec3f(range.x), t, one > vec3f(0.0));
    let high = select(t, vec3f(range.y), one > vec3f(0.0));
    return vec2f(
        max(range.x, max(low.x, max(low.y, low.z))),
        min(range.y, min(high.x, min(high.y, high.z))),
    );
}

/// The part of a range of t in which `at + along·t` is from -`half` to `half`.
fn cut_between(range: vec2f, at: f32, along: f32, half: f32) -> vec2f {
    let one = 1.0 / select(along, 1e-20, along == 0.0);
    let middle = -at * one;
    let reach = half * abs(one);
    return vec2f(max(range.x, middle - reach), min(range.y, middle + reach));
}

fn cut_by_cube(range: vec2f, at: vec3f, along: vec3f) -> vec2f {
    let x = cut_between(range, at.x, along.x, 0.5);
    return cut_between(cut_between(x, at.y, along.y, 0.5), at.z, along.z, 0.5);
}

fn cut_by_edges(range: vec2f, seen: Seen, at: vec2f, along: vec2f) -> vec2f {
    let inside = seen.start + seen.inward_x * at.x + seen.inward_y * at.y;
    return cut(range, inside, seen.inward_x * along.x + seen.inward_y * along.y);
}

/// Twice the area, and six times its first moments, that a part of the border adds.
fn border(at: vec2f, along: vec2f, range: vec2f) -> vec3f {
    let begin = at + range.x * along;
    let end = at + range.y * along;
    let twice = select(0.0, cross_2(begin, end), range.x < range.y);
    return vec3f(twice, twice * (begin + end));
}

/// Of an edge of the triangle.
fn edge_border(begin: vec3f, edge: vec3f) -> vec3f {
    return border(begin.xy, edge.xy, cut_by_cube(vec2f(0.0, 1.0), begin, edge));
}

/// Of a side of the voxel, which is along `along`, counterclockwise.
fn side_border(seen: Seen, along: vec2f) -> vec3f {
    let at = 0.5 * vec2f(along.y, -along.x);
    let range = cut_by_edges(vec2f(-0.5, 0.5), seen, at, along);
    let height = seen.height + dot(seen.slope, at);
    return border(at, along, cut_between(range, height, dot(seen.slope, along), 0.5));
}

/// Of the line in which the plane goes through the voxel's bottom or top: `side` is -1/2 or 1/2.
fn level_border(seen: Seen, side: f32) -> vec3f {
    let steepness = max(dot(seen.slope, seen.slope), 1e-20);
    let at = seen.slope * ((side - seen.height) / steepness);
    let along = 2.0 * side * inverseSqrt(steepness) * vec2f(-seen.slope.y, seen.slope.x);
    // A line along a side of the voxel is that side's.
    let x = cut_between(vec2f(-2.0, 2.0), at.x, along.x, 0.499999);
    return border(at, along, cut_by_edges(cut_between(x, at.y, along.y, 0.499999), seen, at, along));
}

/// `corners` and the voxel's lowest corner, in voxels. Images are looked up, as wide as a voxel, at the point that is
/// nearest to the voxel's middle: of pieces that make up a whole face together, all see that face. Each at its own middle
/// they would see what lies beside it.
fn piece_of(corners: array<vec3f, 3>, voxel: vec3f) -> Piece {
    let center = voxel + 0.5;
    var a = corners[0] - center;
    var b = corners[1] - center;
    var c = corners[2] - center;
    var n = cross(b - a, c - a);
    let size = abs(n);
    let along_x = size.x >= max(size.y, size.z);
    let along_y = !along_x && size.y >= size.z;
    a = select(select(a, a.zxy, along_y), a.yzx, along_x);
    b = select(select(b, b.zxy, along_y), b.yzx, along_x);
    c = select(select(c, c.zxy, along_y), c.yzx, along_x);
    n = select(select(n, n.zxy, along_y), n.yzx, along_x);
    let ab = b - a;
    let bc = c - b;
    let ca = a - c;
    let turn = sign(n.z);
    var seen: Seen;
    seen.inward_x = -turn * vec3f(ab.y, bc.y, ca.y);
    seen.inward_y = turn * vec3f(ab.x, bc.x, ca.x);
    seen.start = -seen.inward_x * vec3f(a.x, b.x, c.x) - seen.inward_y * vec3f(a.y, b.y, c.y);
    seen.slope = -n.xy / select(n.z, 1.0, n.z == 0.0);
    seen.height = a.z - dot(seen.slope, a.xy);
    let edges = turn * (edge_border(a, ab) + edge_border(b, bc) + edge_border(c, ca));
    let sides = side_border(seen, vec2f(0.0, 1.0))
        + side_border(seen, vec2f(-1.0, 0.0))
        + side_border(seen, vec2f(0.0, -1.0))
        + side_border(seen, vec2f(1.0, 0.0));
    let sum = edges + sides + level_border(seen, -0.5) + level_border(seen, 0.5);
    // Without area it is nothing, whatever the sum is.
    let area = abs(turn) * clamp(0.5 * sum.x * length(n) / max(abs(n.z), 1e-30), 0.0, 1.4142135);
    let weights = nearest_weights(corners, center);
    if area < LEAST_PIECE {
        return Piece(area, weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2], weights);
    }
    let p = sum.yz / (3.0 * sum.x);
    let turned = vec3f(p, seen.height + dot(seen.slope, p));
    let middle = select(select(turned, turned.yzx, along_y), turned.zxy, along_x);
    return Piece(area, center + middle, weights);
}
