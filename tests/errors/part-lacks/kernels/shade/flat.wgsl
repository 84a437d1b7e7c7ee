// The same everywhere.

fn shade() -> f32 {
    return 1.0;
}
