// The list of the filled voxels (part `list/filled`). Reads two words.

import lib/grid;

/// Numbers of voxels.
var<storage, read> voxel_list: array<u32>;
var<storage, read> voxel_count: array<u32, 1>;

/// How many are listed: there may be more than the list has room for.
fn listed_voxels() -> u32 {
    return min(voxel_count[0], arrayLength(&voxel_list));
}

/// The voxel at a place of the list.
fn listed_voxel(place: u32) -> vec3u {
    let number = voxel_list[place];
    let size = values.grid_size;
    return vec3u(number % size.x, number / size.x % size.y, number / (size.x * size.y));
}
