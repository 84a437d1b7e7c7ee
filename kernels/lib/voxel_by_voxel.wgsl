// For payloads that do something for each fragment. The payload that imports this declares `Surface` and `add_fragment`.

/// Of `length` voxels along x, from `voxel` on, the first; returns how many that is.
fn add_row(surface: Surface, voxel: vec3u, length: u32) -> u32 {
    add_fragment(surface, voxel);
    return 1u;
}
