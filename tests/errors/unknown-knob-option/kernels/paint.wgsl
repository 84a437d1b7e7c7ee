// Paints a picture white.

struct Knobs {
    gain: f32,
}

var<uniform> knobs: Knobs;
var color: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(color, id.xy, vec4f(knobs.gain));
}
