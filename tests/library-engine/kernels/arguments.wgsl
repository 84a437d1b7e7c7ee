// Workgroup counts 5, 2, 1, after a word that is none of them.

var<storage, read_write> arguments: array<u32>;

@compute @workgroup_size(1)
fn main() {
    arguments[0] = 8u;
    arguments[1] = 5u;
    arguments[2] = 2u;
    arguments[3] = 1u;
}
