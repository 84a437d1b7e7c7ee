// The same everywhere.

fn shade() -> f32 {
    return 1.0;
}

@if(scene.masked)
fn slope_of(pixel: vec2u) -> f32 {
    return 0.0;
}
