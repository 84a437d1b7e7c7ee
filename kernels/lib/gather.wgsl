// Irradiance that cones bring to one side of a surface.
//
// Source: R 6.4 (eq. 6.14 without ρ/π). What the cones see is up to the kernel that imports this: it defines
// `seen_at(position, level, direction)`, premultiplied radiance and opacity as a storage's module returns them, and
// `seen_beyond(direction, width)`, the radiance from outside the grid over a width in radians.
// Reads: one sample for each step of each cone of the role `hemisphere`.

import lib/math;
import role/cones;
import role/hemisphere;

struct GatherKnobs {
    cone_step: f32,
    cone_footprint: f32,
    cone_density: f32,
    exact_weights: u32,
}

var<uniform> knobs: GatherKnobs;

/// Irradiance on the side of `n` at a point (world) of a surface.
fn gather(position: vec3f, n: vec3f) -> vec3f {
    let cones = ConeKnobs(knobs.cone_step, knobs.cone_footprint, knobs.cone_density);
    let frame = frame_around(n);
    var axis = vec4f(0.0);
    var sides = vec4f(0.0);
    for (var i = 0u; i < CONES; i++) {
        var cone = cone_begin(position, n, frame * cone_axis(i));
        var radiance = vec4f(0.0);
        for (var k = 0u; k < MOST_STEPS && cone_advance(&cone, cones); k++) {
            let found = seen_at(cone_position(cone), cone.level, cone.direction);
            radiance += cone_absorb(&cone, found.a, cones) * found;
        }
        radiance += vec4f(cone.transmittance * seen_beyond(cone.direction, CONE_DIAMETER), 0.0);
        if i == 0u {
            axis = radiance;
        } else {
            sides += radiance;
        }
    }
    return PI * hemisphere_mean(axis, sides, knobs.exact_weights != 0u).rgb;
}
