// For tests: a field of one radiance (premultiplied) and opacity. Writes a texel.

struct Knobs {
    field_radiance: f32,
    field_opacity: f32,
}

var<uniform> knobs: Knobs;
var lit: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id < textureDimensions(lit)) {
        textureStore(lit, id, vec4f(vec3f(knobs.field_radiance), 1.0) * knobs.field_opacity);
    }
}
