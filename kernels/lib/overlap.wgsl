// Which voxels a triangle fills: 26-separating (it meets the closed cube), 6-separating (thin: the plane passes the
// middle line of the voxel along the axis that the normal is nearest to, and in each projection every edge has an end
// of the voxel's two axes on its inner side; no path over faces leads through, with fewer voxels).
//
// Source: R 4.1, figures 4.4 and 4.5, with these corrections (R = Rauwendaal 2013): the tests of the planes yz and zx
// use p_yz and p_zx; bounds are floors, loops inclusive; 6-separating takes one voxel for each line of voxels along
// that axis, the one that holds the plane at the line's middle, its upper face not included. A triangle without area
// fills what it meets as a segment or point, whatever the separability.
// R tests voxel by voxel. Each of its tests is a half-space, so that what a triangle fills of a column (the voxels
// along z) is a run without gaps; here the half-spaces, solved for z, give its ends: no test per voxel.
// Exact: corners are whole numbers of units (lib/units). Single floats decide where they can be sure; where not,
// integers do (lib/overlap_exact). Everything is relative to a voxel.

import lib/overlap_exact;

/// Stands in for zero where a half-space does not depend on what it is solved for: so little that it moves no test by
/// more than its doubt.
const LEAST_PART: f32 = 1e-10;
/// No bound.
const FAR: f32 = 1e30;

/// Least and greatest that may be, then those that surely are, in voxels.
struct Range {
    low: f32,
    high: f32,
    surely_low: f32,
    surely_high: f32,
}

/// The three edges of a projection, each solved for a place on one of its axes by the place `q` on the other:
/// `place + slope·q` bounds what may be, and what is further in by the size of `doubt` surely is. Doubt is positive
/// where that is the least, negative where it is the greatest place.
struct Sides {
    place: vec3f,
    slope: vec3f,
    doubt: vec3f,
}

/// The same, ready for many places: at least `low + low_slope·q`, at most `high + high_slope·q`.
struct Between {
    low: vec3f,
    low_slope: vec3f,
    high: vec3f,
    high_slope: vec3f,
    doubt: vec3f,
}

/// A triangle's tests, solved.
struct Bounds {
    /// x, by y.
    xy: Sides,
    /// z, by y.
    yz: Sides,
    /// z, by x.
    zx: Sides,
    /// z within the slab of the plane at column (0, 0): least and greatest, then its slopes.
    plane: vec4f,
    plane_doubt: f32,
}

struct Overlap {
    asked: Asked,
    xy: Between,
    yz: Between,
    zx: Between,
    plane: vec4f,
    plane_doubt: f32,
    /// The greatest z that is asked for.
    last_z: f32,
}

/// Half-spaces `part·p + slope·q + rest ≥ 0`, solved for p.
fn solved(part: vec3f, slope: vec3f, rest: vec3f, doubt: vec3f) -> Sides {
    let one = 1.0 / select(part, vec3f(LEAST_PART), part == vec3f(0.0));
    // A doubt of zero would have no sign.
    let off = max(doubt * abs(one), vec3f(1e-30)) * sign(one);
    return Sides(-rest * one - off, -slope * one, 2.0 * off);
}

/// Half-planes of one projection. `u`, `v`: the corners' coordinates; `facing`: the sign that makes the edges' normals
/// point inwards, 0 where the projection is a line (all tests then pass, and the others decide); `extent`: the greatest
/// voxel that is asked for. Solved for v, or for u.
fn sides_of(u: vec3i, v: vec3i, facing: i32, thin: bool, extent: vec2i, for_u: bool) -> Sides {
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
    let rest = select(select(conservative, axes, thin), vec3f(1.0), (a == vec3f(0.0)) & (b == vec3f(0.0)));
    if for_u {
        return solved(a * side, b * side, rest, doubt);
    }
    return solved(b * side, a * side, rest, doubt);
}

/// Solves the tests of a triangle whose corners are relative; voxels from 0 to `size` will be asked for.
fn bounds_of(asked: Asked, facing: Facing, size: vec3i) -> Bounds {
    var out: Bounds;
    let signs = asked.signs;
    let c = asked.corners;
    let x = vec3i(c[0].x, c[1].x, c[2].x);
    let y = vec3i(c[0].y, c[1].y, c[2].y);
    let z = vec3i(c[0].z, c[1].z, c[2].z);
    out.xy = sides_of(x, y, signs.z, asked.thin, size.xy, true);
    out.yz = sides_of(y, z, signs.x, asked.thin, size.yz, false);
    out.zx = sides_of(z, x, signs.y, asked.thin, size.zx, true);
    // The normal with 1 for its largest component; of voxel v, up·v lies between these two.
    let up = facing.normal * dot(facing.normal, vec3f(asked.lead));
    let corner = vec3f(c[0]) / f32(UNITS);
    let place = dot(up, corner);
    let middle = 0.5 * (up.x + up.y + up.z - 1.0);
    let least = select(place - dot(max(up, vec3f(0.0)), vec3f(1.0)), place - middle - 1.0, asked.thin);
    let most = select(place - dot(min(up, vec3f(0.0)), vec3f(1.0)), place - middle, asked.thin);
    let far = abs(corner) + vec3f(size) + 2.0;
    // The normal may be off by two DOUBTs (lib/facing: one of its own, one of its largest component); as much again is for
    // what is computed with it.
    let doubt = 4.0 * DOUBT * (far.x + far.y + far.z);
    let one = 1.0 / select(up.z, LEAST_PART, up.z == 0.0);
    let off = doubt * abs(one);
    let low = select(most, least, one > 0.0) * one - off;
    let high = select(least, most, one > 0.0) * one + off;
    // Without area there is no plane.
    out.plane = select(vec4f(low, high, -up.xy * one), vec4f(-FAR, FAR, 0.0, 0.0), asked.flat);
    out.plane_doubt = select(2.0 * off, 0.0, asked.flat);
    return out;
}

