// Near and far distance of a view.

struct ViewFacts {
    near: f32,
    far: f32,
}

struct Element {
    number: u32,
}

var<uniform> view: ViewFacts;
var<uniform> element: Element;
var<storage, read_write> distances: array<f32>;

@compute @workgroup_size(1)
fn main() {
    distances[2u * element.number] = view.near;
    distances[2u * element.number + 1u] = view.far;
}
