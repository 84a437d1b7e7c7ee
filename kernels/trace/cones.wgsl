// Light that voxels send to the surface in each pixel, gathered by cones: what they reflect (`indirect`), what they
// emit or that comes from outside (`emissive_light`), and how open the surroundings are (`ambient_occlusion`), all in one march.
//
// Source: R 6.3, 6.4, eq. 6.8, 6.9, 6.14: radiance ρ/π Σ W L, with ρ once. Ambient occlusion here is the
// cosine-weighted share of directions in which nothing lies within `ao_distance`, 1 = open: occlusion counts fully up
// to there and not beyond (a step that crosses it counts in part).
// Reads per pixel: 3 texels, and for each cone some 15 samples; writes 2 or 3 texels.

import lib/camera;
import lib/grid;
import role/hemisphere;
import lib/math;
import role/cones;
import role/storage;
@if(scene.environment) import lib/environment;

struct Knobs {
    cone_step: f32,
    cone_footprint: f32,
    cone_density: f32,
    exact_weights: u32,
    ao_distance: f32,
}

var<uniform> knobs: Knobs;
var depth: texture_depth_2d;
var albedo: texture_2d<f32>;
var normal: texture_2d<f32>;
var face_normal: texture_2d<f32>;
var indirect: texture_storage_2d<rgba32float, write>;
@if(scene.emissive || scene.environment)
var emissive_light: texture_storage_2d<rgba32float, write>;
var ambient_occlusion: texture_storage_2d<r32float, write>;

/// What a cone, or a sum of cones, brings: radiances, and in `reflected.a` the openness.
struct Gathered {
    reflected: vec4f,
    emitted: vec4f,
}

fn trace_cone(origin: Cone, ao_end: f32) -> Gathered {
    let cones = ConeKnobs(knobs.cone_step, knobs.cone_footprint, knobs.cone_density);
    var cone = origin;
    var found = Gathered(vec4f(0.0), vec4f(0.0));
    var openness = 1.0;
    for (var k = 0u; k < MOST_STEPS && cone_advance(&cone, cones); k++) {
        let position = cone_position(cone);
        let reflected = reflected_at(position, cone.level, cone.direction);
        let before = cone.transmittance;
        let scale = cone_absorb(&cone, reflected.a, cones);
        found.reflected += scale * reflected;
        @if(scene.emissive) {
            found.emitted += scale * emitted_at(position, cone.level, cone.direction);
        }
        let begin = cone.next - cone.length;
        let near = clamp((ao_end - begin) / cone.length, 0.0, 1.0);
        openness -= near * (before - cone.transmittance);
    }
    @if(scene.environment) {
        found.emitted += vec4f(cone.transmittance * environment_at(cone.direction, CONE_DIAMETER), 0.0);
    }
    found.reflected.a = openness;
    return found;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(indirect);
    if any(id.xy >= size) {
        return;
    }
    let pixel = id.xy;
    let seen = textureLoad(depth, pixel, 0);
    var axis = Gathered(vec4f(0.0, 0.0, 0.0, 1.0), vec4f(0.0));
    var sides = Gathered(vec4f(0.0, 0.0, 0.0, f32(CONES - 1u)), vec4f(0.0));
    if seen > 0.0 {
        let position = pixel_position(pixel, size, seen);
        let plane = unit_or(textureLoad(face_normal, pixel, 0).xyz, vec3f(0.0, 1.0, 0.0));
        let frame = frame_around(unit_or(textureLoad(normal, pixel, 0).xyz, plane));
        let ao_end = knobs.ao_distance * values.scene_side;
        sides.reflected.a = 0.0;
        for (var i = 0u; i < CONES; i++) {
            let found = trace_cone(cone_begin(position, plane, frame * cone_axis(i)), ao_end);
            if i == 0u {
                axis = found;
            } else {
                sides.reflected += found.reflected;
                sides.emitted += found.emitted;
            }
        }
    }
    let exact = knobs.exact_weights != 0u;
    let reflected = hemisphere_mean(axis.reflected, sides.reflected, exact);
    let rho = textureLoad(albedo, pixel, 0).rgb;
    textureStore(indirect, pixel, vec4f(rho * reflected.rgb, 1.0));
    textureStore(ambient_occlusion, pixel, vec4f(reflected.a, 0.0, 0.0, 1.0));
    @if(scene.emissive || scene.environment) {
        let emitted = hemisphere_mean(axis.emitted, sides.emitted, exact);
        textureStore(emissive_light, pixel, vec4f(rho * emitted.rgb, 1.0));
    }
}
