// A loop of `rounds` 4·2^min(|log2(tile) - 8|, 4) turns: the least is at a tile of 256, and each factor of 2 away from
// it takes twice as long, up to 16 times. Whatever else a machine does, it does not hide that from medians of frames in
// turns.

struct Knobs {
    tile: u32,
    rounds: u32,
    brief: u32,
}

var<uniform> knobs: Knobs;
var<storage, read_write> result: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let away = min(abs(log2(f32(knobs.tile)) - 8.0), 4.0);
    var turns = u32(f32(knobs.rounds) * 4.0 * exp2(away));
    if knobs.brief != 0u {
        turns /= 8u;
    }
    var x = result[id.x] + id.x;
    for (var i = 0u; i < turns; i++) {
        x = x * 1664525u + 1013904223u;
    }
    result[id.x] = x;
}
