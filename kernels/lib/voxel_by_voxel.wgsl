// For payloads that do something for each fragment. The payload that imports this declares `Surface` and `add_fragment`.

/// Voxels that `add_row` adds together.
const MOST_AT_ONCE: u32 = 1u;

/// Of `length` voxels along `BIT_AXIS`, from `voxel` on, the first; returns how many that is.
fn add_row(surface: Surface, voxel: vec3u, length: u32) -> u32 {
    add_fragment(surface, voxel);
    return 1u;
}
