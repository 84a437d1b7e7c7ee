// Radiance of the voxels = first scattering + what a bounce adds; opacity is that of the first.
// Reads 2 texels, writes 1.

var first: texture_3d<f32>;
var bounced: texture_3d<f32>;
var lit: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id >= textureDimensions(lit)) {
        return;
    }
    let start = textureLoad(first, id, 0);
    // Radiances that half floats don't hold are cut.
    let radiance = min(start.rgb + textureLoad(bounced, id, 0).rgb, vec3f(65504.0));
    textureStore(lit, id, vec4f(radiance, start.a));
}
