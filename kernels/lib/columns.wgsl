// Fills the columns of voxels that a triangle meets, each a run without gaps. What a fragment does to its voxel is up
// to the role `payload`.
//
// Source: R 4.1.1, tests in lib/overlap. R turns triangles so that columns run along the axis that the normal is
// nearest to; since runs need no test per voxel, they may run along any: along the one that the payload names as
// `BIT_AXIS`, a word takes many of them at once.

import lib/grid;
import lib/overlap;
import lib/unit_corners;
import role/payload;

/// Of the knob `separability`: the thin one; the other is conservative.
const THIN: u32 = 6u;

/// A triangle in the grid.
struct Placed {
    triangle: u32,
    /// In units, relative to the voxel `first`.
    corners: array<vec3i, 3>,
    facing: Facing,
    /// Least voxel of its bounds, cut by the grid; and the last one from there.
    first: vec3i,
    size: vec3i,
    /// Whether its bounds meet the grid.
    meets: bool,
    /// The axis of the grid that is z here (`turn`).
    axis: u32,
}

fn placed_of(triangle: u32) -> Placed {
    let corners = unit_corners(triangle);
    let last = vec3i(values.grid_size) - 1;
    let least = voxel_of(min(corners[0], min(corners[1], corners[2])));
    let greatest = voxel_of(max(corners[0], max(corners[1], corners[2])));
    var out: Placed;
    out.triangle = triangle;
    out.axis = 2u;
    out.meets = all(least <= last) && all(greatest >= vec3i(0));
    if out.meets {
        out.facing = facing_of(corners);
        out.first = max(least, vec3i(0));
        out.size = min(greatest, last) - out.first;
        let begin = out.first * UNITS;
        out.corners = array(corners[0] - begin, corners[1] - begin, corners[2] - begin);
    }
    return out;
}

/// With z along `axis` of the grid.
fn placed_along(placed: Placed, axis: u32) -> Placed {
    let c = placed.corners;
    return Placed(
        placed.triangle,
        array(turn(c[0], axis), turn(c[1], axis), turn(c[2], axis)),
        turned(placed.facing, axis),
        turn(placed.first, axis),
        turn(placed.size, axis),
        placed.meets,
        axis,
    );
}

/// The voxel of the grid that lies at `voxel` from `first`.
fn grid_voxel(placed: Placed, voxel: vec3f) -> vec3u {
    return vec3u(turn_back(placed.first + nearest_integers(voxel), placed.axis));
}

fn asked_about(placed: Placed, separability: u32) -> Asked {
    return asked_of(placed.corners, placed.facing, separability == THIN);
}

fn prepared(placed: Placed, separability: u32) -> Overlap {
    let asked = asked_about(placed, separability);
    return overlap_of(asked, bounds_of(asked, placed.facing, placed.size), placed.size.z);
}

/// What the payload knows of it.
fn placed_surface(placed: Placed) -> Surface {
    let begin = placed.first * UNITS;
    let corners = array(
        vec3f(turn_back(placed.corners[0] + begin, placed.axis)) / f32(UNITS),
        vec3f(turn_back(placed.corners[1] + begin, placed.axis)) / f32(UNITS),
        vec3f(turn_back(placed.corners[2] + begin, placed.axis)) / f32(UNITS),
    );
    return surface_of(placed.triangle, corners);
}

/// Fills what is filled of a run from a voxel on, as much as the payload takes at once; returns how many voxels it
/// went on.
fn fill_some(placed: Placed, overlap: Overlap, surface: Surface, run: Run, voxel: vec3f) -> f32 {
    var filled = is_sure(run, voxel.z);
    // Rows of the payload are along its axis alone.
    var length = select(1.0, surely_up_to(run) - voxel.z + 1.0, filled && placed.axis == BIT_AXIS);
    if !filled {
        filled = fills_after_all(overlap, run, voxel);
    }
    if filled {
        length = f32(i32(add_row(surface, grid_voxel(placed, voxel), u32(nearest_integer(length)))));
    }
    return length;
}

/// One column of a triangle.
fn fill_column(placed: Placed, overlap: Overlap, column: vec2f) {
    let row = row_of(overlap, column.y);
    if column.x < row.x.low || column.x > row.x.high {
        return;
    }
    let run = run_of(overlap, row, column.x, column.y);
    let surface = placed_surface(placed);
    var z = run.low;
    for (var k = 0; k <= placed.size.z && z <= run.high; k++) {
        z += fill_some(placed, overlap, surface, run, vec3f(column, z));
    }
}

/// All of a triangle, by the calling thread.
fn fill_all(placed: Placed, separability: u32) {
    let rows = placed_along(placed, BIT_AXIS);
    fill_columns(rows, separability, vec2i(0), rows.size.xy);
}

/// The columns from `low` to `high` of a triangle that is placed along `BIT_AXIS`, by the calling thread.
fn fill_columns(placed: Placed, separability: u32, low: vec2i, high: vec2i) {
    let surface = placed_surface(placed);
    let overlap = prepared(placed, separability);
    let last = vec2f(high);
    var row: Row;
    var last_x = -1.0;
    var run = no_run();
    // The next voxel; at first before the first row.
    var voxel = vec3f(0.0, f32(low.y) - 1.0, 0.0);
    // One loop through rows, columns and runs: threads whose triangles have other sizes wait less for each other than
    // in a loop for each.
    let sides = high - low + 1;
    let most = sides.x * sides.y * (placed.size.z + 1) + sides.y + 1;
    for (var k = 0; k < most; k++) {
        if voxel.z <= run.high {
            voxel.z += fill_some(placed, overlap, surface, run, voxel);
        }
        if voxel.z > run.high {
            voxel.x += 1.0;
            if voxel.x > last_x {
                voxel.y += 1.0;
                if voxel.y > last.y {
                    break;
                }
                row = row_of(overlap, voxel.y);
                voxel.x = max(row.x.low, f32(low.x));
                last_x = min(row.x.high, last.x);
            }
            run = no_run();
            if voxel.x <= last_x {
                run = run_of(overlap, row, voxel.x, voxel.y);
                voxel.z = run.low;
            }
        }
    }
}