fn between(sides: Sides) -> Between {
    let is_low = sides.doubt > vec3f(0.0);
    return Between(
        select(vec3f(-FAR), sides.place, is_low),
        select(vec3f(0.0), sides.slope, is_low),
        select(sides.place, vec3f(FAR), is_low),
        select(sides.slope, vec3f(0.0), is_low),
        abs(sides.doubt),
    );
}

fn overlap_of(asked: Asked, bounds: Bounds, last_z: i32) -> Overlap {
    return Overlap(
        asked,
        between(bounds.xy),
        between(bounds.yz),
        between(bounds.zx),
        bounds.plane,
        bounds.plane_doubt,
        f32(last_z),
    );
}

fn range_of(b: Between, q: f32) -> Range {
    let low = b.low + b.low_slope * q;
    let high = b.high + b.high_slope * q;
    let surely_low = low + b.doubt;
    let surely_high = high - b.doubt;
    return Range(
        max(low.x, max(low.y, low.z)),
        min(high.x, min(high.y, high.z)),
        max(surely_low.x, max(surely_low.y, surely_low.z)),
        min(surely_high.x, min(surely_high.y, surely_high.z)),
    );
}

fn both(a: Range, b: Range) -> Range {
    return Range(
        max(a.low, b.low),
        min(a.high, b.high),
        max(a.surely_low, b.surely_low),
        min(a.surely_high, b.surely_high),
    );
}

/// The whole numbers in a range.
fn whole_range(a: Range) -> Range {
    return Range(ceil(a.low), floor(a.high), ceil(a.surely_low), floor(a.surely_high));
}

/// What is known of a row of columns: those with one y.
struct Row {
    /// The columns that the triangle meets in the projection along z.
    x: Range,
    /// Voxels of each column that it meets in the projection along x; not rounded.
    z: Range,
}

fn row_of(o: Overlap, y: f32) -> Row {
    return Row(whole_range(range_of(o.xy, y)), both(range_of(o.yz, y), Range(0.0, o.last_z, 0.0, o.last_z)));
}

/// What a triangle may fill of a column: voxels without gaps.
struct Run {
    /// First and last one; whole numbers.
    low: f32,
    high: f32,
    /// From where to where the edges' tests surely pass, and that of the plane.
    edges: vec2f,
    plane: vec2f,
}

fn no_run() -> Run {
    return Run(0.0, -1.0, vec2f(0.0), vec2f(0.0));
}

/// The voxels that the triangle fills of column (x, y).
fn run_of(o: Overlap, row: Row, x: f32, y: f32) -> Run {
    let plane = o.plane.xy + (o.plane.z * x + o.plane.w * y);
    let edges = both(row.z, range_of(o.zx, x));
    // Where it may not meet the column it surely passes no edge's test.
    let met = x >= row.x.surely_low && x <= row.x.surely_high;
    return Run(
        ceil(max(edges.low, plane.x)),
        floor(min(edges.high, plane.y)),
        vec2f(edges.surely_low, select(-1.0, edges.surely_high, met)),
        vec2f(plane.x + o.plane_doubt, plane.y - o.plane_doubt),
    );
}

/// The last voxel of a run that it surely fills, if it surely fills that.
fn surely_up_to(run: Run) -> f32 {
    return floor(min(run.edges.y, run.plane.y));
}

/// Whether the triangle surely fills a voxel of a run.
fn is_sure(run: Run, z: f32) -> bool {
    return z >= max(run.edges.x, run.plane.x) && z <= min(run.edges.y, run.plane.y);
}

/// Whether it fills a voxel of a run, where that is not sure.
fn fills_after_all(o: Overlap, run: Run, voxel: vec3f) -> bool {
    let z = voxel.z;
    let asked_edges = z < run.edges.x || z > run.edges.y;
    let asked_plane = z < run.plane.x || z > run.plane.y;
    return exactly_fills(o.asked, nearest_integers(voxel), asked_edges, asked_plane);
}
