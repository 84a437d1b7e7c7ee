// Module of the role `cones`: where a cone is sampled, and how what it meets adds up.
//
// Source: R 6.1 (tangent spheres: radius = distance · sin(aperture/2)), start shifted along the normal (R 6.1.1), and
// two corrections of our own.
//
// A cone that leaves a plane at a slant meets that very plane again in the coarse levels: a level with voxels of size s
// holds the plane smeared over ±1.5 s (box of the mean, tent of the filter). Along R's 60° side cones, where s = d and
// the height is d/2, that is an optical depth of 0.35 for each doubling of d, and most of what an open plain sees would
// be itself. So the sampled size is bounded by the height above the surface's plane: s ≤ height / (1.5 √2 |n|₁); √2
// because between two levels the coarser one, up to √2 s at equal weights, is blended in. An open plane then lights
// itself by 0.2 % of its radiance and less. The start is lifted by 1.5 |n|₁ voxels, which clears the surface's own
// voxels at the finest level, conservative ones too.
//
// A mean of opacities treats what it holds as dust, spread at random: a wall of one voxel in a block of 2^k has
// the mean 2^-k and lets (1 - 2^-k)^(2^k) ≈ 1/e through. `cone_density` is how much denser than dust coarse voxels are
// taken to be: exp(-density) then gets through. It fades in with the level, since the finest holds walls as they are.
//
// A cone is cut into steps of `cone_step` sampled sizes, sampled in their middle. Sizes never fall below a voxel.
// Across a grid of 64³: about 10 steps along the normal, 14 for each of the other cones.

import role/hemisphere;
import role/mipmap;
import lib/grid;
import lib/math;

struct ConeKnobs {
    /// Length of a step over the sampled size.
    step: f32,
    /// Sampled size over the cone's diameter.
    footprint: f32,
    /// How much denser than dust coarse voxels are.
    density: f32,
}

/// A cone on its way. Lengths in voxels, positions in the grid.
struct Cone {
    origin: vec3f,
    /// In the world, and along the grid's axes.
    direction: vec3f,
    along: vec3f,
    /// Height above the plane of the origin: `lift + rise · distance`.
    lift: f32,
    rise: f32,
    clearance: f32,
    /// Distance where the next step begins.
    next: f32,
    /// Distance where the cone leaves the grid.
    end: f32,
    /// The step: its middle, its length, and the mip level to sample.
    distance: f32,
    length: f32,
    level: f32,
    /// Share of what lies ahead that can still be seen.
    transmittance: f32,
}

const LIFT: f32 = 1.5;
const CLEARANCE: f32 = 2.1213; // 1.5 √2
/// Shading normals can aim a cone along the plane or below it; sizes grow as if it rose this much.
const LEAST_RISE: f32 = 0.25;
const LEAST_TRANSMITTANCE: f32 = 0.001;
const MOST_STEPS: u32 = 512u;

/// Distance `along` a direction to where the grid ends.
fn grid_exit(origin: vec3f, along: vec3f) -> f32 {
    let forward = along > vec3f(0.0);
    let wall = select(vec3f(0.0), vec3f(values.grid_size), forward);
    let slope = select(min(along, vec3f(-1e-6)), max(along, vec3f(1e-6)), forward);
    let exit = (wall - origin) / slope;
    return max(min(exit.x, min(exit.y, exit.z)), 0.0);
}

/// A cone from a point of a surface with unit normal `n` on the side where the cone starts, all in the world.
fn cone_begin(position: vec3f, n: vec3f, direction: vec3f) -> Cone {
    let up = direction_to_grid(n);
    let along = direction_to_grid(direction);
    let lift = LIFT * norm_1(up);
    let origin = to_grid(position) + up * lift;
    return Cone(
        origin,
        direction,
        along,
        lift,
        max(dot(n, direction), LEAST_RISE),
        CLEARANCE * norm_1(up),
        0.5,
        grid_exit(origin, along),
        0.0,
        0.0,
        0.0,
        1.0,
    );
}

/// Goes to the next step; false when there is none.
fn cone_advance(cone: ptr<function, Cone>, knobs_: ConeKnobs) -> bool {
    let begin = (*cone).next;
    if begin >= (*cone).end || (*cone).transmittance < LEAST_TRANSMITTANCE {
        return false;
    }
    let wide = begin * CONE_DIAMETER * knobs_.footprint;
    let clear = ((*cone).lift + begin * (*cone).rise) / (*cone).clearance;
    let size = max(min(wide, clear), 1.0);
    let length = min(size * knobs_.step, (*cone).end - begin);
    (*cone).distance = begin + 0.5 * length;
    (*cone).length = length;
    (*cone).level = log2(size);
    (*cone).next = begin + length;
    return true;
}

/// World position of the step's sample.
fn cone_position(cone: Cone) -> vec3f {
    return from_grid(cone.origin + cone.along * cone.distance);
}

/// How much of a step a stored opacity stops: `1 - (1 - opacity)^s`, s = the step over the length that the opacity
/// stands for. For small opacities by its series, which has no cancellation.
fn step_opacity(opacity: f32, s: f32) -> f32 {
    if opacity >= 1.0 {
        return 1.0;
    }
    if opacity < 1e-3 {
        return opacity * s * (1.0 - 0.5 * (s - 1.0) * opacity);
    }
    return 1.0 - pow(1.0 - opacity, s);
}

/// Puts a sample (premultiplied colour, opacity) behind what the cone has met so far. Returns by how much the sample's
/// colour is to be scaled, and takes what it stops from the cone.
fn cone_absorb(cone: ptr<function, Cone>, opacity: f32, knobs_: ConeKnobs) -> f32 {
    let density = mix(knobs_.density, 1.0, exp2(-(*cone).level));
    let s = (*cone).length * density / stored_length((*cone).level);
    let stopped = step_opacity(opacity, s);
    let before = (*cone).transmittance;
    (*cone).transmittance = before * (1.0 - stopped);
    return before * select(s, stopped / max(opacity, 1e-6), opacity > 1e-6);
}
