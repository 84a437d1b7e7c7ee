// One number for each thread, made of knobs.

struct Knobs {
    scale: f32,
    raised: u32,
}

var<uniform> knobs: Knobs;
override group: u32;
var<storage, read_write> result: array<f32>;

@compute @workgroup_size(group)
fn main(@builtin(local_invocation_index) i: u32) {
    var value = knobs.scale + 100.0 * f32(knobs.raised);
    @if(mode == "blue") {
        value += knobs.scale;
    }
    result[i] = value;
}
