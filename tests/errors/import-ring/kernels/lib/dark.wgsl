// How dark the picture is.

import lib/bright;

fn darkness(position: vec2u) -> f32 {
    return 1.0 - brightness(position);
}
