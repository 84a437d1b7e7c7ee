// A list as a row of texels, from the start again where it is shorter.

var<storage, read> list: array<u32>;
var shown: texture_storage_2d<r32uint, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < textureDimensions(shown).x {
        textureStore(shown, id.xy, vec4u(list[id.x % arrayLength(&list)]));
    }
}
