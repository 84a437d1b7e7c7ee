// Two mip levels of a volume: each texel the mean of its eight children, premultiplied colour and opacity alike.
//
// Source: R 5.3.1. The mean keeps Σ colour and Σ opacity; it forgets on which side of the coarse voxel they were.
// Sizes are powers of two, so that each coarse voxel has exactly eight children. The coarser of the two levels is made
// of the other's values before they are rounded to the format. A dispatch has its price, and there are many levels.
// Reads 8 texels a thread and writes 9/8 of one; 1 KiB of workgroup memory.

var finer: texture_3d<f32>;
var coarser: texture_storage_3d<rgba16float, write>;
var coarsest: texture_storage_3d<rgba16float, write>;

var<workgroup> means: array<vec4f, 64>;

@compute @workgroup_size(4, 4, 4)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let last = textureDimensions(finer) - 1u;
    var sum = vec4f(0.0);
    for (var i = 0u; i < 8u; i++) {
        let child = 2u * id + vec3u(i & 1u, (i >> 1u) & 1u, i >> 2u);
        sum += textureLoad(finer, min(child, last), 0);
    }
    let mean = 0.125 * sum;
    if all(id < textureDimensions(coarser)) {
        textureStore(coarser, id, mean);
    }
    means[local] = mean;
    workgroupBarrier();
    let parent = vec3u(local & 1u, (local >> 1u) & 1u, local >> 2u);
    let texel = 2u * group + parent;
    if local < 8u && all(texel < textureDimensions(coarsest)) {
        let first = 2u * (parent.x + 4u * parent.y + 16u * parent.z);
        var coarse = vec4f(0.0);
        for (var i = 0u; i < 8u; i++) {
            coarse += means[first + (i & 1u) + 4u * ((i >> 1u) & 1u) + 16u * (i >> 2u)];
        }
        textureStore(coarsest, texel, 0.125 * coarse);
    }
}
