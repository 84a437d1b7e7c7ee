// Paints a picture white.

var color: texture_storage_2d<rgba16float, write>;

fn main(id: vec3u) {
    textureStore(color, id.xy, vec4f(1.0));
}
