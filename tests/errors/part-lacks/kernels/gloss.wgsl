// Paints another one.

import role/shade;

var shine: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    var bump: Bump;
    bump.height = shade();
    textureStore(shine, id.xy, vec4f(bump.height));
}
