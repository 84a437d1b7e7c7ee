// Fills the columns of voxels that a triangle meets, each a run without gaps. What a fragment does to its voxel is up
// to the role `payload`.
//
// Source: R 4.1.1, tests in lib/overlap. R turns triangles so that columns run along the axis that the normal is
// nearest to; since runs need no test per voxel, they may run along any: along x, voxels of a run lie next to each
// other in memory.

import lib/grid;
import lib/overlap;
import lib/unit_corners;
import role/payload;

/// The axis of the grid along which voxels lie next to each other in memory.
const ROWS: u32 = 0u;
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

fn prepared(placed: Placed, separability: u32) -> Overlap {
    return overlap_of(placed.corners, placed.facing, separability == THIN, placed.size);
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

/// All of a triangle, by the calling thread.
fn fill_all(placed: Placed, separability: u32) {
    let rows = placed_along(placed, ROWS);
    fill_columns(rows, separability, vec2i(0), rows.size.xy);
}

/// The columns from `low` to `high` of a triangle that is placed along x, by the calling thread.
fn fill_columns(placed: Placed, separability: u32, low: vec2i, high: vec2i) {
    let surface = placed_surface(placed);
    let overlap = prepared(placed, separability);
    let last = vec2f(high);
    var row: Row;
    var last_x = -1.0;
    var run: Range;
    run.high = -1.0;
    // The next voxel; at first before the first row.
    var voxel = vec3f(0.0, f32(low.y) - 1.0, 0.0);
    // One loop through rows, columns and runs: threads whose triangles have other sizes wait less for each other than
    // in a loop for each.
    loop {
        if voxel.z <= run.high {
            let sure = is_sure(run, voxel.z);
            var filled = sure;
            if !sure {
                filled = exactly_fills(overlap.asked, nearest_integers(voxel));
            }
            var length = select(1.0, run.surely_high - voxel.z + 1.0, sure);
            if filled {
                length = f32(i32(add_row(surface, grid_voxel(placed, voxel), u32(nearest_integer(length)))));
            }
            voxel.z += length;
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
            run.high = -1.0;
            if voxel.x <= last_x {
                run = run_of(overlap, row, voxel.x, voxel.y);
                voxel.z = run.low;
            }
        }
    }
}
