// How bright the picture is.

fn brightness(position: vec2u) -> f32 {
    let sum: u32 = position.x + position.y;
    return f32(sum);
}
