// Adds a frame's samples to those before: means, and how batches of samples differ from them (Welford 1962).
//
// Samples of a batch depend on each other, batches don't: so the variance of the mean comes from batch means.
// Reads per pixel 4 texels and 112 B, writes 128 B.

struct Knobs {
    batch: u32,
}

struct Values {
    bands: u32,
    /// Samples of a pixel that a frame adds.
    round_samples: u32,
    band_pixels: u32,
}

struct Counted {
    index: u32,
}

/// Sums of the samples of a batch that is not complete.
struct Partial {
    /// a: openness.
    direct: vec4f,
    indirect: vec4f,
}

/// Means over complete batches.
struct Means {
    direct: vec4f,
    indirect: vec4f,
}

/// Sums of squared differences from the mean, over complete batches.
struct Squares {
    direct: vec4f,
    indirect: vec4f,
    color: vec4f,
}

/// Means over all samples; a: share that met a surface, its distance times that share.
struct Surfaces {
    albedo: vec4f,
    normal: vec4f,
}

var<uniform> knobs: Knobs;
var<uniform> values: Values;
var<uniform> frame: Counted;
var sample_direct: texture_2d<f32>;
var sample_indirect: texture_2d<f32>;
var sample_albedo: texture_2d<f32>;
var sample_normal: texture_2d<f32>;
var<storage, read_write> unfinished: array<Partial>;
var<storage, read_write> means: array<Means>;
var<storage, read_write> squares: array<Squares>;
var<storage, read_write> surfaces: array<Surfaces>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(sample_direct);
    let number = (frame.index % values.bands) * values.band_pixels + id.x;
    if id.x >= values.band_pixels || number >= size.x * size.y {
        return;
    }
    let pixel = vec2u(number % size.x, number / size.x);
    let round = frame.index / values.bands;
    let rounds = knobs.batch / values.round_samples;

    let share = 1.0 / f32(values.round_samples);
    var seen = surfaces[number];
    seen.albedo += (textureLoad(sample_albedo, pixel, 0) * share - seen.albedo) / f32(round + 1u);
    seen.normal += (textureLoad(sample_normal, pixel, 0) * share - seen.normal) / f32(round + 1u);
    surfaces[number] = seen;

    var sum = Partial(textureLoad(sample_direct, pixel, 0), textureLoad(sample_indirect, pixel, 0));
    if round % rounds != 0u {
        sum.direct += unfinished[number].direct;
        sum.indirect += unfinished[number].indirect;
    }
    unfinished[number] = sum;
    if (round + 1u) % rounds != 0u {
        return;
    }
    let batches = f32((round + 1u) / rounds);
    let direct = sum.direct / f32(knobs.batch);
    let indirect = sum.indirect / f32(knobs.batch);
    var mean = means[number];
    let direct_before = direct - mean.direct;
    let indirect_before = indirect - mean.indirect;
    mean.direct += direct_before / batches;
    mean.indirect += indirect_before / batches;
    means[number] = mean;
    let direct_after = direct - mean.direct;
    let indirect_after = indirect - mean.indirect;
    squares[number].direct += direct_before * direct_after;
    squares[number].indirect += indirect_before * indirect_after;
    squares[number].color += (direct_before + indirect_before) * (direct_after + indirect_after);
}
