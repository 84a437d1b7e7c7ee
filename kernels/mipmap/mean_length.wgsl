// Module of the role `mipmap`, for means of opacity.
//
// A mean of opacities is what independent fine voxels stop within the length of one of them, whatever the level: in a
// medium with opacity a per fine voxel, every level holds a.

/// The length, in voxels of the finest level, that an opacity stored at `level` stands for.
fn stored_length(level: f32) -> f32 {
    return 1.0;
}
