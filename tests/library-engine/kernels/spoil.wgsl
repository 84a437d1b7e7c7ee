// Writes over resources, so that the next frame finds them changed.

var flat_zero: texture_storage_2d<rgba8unorm, write>;
var volume: texture_storage_3d<r32float, write>;
var volume_zero: texture_storage_3d<r32float, write>;
var<storage, read_write> words: array<u32>;
var<storage, read_write> floats: array<f32>;
var<storage, read_write> floats_zero: array<f32>;
var<storage, read_write> spoilt: array<u32>;

@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(flat_zero, id.xx % textureDimensions(flat_zero), vec4f(1.0));
    let cell = vec3u(id.x % 4u, (id.x / 4u) % 3u, (id.x / 12u) % 2u);
    textureStore(volume, cell, vec4f(9.0));
    textureStore(volume_zero, cell, vec4f(9.0));
    words[id.x % arrayLength(&words)] = 99u;
    floats[id.x % arrayLength(&floats)] = 99.0;
    floats_zero[id.x % arrayLength(&floats_zero)] = 99.0;
    spoilt[0] = 1u;
}
