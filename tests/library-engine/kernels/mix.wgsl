// Mixes three lists of any lengths into one, so that each element of each shows.

var<storage, read> a: array<u32>;
var<storage, read> b: array<u32>;
var<storage, read> c: array<u32>;
var<storage, read_write> result: array<u32>;

@compute @workgroup_size(32)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= arrayLength(&result) {
        return;
    }
    let x = a[i % arrayLength(&a)];
    let y = b[(i + 1u) % arrayLength(&b)];
    let z = c[(2u * i) % arrayLength(&c)];
    result[i] = ((3u * x + ((y << 7u) | (y >> 25u))) ^ (z * 2654435761u)) + i;
}
