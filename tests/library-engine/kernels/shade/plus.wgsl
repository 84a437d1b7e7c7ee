// The sum of a number and that in the table.

var<storage, read> table: array<u32>;

fn shade(x: f32) -> f32 {
    return x + f32(table[0]);
}
