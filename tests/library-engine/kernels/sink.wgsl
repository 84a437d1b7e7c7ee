// The sum of a picture's coarse mip and a list.

var middle: texture_2d<f32>;
var sunk: texture_storage_2d<r32float, write>;

struct Element {
    value: f32,
}

var<storage, read> list: array<Element>;

@compute @workgroup_size(4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(sunk)) {
        textureStore(sunk, id.xy, textureLoad(middle, id.xy / 2u, 1) + vec4f(list[id.x].value));
    }
}
