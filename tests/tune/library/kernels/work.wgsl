// A loop of `rounds` (8 + |log2(tile) - 8|)/8 turns: the least is at a tile of 256, and each factor of 2 adds an eighth.

struct Knobs {
    tile: u32,
    rounds: u32,
    half: u32,
}

var<uniform> knobs: Knobs;
var<storage, read_write> result: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let away = abs(log2(f32(knobs.tile)) - 8.0);
    var turns = u32(f32(knobs.rounds) * (8.0 + away));
    if knobs.half != 0u {
        turns /= 2u;
    }
    var x = result[id.x] + id.x;
    for (var i = 0u; i < turns; i++) {
        x = x * 1664525u + 1013904223u;
    }
    result[id.x] = x;
}
