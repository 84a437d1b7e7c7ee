// Draws a triangle without area, so that its target is as it began.

@vertex
fn vertex() -> @builtin(position) vec4f {
    return vec4f(0.0, 0.0, 0.5, 1.0);
}

struct Targets {
    @location(0) color: vec4f,
}

@fragment
fn fragment() -> Targets {
    return Targets(vec4f(9.0));
}
