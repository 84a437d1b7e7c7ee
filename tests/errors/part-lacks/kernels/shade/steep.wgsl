// Steps.

fn shade() -> f32 {
    return 0.5;
}

fn slope_of(pixel: vec2u) -> f32 {
    return step(8.0, f32(pixel.x));
}
