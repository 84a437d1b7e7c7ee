// A quarter everywhere, or a NaN in one texel, or an infinity in one element. Made of bits, as compilers may take
// arithmetic for finite.

var stamped: texture_storage_2d<r32float, write>;

struct Element {
    value: f32,
}

var<storage, read_write> list: array<Element>;

@compute @workgroup_size(4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(stamped)) {
        return;
    }
    var value = 0.25;
    var element = 0.25;
    @if(planted == "picture") {
        value = bitcast<f32>(select(0x3e800000u, 0x7fc00000u, all(id.xy == vec2u(3u, 2u))));
    }
    @if(planted == "list") {
        element = bitcast<f32>(select(0x3e800000u, 0x7f800000u, id.x + 4u * id.y == 5u));
    }
    textureStore(stamped, id.xy, vec4f(value));
    if id.y < 2u {
        list[id.x + 4u * id.y].value = element;
    }
}
