// One mip level of a volume, where two (mipmap/mean) are too many: each texel the mean of its eight children, premultiplied colour and opacity alike.
//
// Source: R 5.3.1. The mean keeps Σ colour and Σ opacity; it forgets on which side of the coarse voxel they were.
// Sizes are powers of two, so that each coarse voxel has exactly eight children.
// Reads 8 texels, writes 1.

var finer: texture_3d<f32>;
var coarser: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id >= textureDimensions(coarser)) {
        return;
    }
    let last = textureDimensions(finer) - 1u;
    var sum = vec4f(0.0);
    for (var i = 0u; i < 8u; i++) {
        let child = 2u * id + vec3u(i & 1u, (i >> 1u) & 1u, i >> 2u);
        sum += textureLoad(finer, min(child, last), 0);
    }
    textureStore(coarser, id, 0.125 * sum);
}
