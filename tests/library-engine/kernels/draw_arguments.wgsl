// Draw arguments for six vertices, after a word that is none of them.

var<storage, read_write> arguments: array<u32>;

@compute @workgroup_size(1)
fn main() {
    arguments[0] = 0u;
    arguments[1] = 6u;
    arguments[2] = 1u;
    arguments[3] = 0u;
    arguments[4] = 0u;
}
