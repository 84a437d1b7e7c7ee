// The numbers of a list, side by side.

struct Output {
    width: f32,
}

var<uniform> output: Output;
var<storage, read> numbers: array<u32>;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) number: u32,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Varying {
    let x = (f32(i) + 0.5) / output.width * 2.0 - 1.0;
    return Varying(vec4f(x, 0.0, 0.5, 1.0), numbers[i]);
}

struct Targets {
    @location(0) shade: u32,
}

@fragment
fn fragment(in: Varying) -> Targets {
    return Targets(in.number);
}
