// Writes one texel of a volume.

var cells: texture_storage_3d<rgba32float, write>;

@compute @workgroup_size(1)
fn main() {
    textureStore(cells, vec3u(0u), vec4f(1.0));
}
