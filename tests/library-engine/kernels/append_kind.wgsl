// Appends the light's kind as a decimal digit.

import lib/lights;

struct Element {
    light: u32,
}

var<uniform> element: Element;
var<storage, read_write> digits: array<u32>;

@compute @workgroup_size(1)
fn main() {
    digits[0] = 10u * digits[0] + lights[element.light].kind;
}
