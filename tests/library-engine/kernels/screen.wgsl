// The centre of each pixel.

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

struct Targets {
    @location(0) color: vec4f,
}

@fragment
fn fragment(@builtin(position) at: vec4f) -> Targets {
    return Targets(vec4f(at.xy, 1.0, 1.0));
}
