// Another one without slopes.

fn shade() -> f32 {
    return 1.0;
}
