// Appends the indices of two loops as decimal digits.

struct Element {
    outer: u32,
    inner: u32,
}

var<uniform> element: Element;
var<storage, read_write> digits: array<u32>;

@compute @workgroup_size(1)
fn main() {
    digits[0] = 10u * digits[0] + element.outer;
    digits[1] = 10u * digits[1] + element.inner;
}
