// Marks the place of each workgroup in rows of eight.

var<storage, read_write> marks: array<u32>;

@compute @workgroup_size(1)
fn main(@builtin(workgroup_id) id: vec3u) {
    if id.x < 8u && id.y < 2u {
        marks[8u * id.y + id.x] = 1u;
    }
}
