// The last texel of the last mip or layer, and the last element, of resources of each sort.

var flat_zero: texture_2d<f32>;
var flat: texture_2d<f32>;
var volume: texture_3d<f32>;
var volume_zero: texture_3d<f32>;
var layers: texture_2d_array<u32>;
var depth: texture_depth_2d;
var drawn: texture_2d<f32>;
var<storage, read> words: array<u32>;
var<storage, read> floats: array<f32>;
var<storage, read> floats_zero: array<f32>;
var<storage, read_write> found: array<f32>;

@compute @workgroup_size(1)
fn main() {
    found[0] = textureLoad(flat_zero, textureDimensions(flat_zero) - 1u, 0).a;
    let mip = textureNumLevels(flat) - 1u;
    found[1] = textureLoad(flat, textureDimensions(flat, mip) - 1u, mip).g;
    found[2] = textureLoad(volume, textureDimensions(volume, 1u) - 1u, 1u).r;
    found[3] = textureLoad(volume_zero, textureDimensions(volume_zero) - 1u, 0).r;
    found[4] = f32(textureLoad(layers, textureDimensions(layers) - 1u, 2, 0).r);
    found[5] = textureLoad(depth, textureDimensions(depth) - 1u, 0);
    found[6] = f32(words[arrayLength(&words) - 1u]);
    found[7] = floats[arrayLength(&floats) - 1u];
    found[8] = floats_zero[arrayLength(&floats_zero) - 1u];
    found[9] = textureLoad(drawn, textureDimensions(drawn) - 1u, 0).r;
}
