// A ramp from left to right, and what is wrong with it.

struct Knobs {
    gain: f32,
    halved: u32,
}

var<uniform> knobs: Knobs;
var color: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(color);
    if all(id.xy < size) {
        let wrong = (knobs.gain - 0.7) * select(1.0, 0.5, knobs.halved != 0u);
        textureStore(color, id.xy, vec4f(vec3f(1.0 + f32(id.x) / f32(size.x) + wrong), 1.0));
    }
}
