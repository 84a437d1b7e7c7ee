// Two quads: the first over the left three quarters at depth 0.75, the second over the right ones at 0.25.

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) number: u32,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Varying {
    let quad = i / 6u;
    let corner = i % 6u;
    let right = corner == 1u || corner == 2u || corner == 4u;
    let top = corner == 2u || corner == 4u || corner == 5u;
    let x = select(-1.0, 0.5, right) + 0.5 * f32(quad);
    return Varying(vec4f(x, select(-1.0, 1.0, top), 0.75 - 0.5 * f32(quad), 1.0), quad + 1u);
}

struct Targets {
    @location(0) shade: u32,
}

@fragment
fn fragment(in: Varying) -> Targets {
    return Targets(in.number);
}
