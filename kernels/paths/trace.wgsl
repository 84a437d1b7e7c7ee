// Path tracing: some samples of each pixel of a band of rows, by random walks from the camera, with next-event estimation
// to all emitters and multiple importance sampling (Veach 1997, power heuristic).
//
// `direct` is visible emission and one scattering, `indirect` the rest. Ambient occlusion is the cosine-weighted share of
// directions around the shading normal in which nothing lies within `ao_end`; 1 where there is no surface.
// A thread goes from sample to sample of its pixel, a surface at a time, whatever path that is of: threads of a subgroup
// seldom wait for each other (Novák, Havran, Dachsbacher 2010).
// Cost: for each ray 76 B a node and 36 B a triangle met, for each surface some 500 B; writes 4 texels.

import lib/bvh;
import lib/camera;
import lib/emitters;
import lib/met;
import lib/reflection;

struct Knobs {
    batch: u32,
    first_sample: u32,
    max_scatterings: u32,
    seed: u32,
}

struct Values {
    center: vec3f,
    ao_end: f32,
    bands: u32,
    /// Samples of a pixel that a frame adds.
    round_samples: u32,
    band_pixels: u32,
}

struct Counted {
    index: u32,
}

struct Counters {
    paths: atomic<u32>,
    rays: atomic<u32>,
}

var<uniform> knobs: Knobs;
var<uniform> values: Values;
var<uniform> frame: Counted;
@if(count_rays)
var<storage, read_write> counters: Counters;
/// rgb: sum over samples; a: sum of openness.
var sample_direct: texture_storage_2d<rgba32float, write>;
var sample_indirect: texture_storage_2d<rgba32float, write>;
/// a: how many samples met a surface.
var sample_albedo: texture_storage_2d<rgba32float, write>;
/// a: sum of distances along the camera's forward axis, metres.
var sample_normal: texture_storage_2d<rgba32float, write>;

/// Pairs of random numbers: one for the pixel, one for openness, then these for each surface.
const DIMENSIONS: u32 = 4u;
/// Measured with the Cornell box: from 3, 4, 5, 6, 8 the noise at equal numbers of rays is 1.09, 1.04, 1, 1, 1.10.
const ROULETTE_FROM: u32 = 5u;
/// Where surfaces reflect more than this, weights of paths grow without bound: the mean is right, its variance infinite.
const MOST_SURVIVAL: f32 = 0.998;
/// Of a path, on average over a frame's samples: a bound that the roulette never lets it come near.
const MOST_SURFACES: u32 = 8192u;

/// One path on its way.
struct Walk {
    throughput: vec3f,
    /// Scatterings so far.
    scatterings: u32,
    /// Of the direction of the last scattering, per steradian.
    density: f32,
    /// Distance along the camera's axis for each unit of its ray.
    along: f32,
    /// How far it goes says how open its first surface is.
    opens: bool,
}

const NO_SEGMENT: Segment = Segment(vec3f(0.0), vec3f(0.0), 0.0);

fn power_heuristic(own: f32, other: f32) -> f32 {
    let ratio = other / max(own, 1e-30);
    return select(1.0 / (1.0 + ratio * ratio), 0.0, own <= 0.0);
}

fn sample_of(pixel: vec2u, index: u32) -> Sample {
    let bits = firstTrailingBit(knobs.batch);
    let seed = hash_2(hash_2(hash_2(pixel.x, pixel.y), index >> bits), knobs.seed);
    return Sample(seed, index & (knobs.batch - 1u), bits);
}

/// Light that arrives at a surface along a segment, unless something is in between.
struct Towards {
    segment: Segment,
    /// Towards the camera, W/(sr·m²).
    value: vec3f,
}

