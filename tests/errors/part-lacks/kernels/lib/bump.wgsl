// What has a slope.

struct Bump {
    height: f32,
}

fn slope_of(pixel: vec2u) -> f32 {
    return f32(pixel.x);
}
