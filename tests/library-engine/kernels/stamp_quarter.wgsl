// A quarter, everywhere.

var stamped: texture_storage_2d<r32float, write>;

@compute @workgroup_size(4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(stamped)) {
        textureStore(stamped, id.xy, vec4f(0.25));
    }
}
