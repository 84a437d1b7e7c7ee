// Where surfaces cross the middle lines of rows of voxels along x: a bit turns over at the first voxel whose centre lies
// beyond the crossing. Rows of bits begin with a word of their own.
//
// Source: Schwarz and Seidel 2010, "Fast Parallel Surface and Solid Voxelization on GPUs", 5 (parity along an axis);
// what they turn over is all voxels beyond, here voxelize/solid_rows does that once for all.
// Exact: corners are snapped (lib/units). A middle line through an edge crosses one of the two triangles there: the
// one whose edge, with the triangle on its left, goes up, or level and to the right. A centre on the plane lies beyond.
// A thread for each triangle reads 3 corners, and adds to a word for each row that it crosses.

import lib/dispatch;
import lib/geometry;
import lib/grid;
import lib/overlap_exact;
import lib/unit_corners;

var<storage, read_write> crossings: array<atomic<u32>>;

/// Whether a row's middle line lies on the triangle's side of an edge, which has the triangle on its left where `facing`
/// is 1, on its right where it is -1.
fn is_left(begin: vec2i, end: vec2i, facing: i32, p: vec2i) -> bool {
    let d = facing * (end - begin);
    let to = p - begin;
    let value = difference_of_products(d.x, to.y, d.y, to.x);
    return sign_64(value) > 0 || (sign_64(value) == 0 && (d.y > 0 || (d.y == 0 && d.x > 0)));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let triangle = linear_index(id, workgroups, 64u);
    if triangle >= geometry.triangles {
        return;
    }
    let corners = unit_corners(geometry.first + triangle);
    // Rows along z: y, z, x.
    let a = turn(corners[0], 0u);
    let b = turn(corners[1], 0u);
    let c = turn(corners[2], 0u);
    let n = normal_of(array(a, b, c));
    let facing = sign_64(n[2]);
    if facing == 0 {
        return;
    }
    let grid = turn(vec3i(values.grid_size), 0u);
    let low = max(voxel_of(min(a, min(b, c))), vec3i(0));
    let high = min(voxel_of(max(a, max(b, c))), grid - 1);
    let words = (grid.z + 31) / 32;
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            let middle = vec2i(x, y) * UNITS + UNITS / 2;
            if !is_left(a.xy, b.xy, facing, middle)
                || !is_left(b.xy, c.xy, facing, middle)
                || !is_left(c.xy, a.xy, facing, middle) {
                continue;
            }
            // The first centre beyond: from `begin` to `end`, which may be past the row.
            var begin = 0;
            var end = grid.z;
            for (var k = 0; k < 32 && begin < end; k++) {
                let z = (begin + end) / 2;
                let beyond = facing * side_of(n, vec3i(middle, z * UNITS + UNITS / 2) - a) >= 0;
                begin = select(z + 1, begin, beyond);
                end = select(end, z, beyond);
            }
            if begin < grid.z {
                let word = (y * grid.x + x) * words + begin / 32;
                atomicXor(&crossings[word], 1u << u32(begin % 32));
            }
        }
    }
}
