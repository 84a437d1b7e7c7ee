// Directions towards the environment, chosen as it is bright: a row, then a column of it, by halving the engine's running
// probabilities; evenly over the solid angle of the texel.
//
// Cost of a choice: log2 of rows and of columns, elements of 16 B.

import lib/environment;
import lib/math;

/// The first of `count` elements whose probability is above `choice`; `within`: columns of a row, else rows.
fn environment_find(begin: u32, count: u32, within: bool, choice: f32) -> u32 {
    var low = 0u;
    var high = count - 1u;
    // As many halvings as the widest picture takes.
    for (var step = 0u; step < 16u && low < high; step++) {
        let middle = (low + high) / 2u;
        if environment_running(begin + middle, within) > choice {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}

fn environment_running(element: u32, within: bool) -> f32 {
    return select(environment[element].x, environment[element].w, within);
}

/// Of running probabilities: that of the element itself (x), and of all before (y).
fn environment_part(begin: u32, index: u32, within: bool) -> vec2f {
    var before = 0.0;
    if index > 0u {
        before = environment_running(begin + index - 1u, within);
    }
    return vec2f(environment_running(begin + index, within) - before, before);
}

/// Probability of a texel, per steradian.
fn environment_texel_density(column: u32, row: u32) -> f32 {
    let width = scene.environment_width;
    let probability = environment_part(scene.environment_rows, row, false).x
        * environment_part(row * width, column, true).x;
    let half_row = 0.5 * PI / f32(scene.environment_height);
    let solid_angle = 4.0 * PI / f32(width) * sin(f32(2u * row + 1u) * half_row) * sin(half_row);
    return probability / solid_angle;
}

/// A direction (xyz), and its density per steradian (w).
fn environment_choose(random: vec2f) -> vec4f {
    let width = scene.environment_width;
    let height = scene.environment_height;
    let row = environment_find(scene.environment_rows, height, false, random.y);
    let column = environment_find(row * width, width, true, random.x);
    let down = environment_part(scene.environment_rows, row, false);
    let along = environment_part(row * width, column, true);
    let y = clamp((random.y - down.y) / max(down.x, 1e-12), 0.0, 1.0);
    let x = clamp((random.x - along.y) / max(along.x, 1e-12), 0.0, 1.0);
    // Heights below the nearer pole: those above the equator's plane lose precision there.
    let lower = 2u * row >= height;
    let from_pole = select(row, height - 1u - row, lower);
    let ends = sin(0.5 * PI / f32(height) * vec2f(f32(from_pole), f32(from_pole + 1u)));
    let below = 2.0 * mix(ends.x * ends.x, ends.y * ends.y, select(y, 1.0 - y, lower));
    let around = 2.0 * PI * ((f32(column) + x) / f32(width) - 0.5) + scene.environment_turn;
    let sine = sqrt(below * (2.0 - below));
    return vec4f(
        sine * sin(around),
        select(1.0 - below, below - 1.0, lower),
        -sine * cos(around),
        environment_texel_density(column, row),
    );
}

/// Density of `environment_choose` for a direction.
fn environment_density(direction: vec3f) -> f32 {
    let size = vec2u(scene.environment_width, scene.environment_height);
    let texel = min(vec2u(environment_point(direction) * vec2f(size)), size - 1u);
    return environment_texel_density(texel.x, texel.y);
}
