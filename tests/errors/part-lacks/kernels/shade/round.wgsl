// Brighter to the right.

import lib/bump;

fn shade() -> f32 {
    return 1.0;
}
