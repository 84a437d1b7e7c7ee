// Light on the surface in a voxel, which has a front and a back but one colour.
//
// Every surface reflects on both sides, and a voxel can't say which side a light is on. Light is summed for each side
// of the mean normal, and the brighter side, channel by channel, stands for the voxel: right for a wall that is lit
// from one side, and for one that is lit equally from both, never more than either side reflects; twice the light is
// twice the result.

struct Sides {
    front: vec3f,
    back: vec3f,
}

/// Mean of |n·d| over the surface in a voxel, from the mean `m` of its normals: |n·d| where they agree (|m| = 1), ½,
/// the mean over all normals, where they cancel (|m| = 0), in proportion between. `n` is m's direction.
fn mean_cosine(n: vec3f, agreement: f32, d: vec3f) -> f32 {
    return mix(0.5, abs(dot(n, d)), agreement);
}

fn brighter(sides: Sides) -> vec3f {
    return max(sides.front, sides.back);
}
