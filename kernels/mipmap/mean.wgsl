// Two mip levels of a volume: each texel the mean of its eight children, premultiplied colour and opacity alike.
//
// Source: R 5.3.1. The mean keeps Σ colour and Σ opacity; it forgets on which side of the coarse voxel they were.
// Sizes are powers of two, so that each coarse voxel has exactly eight children. A thread makes a texel of the coarsest
// level and its eight children, from their values before they are rounded to the format: a dispatch has its price, and
// there are many levels. (Threads that share the children need a barrier, which costs the software driver more.)
// Reads 64 texels a thread, writes 9.

var finer: texture_3d<f32>;
var coarser: texture_storage_3d<rgba16float, write>;
var coarsest: texture_storage_3d<rgba16float, write>;

fn child(parent: vec3u, i: u32) -> vec3u {
    return 2u * parent + vec3u(i & 1u, (i >> 1u) & 1u, i >> 2u);
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id >= textureDimensions(coarsest)) {
        return;
    }
    var all_means = vec4f(0.0);
    for (var i = 0u; i < 8u; i++) {
        let texel = child(id, i);
        var sum = vec4f(0.0);
        for (var k = 0u; k < 8u; k++) {
            sum += textureLoad(finer, child(texel, k), 0);
        }
        textureStore(coarser, texel, 0.125 * sum);
        all_means += 0.125 * sum;
    }
    textureStore(coarsest, id, 0.125 * all_means);
}
