// The mean of four texels.

var finer: texture_2d<f32>;
var coarser: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(coarser)) {
        return;
    }
    var sum = vec4f(0.0);
    for (var i = 0u; i < 4u; i++) {
        sum += textureLoad(finer, 2u * id.xy + vec2u(i & 1u, i >> 1u), 0);
    }
    textureStore(coarser, id.xy, 0.25 * sum);
}
