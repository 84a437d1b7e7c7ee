// Colour: linear Rec. 709 and its sRGB coding (IEC 61966-2-1).

/// Relative luminance of a linear colour.
fn luminance(linear: vec3f) -> f32 {
    return dot(linear, vec3f(0.2126, 0.7152, 0.0722));
}

/// Linear value of an sRGB-coded one in [0, 1].
fn srgb_decode(coded: vec3f) -> vec3f {
    let low = coded / 12.92;
    let high = pow((coded + 0.055) / 1.055, vec3f(2.4));
    return select(high, low, coded <= vec3f(0.04045));
}

/// sRGB-coded value of a linear one in [0, 1].
fn srgb_encode(linear: vec3f) -> vec3f {
    let low = linear * 12.92;
    let high = 1.055 * pow(max(linear, vec3f(0.0031308)), vec3f(1.0 / 2.4)) - 0.055;
    return select(high, low, linear <= vec3f(0.0031308));
}
