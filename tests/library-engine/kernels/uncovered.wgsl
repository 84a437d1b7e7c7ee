// Writes a texture and a list, without the first column and the first word if `covered` is off.

var half_written: texture_storage_2d<rgba16float, write>;
var<storage, read_write> words: array<u32>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(half_written)) {
        return;
    }
    @if(!covered) {
        if id.x == 0u {
            return;
        }
    }
    textureStore(half_written, id.xy, vec4f(0.5));
    if id.y == 0u {
        words[id.x] = 5u;
    }
}
