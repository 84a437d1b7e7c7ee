// A linear picture as a screen shows it: exposure, tone curve, sRGB coding.
//
// Curves: `clip` cuts at 1; `reinhard` takes luminance L to L / (1 + L) and keeps the colour's ratios (Reinhard et al.
// 2002, eq. 3).
// Reads a texel, writes a texel.

import lib/color;

struct Knobs {
    /// In stops: the picture is multiplied by 2^exposure.
    exposure: f32,
}

var<uniform> knobs: Knobs;
var picture: texture_2d<f32>;
var display: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(display)) {
        return;
    }
    var light = max(textureLoad(picture, id.xy, 0).rgb, vec3f(0.0)) * exp2(knobs.exposure);
    @if(tone_curve == "reinhard") {
        light /= 1.0 + luminance(light);
    }
    textureStore(display, id.xy, vec4f(srgb_encode(min(light, vec3f(1.0))), 1.0));
}
