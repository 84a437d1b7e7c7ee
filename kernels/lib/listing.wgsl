// Adds to a list of voxels (lib/voxel_list): the still ones', or the moving ones' in stages that voxelize what moves.
// Writes a word and adds to one; every 256th adds to two.

import lib/voxel_list;

@if(geometry.moving) var<storage, read_write> moving_list: VoxelList;
@else var<storage, read_write> still_list: VoxelList;
@if(geometry.moving) var<storage, read_write> moving_groups: array<atomic<u32>>;
@else var<storage, read_write> still_groups: array<atomic<u32>>;

fn list_voxel(voxel: u32) {
    @if(geometry.moving) {
        let place = atomicAdd(&moving_list.count, 1u);
        if place < arrayLength(&moving_list.voxels) {
            moving_list.voxels[place] = voxel;
            if place % LISTED_TOGETHER == 0u {
                atomicAdd(&moving_groups[0], 1u);
            }
        }
    } @else {
        let place = atomicAdd(&still_list.count, 1u);
        if place < arrayLength(&still_list.voxels) {
            still_list.voxels[place] = voxel;
            if place % LISTED_TOGETHER == 0u {
                atomicAdd(&still_groups[0], 1u);
            }
        }
    }
}
