// Voxelizes what does not move: one thread for each triangle adds its fragments to the voxels' sums (lib/voxelizer).

import lib/dispatch;
import lib/voxelizer;

struct Geometry {
    first: u32,
    triangles: u32,
}

var<uniform> geometry: Geometry;

struct Counters {
    fragments: atomic<u32>,
}

var<storage, read_write> counters: Counters;

var<workgroup> group_fragments: atomic<u32>;

fn first_touch(voxel: u32) {}

@compute @workgroup_size(64)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let triangle = linear_index(id, workgroups, 64u);
    if triangle < geometry.triangles {
        let fragments = voxelize(geometry.first + triangle);
        if fragments > 0u {
            atomicAdd(&group_fragments, fragments);
        }
    }
    workgroupBarrier();
    if local == 0u && atomicLoad(&group_fragments) > 0u {
        atomicAdd(&counters.fragments, atomicLoad(&group_fragments));
    }
}
