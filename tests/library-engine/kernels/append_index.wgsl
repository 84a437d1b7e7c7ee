// Appends the light's index as a decimal digit.

struct Element {
    light: u32,
}

var<uniform> element: Element;
var<storage, read_write> digits: array<u32>;

@compute @workgroup_size(1)
fn main() {
    digits[1] = 10u * digits[1] + element.light;
}
