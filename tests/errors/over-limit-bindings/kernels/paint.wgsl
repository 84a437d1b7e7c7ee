// Paints five pictures white.

var a: texture_storage_2d<rgba16float, write>;
var b: texture_storage_2d<rgba16float, write>;
var c: texture_storage_2d<rgba16float, write>;
var d: texture_storage_2d<rgba16float, write>;
var e: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(a, id.xy, vec4f(1.0));
    textureStore(b, id.xy, vec4f(1.0));
    textureStore(c, id.xy, vec4f(1.0));
    textureStore(d, id.xy, vec4f(1.0));
    textureStore(e, id.xy, vec4f(1.0));
}