fn towards_light(random: vec2u, place: vec3f, r: Reflecting, throughput: vec3f) -> Towards {
    let chosen = chosen_emitter(random.x);
    let light = arriving_from(chosen.emitter, place, vec2f(chosen.random, unit_of(random.y)));
    if light.density <= 0.0 {
        return Towards(NO_SEGMENT, vec3f(0.0));
    }
    let reflected = reflected(r, light.to_light);
    let weight = select(power_heuristic(light.density, reflected.density), 1.0, light.extentless);
    let value = throughput * reflected.value * light.light * (weight / light.density);
    if !any(value > vec3f(0.0)) {
        return Towards(NO_SEGMENT, vec3f(0.0));
    }
    if light.extentless || light.distance >= FAR_AWAY {
        return Towards(Segment(place, light.to_light, light.distance), value);
    }
    // Ends on the near side of the emitter, as far off as rays that leave it begin.
    let reach = light.to_light * light.distance + light.plane * light.slack;
    let far = max(length(reach), 1e-30);
    return Towards(Segment(place, reach / far, far), value);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(sample_direct);
    let number = (frame.index % values.bands) * values.band_pixels + id.x;
    if id.x >= values.band_pixels || number >= size.x * size.y {
        return;
    }
    let pixel = vec2u(number % size.x, number / size.x);
    var index = knobs.first_sample + frame.index / values.bands * values.round_samples;
    let end = index + values.round_samples;

    var direct = vec3f(0.0);
    var indirect = vec3f(0.0);
    var openness = 0.0;
    var albedo = vec4f(0.0);
    var normal = vec4f(0.0);
    var rays = 0u;

    var sample = sample_of(pixel, index);
    var walk = Walk(vec3f(0.0), 0u, 0.0, 0.0, false);
    var ray = NO_SEGMENT;
    // What the last surface waits for.
    var light = Towards(NO_SEGMENT, vec3f(0.0));
    var light_is_direct = false;
    var to_open = NO_SEGMENT;

    for (var step = 0u; step < MOST_SURFACES * values.round_samples; step++) {
        if ray.far == 0.0 && index < end {
            sample = sample_of(pixel, index);
            index += 1u;
            let seen = picture_ray((vec2f(pixel) + random_2(sample, 0u)) / vec2f(size));
            let size_of_direction = length(seen.direction);
            let nearest = seen.origin - values.center + seen.direction * camera.near;
            let far = select(FAR_AWAY, depth_to_distance(0.0) - camera.near, camera.parallel > 0.0);
            ray = Segment(nearest, seen.direction / size_of_direction, far);
            walk = Walk(vec3f(1.0), 0u, 0.0, 1.0 / size_of_direction, false);
        }
        @if(count_rays) {
            let present = vec3f(light.segment.far, to_open.far, ray.far) > vec3f(0.0);
            let counted = select(vec3u(0u), vec3u(1u), present);
            rays += counted.x + counted.y + counted.z;
        }
        let traced = trace(array(light.segment, to_open), ray);
        let arrived = select(vec3f(0.0), light.value, (traced.free & 1u) != 0u);
        direct += select(vec3f(0.0), arrived, light_is_direct);
        indirect += select(arrived, vec3f(0.0), light_is_direct);
        openness += select(0.0, 1.0, (traced.free & 2u) != 0u);
        if ray.far == 0.0 {
            break;
        }
        let hit = traced.hit;
        let direction = ray.direction;
        ray.far = 0.0;
        light.segment.far = 0.0;
        to_open.far = 0.0;

        let first = walk.scatterings == 0u;
        let nothing = hit.record == NOTHING;
        openness += select(0.0, 1.0, (nothing && first) || (walk.opens && (nothing || hit.t > values.ao_end)));
        walk.opens = false;
        var found = vec3f(0.0);
        var other_density = 0.0;
        if nothing {
            @if(scene.environment) {
                found = environment_at(direction, 0.0);
                other_density = environment_probability() * environment_density(direction);
            }
            found *= walk.throughput * select(power_heuristic(walk.density, other_density), 1.0, first);
        } else {
            let surface = met(hit, direction);
            @if(scene.emissive) {
                let cosine = abs(dot(surface.plane, direction));
                other_density = surface.density * hit.t * hit.t / max(cosine, 1e-20);
                found = surface.emission * walk.throughput
                    * select(power_heuristic(walk.density, other_density), 1.0, first);
            }
            if first || walk.scatterings != knobs.max_scatterings {
                let base = 2u + DIMENSIONS * walk.scatterings;
                let outside = leaving(surface.position, surface.plane, surface.slack);
                let r = reflecting(
                    surface.normal,
                    surface.plane,
                    -direction,
                    surface.albedo,
                    surface.metallic,
                    surface.roughness,
                );
                light = towards_light(random_words(sample, base), outside, r, walk.throughput);
                light_is_direct = first;

                let choice = random_1(sample, base + 1u);
                let onward = choose_direction(r, random_2(sample, base + 2u), choice);
                let value = reflected(r, onward);
                var throughput = vec3f(0.0);
                if value.density > 0.0 {
                    throughput = walk.throughput * value.value / value.density;
                }
                var survival = 1.0;
                if walk.scatterings + 1u >= ROULETTE_FROM {
                    survival = clamp(max(throughput.x, max(throughput.y, throughput.z)), 0.0, MOST_SURVIVAL);
                }
                let lives = any(throughput > vec3f(0.0))
                    && (survival == 1.0 || random_1(sample, base + 3u) < survival);
                walk.throughput = throughput / max(survival, 1e-30);
                walk.density = value.density;
                if first {
                    albedo += vec4f(surface.albedo, 1.0);
                    normal += vec4f(surface.normal, camera.near + hit.t * walk.along);
                    // A path that goes on by the cosine says itself how open the surface is.
                    if values.ao_end > 0.0 && by_cosine(r, choice) {
                        walk.opens = dot(onward, surface.plane) > 0.0;
                    } else if values.ao_end > 0.0 {
                        let around = cosine_direction(surface.normal, random_2(sample, 1u));
                        to_open = Segment(outside, around, select(0.0, values.ao_end, dot(around, surface.plane) > 0.0));
                    }
                }
                ray = Segment(outside, onward, select(0.0, FAR_AWAY, lives || walk.opens));
            }
        }
        // What is met counts for the scatterings so far.
        direct += select(vec3f(0.0), found, walk.scatterings < 2u);
        indirect += select(found, vec3f(0.0), walk.scatterings < 2u);
        walk.scatterings += 1u;
    }
    textureStore(sample_direct, pixel, vec4f(direct, openness));
    textureStore(sample_indirect, pixel, vec4f(indirect, 0.0));
    textureStore(sample_albedo, pixel, albedo);
    textureStore(sample_normal, pixel, normal);
    @if(count_rays) {
        atomicAdd(&counters.paths, values.round_samples);
        atomicAdd(&counters.rays, rays);
    }
}
