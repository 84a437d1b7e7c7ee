// The loop's index and one, everywhere.

struct Element {
    level: u32,
}

var<uniform> element: Element;
var stamped: texture_storage_2d<r32float, write>;

@compute @workgroup_size(4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(stamped)) {
        textureStore(stamped, id.xy, vec4f(f32(element.level + 1u)));
    }
}
