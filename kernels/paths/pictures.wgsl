// The means so far, as pictures.
//
// Reads per pixel 32 B, writes 4 texels.

struct Means {
    direct: vec4f,
    indirect: vec4f,
}

var<storage, read> means: array<Means>;
var color: texture_storage_2d<rgba32float, write>;
var direct: texture_storage_2d<rgba32float, write>;
var indirect: texture_storage_2d<rgba32float, write>;
var ambient_occlusion: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(color);
    if any(id.xy >= size) {
        return;
    }
    let mean = means[id.y * size.x + id.x];
    textureStore(color, id.xy, vec4f(mean.direct.rgb + mean.indirect.rgb, 1.0));
    textureStore(direct, id.xy, vec4f(mean.direct.rgb, 1.0));
    textureStore(indirect, id.xy, vec4f(mean.indirect.rgb, 1.0));
    textureStore(ambient_occlusion, id.xy, vec4f(mean.direct.a, 0.0, 0.0, 1.0));
}
