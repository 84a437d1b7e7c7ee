// Paints a picture.

import role/shade;

var color: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(color, id.xy, vec4f(shade() * slope_of(id.xy)));
}
