// Voxelizes what moves, into sums of its own, and lists the voxels it comes into: those alone are cleared before the
// next time. One thread for each triangle (lib/voxelizer).
//
// Source: V 1.2, which keeps still and moving voxels apart; the list is in place of its search through all voxels.
// Reads and writes as lib/voxelizer, and 2 words for each voxel that is touched.

import lib/dispatch;
import lib/touched;
import lib/voxelizer;

struct Geometry {
    first: u32,
    triangles: u32,
}

var<uniform> geometry: Geometry;
var<storage, read_write> touched: Touched;

fn first_touch(voxel: u32) {
    let place = atomicAdd(&touched.listed, 1u);
    if place < arrayLength(&touched.voxels) {
        touched.voxels[place] = voxel;
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let triangle = linear_index(id, workgroups, 64u);
    if triangle < geometry.triangles {
        voxelize(geometry.first + triangle);
    }
}
