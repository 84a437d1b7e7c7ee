// Variances of the means so far, from how batches differ; 0 while there is only one.
//
// Reads per pixel 48 B, writes 4 texels.

struct Knobs {
    batch: u32,
}

struct Values {
    bands: u32,
    /// Samples of a pixel that a frame adds.
    round_samples: u32,
}

struct Counted {
    index: u32,
}

struct Squares {
    direct: vec4f,
    indirect: vec4f,
    color: vec4f,
}

var<uniform> knobs: Knobs;
var<uniform> values: Values;
var<uniform> frame: Counted;
var<storage, read> squares: array<Squares>;
var color_variance: texture_storage_2d<rgba32float, write>;
var direct_variance: texture_storage_2d<rgba32float, write>;
var indirect_variance: texture_storage_2d<rgba32float, write>;
var ambient_occlusion_variance: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(color_variance);
    if any(id.xy >= size) {
        return;
    }
    let rounds = (frame.index + 1u) / values.bands;
    let batches = f32(rounds * values.round_samples / knobs.batch);
    let scale = select(0.0, 1.0 / (batches * (batches - 1.0)), batches > 1.0);
    let square = squares[id.y * size.x + id.x];
    textureStore(color_variance, id.xy, vec4f(square.color.rgb * scale, 1.0));
    textureStore(direct_variance, id.xy, vec4f(square.direct.rgb * scale, 1.0));
    textureStore(indirect_variance, id.xy, vec4f(square.indirect.rgb * scale, 1.0));
    textureStore(ambient_occlusion_variance, id.xy, vec4f(square.direct.a * scale, 0.0, 0.0, 1.0));
}
