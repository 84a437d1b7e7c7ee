// Paints a picture white.

struct Targets {
    @location(0) color: vec4f,
}

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn paint() -> Targets {
    return Targets(vec4f(1.0));
}
