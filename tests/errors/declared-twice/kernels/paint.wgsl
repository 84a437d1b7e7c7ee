// Paints a picture white.

import lib/bright;

var color: texture_storage_2d<rgba16float, write>;

fn brightness(position: vec2u) -> f32 {
    return 1.0;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(color, id.xy, vec4f(brightness(id.xy)));
}
