// Three layers as a colour.

var stack: texture_2d_array<f32>;
var color: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    var found = vec4f(1.0);
    for (var layer = 0u; layer < 3u; layer++) {
        found[layer] = textureLoad(stack, id.xy, layer, 0).r;
    }
    textureStore(color, id.xy, found);
}
