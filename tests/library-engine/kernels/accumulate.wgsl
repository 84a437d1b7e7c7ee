// Adds the number of the frame, from 1.

struct Frame {
    index: u32,
}

var<uniform> frame: Frame;
var<storage, read_write> total: array<u32>;

@compute @workgroup_size(1)
fn main() {
    total[0] += frame.index + 1u;
}
