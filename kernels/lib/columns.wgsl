// Fills the columns of voxels that a triangle meets, along the axis that its normal is nearest to. What a fragment does
// to its voxel is up to the role `payload`.
//
// Source: R 4.1.1, tests in lib/overlap.

import lib/grid;
import lib/overlap;
import lib/scene;
import role/payload;

/// Of the knob `separability`: the thin one; the other is conservative.
const THIN: u32 = 6u;

/// A triangle in the grid.
struct Placed {
    triangle: u32,
    /// In units, turned so that the columns run along z, and relative to the voxel `first`.
    corners: array<vec3i, 3>,
    facing: Facing,
    /// Least voxel of its bounds, cut by the grid, turned; and the last one from there.
    first: vec3i,
    size: vec3i,
    /// Whether its bounds meet the grid.
    meets: bool,
}

fn placed_of(triangle: u32) -> Placed {
    let t = triangles[triangle];
    var out: Placed;
    out.triangle = triangle;
    let corners = array(
        snapped(to_grid(corner_position(t.a, t.instance))),
        snapped(to_grid(corner_position(t.b, t.instance))),
        snapped(to_grid(corner_position(t.c, t.instance))),
    );
    let last = vec3i(values.grid_size) - 1;
    let least = voxel_of(min(corners[0], min(corners[1], corners[2])));
    let greatest = voxel_of(max(corners[0], max(corners[1], corners[2])));
    out.meets = all(least <= last) && all(greatest >= vec3i(0));
    if !out.meets {
        return out;
    }
    let low = max(least, vec3i(0));
    out.facing = turned(facing_of(corners));
    let axis = out.facing.axis;
    out.first = turn(low, axis);
    out.size = turn(min(greatest, last) - low, axis);
    let begin = low * UNITS;
    out.corners = array(turn(corners[0] - begin, axis), turn(corners[1] - begin, axis), turn(corners[2] - begin, axis));
    return out;
}

/// The voxel of the grid that lies at `voxel` from `first`.
fn grid_voxel(placed: Placed, voxel: vec3i) -> vec3u {
    return vec3u(turn_back(placed.first + voxel, placed.facing.axis));
}

fn prepared(placed: Placed, separability: u32) -> Overlap {
    return overlap_of(placed.corners, placed.facing, separability == THIN, placed.size);
}

/// What the payload knows of it.
fn placed_surface(placed: Placed) -> Surface {
    let axis = placed.facing.axis;
    let begin = placed.first * UNITS;
    let corners = array(
        vec3f(turn_back(placed.corners[0] + begin, axis)) / f32(UNITS),
        vec3f(turn_back(placed.corners[1] + begin, axis)) / f32(UNITS),
        vec3f(turn_back(placed.corners[2] + begin, axis)) / f32(UNITS),
    );
    return surface_of(placed.triangle, corners);
}

/// A walk through the voxels that may be filled: column by column, row by row.
struct Scan {
    /// The column, and the last one of its row.
    p: vec2i,
    last_x: i32,
    /// The next voxel of the column to be tested, and the last one.
    z: i32,
    last_z: i32,
    range: vec4i,
}

/// Goes to the next column of those from `low_x` to `high`; false when there is none. The column may have no voxel.
fn scan_on(scan: ptr<function, Scan>, overlap: Overlap, placed: Placed, low_x: i32, high: vec2i) -> bool {
    (*scan).p.x += 1;
    if (*scan).p.x > (*scan).last_x {
        (*scan).p.y += 1;
        if (*scan).p.y > high.y {
            return false;
        }
        let row = row_range(overlap, (*scan).p.y);
        (*scan).p.x = max(row.x, low_x);
        (*scan).last_x = min(row.y, high.x);
    }
    if (*scan).p.x <= (*scan).last_x && inside(overlap, overlap.xy, 0u, 1u, 2u, (*scan).p) {
        (*scan).range = column_range(overlap, (*scan).p);
        (*scan).z = max((*scan).range.x, 0);
        (*scan).last_z = min((*scan).range.y, placed.size.z);
    }
    return true;
}

/// Tests the next voxel of the column, if there is one.
fn scan_fill(scan: ptr<function, Scan>, overlap: Overlap, placed: Placed, surface: Surface) {
    if (*scan).z <= (*scan).last_z {
        let voxel = vec3i((*scan).p, (*scan).z);
        (*scan).z += 1;
        if fills(overlap, (*scan).range, voxel) {
            add_fragment(surface, grid_voxel(placed, voxel));
        }
    }
}

/// All columns of a triangle, by the calling thread.
fn fill_all(placed: Placed, separability: u32) {
    fill_columns(placed, separability, vec2i(0), placed.size.xy);
}

/// The columns from `low` to `high`, by the calling thread.
fn fill_columns(placed: Placed, separability: u32, low: vec2i, high: vec2i) {
    let surface = placed_surface(placed);
    let overlap = prepared(placed, separability);
    // One loop through rows, columns and voxels: threads whose triangles have other sizes wait less for each other than
    // in a loop for each axis.
    var scan = Scan(vec2i(0, low.y - 1), 0, 0, -1, vec4i(0));
    let sides = high - low + 1;
    let most = sides.x * sides.y * (placed.size.z + 1) + sides.y + 1;
    for (var k = 0; k < most; k++) {
        scan_fill(&scan, overlap, placed, surface);
        if scan.z > scan.last_z && !scan_on(&scan, overlap, placed, low.x, high) {
            break;
        }
    }
}
