// Shows counts as a picture.

var<storage, read> counts: array<u32>;
var color: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(color, id.xy, vec4f(f32(counts[id.x])));
}
