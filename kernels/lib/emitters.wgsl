// Light from an emitter chosen at random: point, spot and directional lights, emissive triangles, the environment.
//
// Positions are metres from `scene.center`. The engine gives the probabilities and the alias table. `range` is ignored.
// Cost: an emitter 80 B or two; of a triangle with a texture 3 vertices and 4 texels, with holes twice that; of the
// environment some 20 elements to find a texel by halving, and 8 for its radiance.

@if(scene.environment) import lib/environment_choice;
@if(scene.masked) import lib/holes;
import lib/leaving;
import lib/material;
import lib/math;
import lib/random;
import lib/scene;
import lib/spot;

struct Emitter {
    a: vec3f,
    kind: u32,
    b: vec3f,
    instance: u32,
    c: vec3f,
    probability: f32,
    vertices: vec3u,
    other: u32,
    threshold: f32,
    cos_outer: f32,
    cos_inner: f32,
}

const EMITTER_SPOT: u32 = 1u;
const EMITTER_DIRECTIONAL: u32 = 2u;
const EMITTER_TRIANGLE: u32 = 3u;
const EMITTER_ENVIRONMENT: u32 = 4u;

const FAR_AWAY: f32 = 3e38;

var<storage, read> emitters: array<Emitter>;

struct Arriving {
    /// Unit vector.
    to_light: vec3f,
    /// Metres; FAR_AWAY for a light without a place.
    distance: f32,
    /// Radiance, W/(sr·m²); of a light without extent its irradiance, W/m².
    light: vec3f,
    /// Per steradian, the emitter's probability included; of a light without extent that alone. 0: nothing arrives.
    density: f32,
    /// Of a triangle: its normal towards the point, and the room that rays need at it.
    plane: vec3f,
    slack: f32,
    /// Whether scattered rays can't meet it.
    extentless: bool,
}

struct Chosen {
    emitter: u32,
    /// What is left of the random number: as evenly spread as that was, [0, 1).
    random: f32,
}

fn chosen_emitter(random: u32) -> Chosen {
    let column = scaled(random, arrayLength(&emitters));
    let threshold = emitters[column.x].threshold;
    let rest = unit_of(column.y);
    if rest < threshold {
        return Chosen(column.x, min(rest / threshold, BELOW_ONE));
    }
    return Chosen(emitters[column.x].other, min((rest - threshold) / (1.0 - threshold), BELOW_ONE));
}

fn arriving_from(index: u32, position: vec3f, random: vec2f) -> Arriving {
    let e = emitters[index];
    var out: Arriving;
    out.density = e.probability;
    out.extentless = true;
    out.distance = FAR_AWAY;
    @if(scene.emissive) {
        if e.kind == EMITTER_TRIANGLE {
            return from_triangle(e, position, random);
        }
    }
    @if(scene.environment) {
        if e.kind == EMITTER_ENVIRONMENT {
            let found = environment_choose(random);
            out.to_light = found.xyz;
            out.density = e.probability * found.w;
            out.light = environment_at(found.xyz, 0.0);
            out.extentless = false;
            return out;
        }
    }
    if e.kind == EMITTER_DIRECTIONAL {
        out.to_light = -e.b;
        out.light = e.c;
        return out;
    }
    let d = e.a - position;
    let squared = max(dot(d, d), 1e-12);
    out.distance = sqrt(squared);
    out.to_light = d / out.distance;
    out.light = e.c / squared;
    if e.kind == EMITTER_SPOT {
        out.light *= spot_share(dot(-out.to_light, e.b), e.cos_outer, e.cos_inner);
    }
    return out;
}

/// A point evenly on the triangle.
@if(scene.emissive)
fn from_triangle(e: Emitter, position: vec3f, random: vec2f) -> Arriving {
    let root = sqrt(random.x);
    let w = vec3f(1.0 - root, root * (1.0 - random.y), root * random.y);
    let d = w.x * e.a + w.y * e.b + w.z * e.c - position;
    let squared = max(dot(d, d), 1e-12);
    let n = cross(e.b - e.a, e.c - e.a);
    let doubled = length(n);
    var out: Arriving;
    out.extentless = false;
    out.distance = sqrt(squared);
    out.to_light = d / out.distance;
    let plane = n * (instances[e.instance].flip / max(doubled, 1e-30));
    let cosine = -dot(plane, out.to_light);
    let material = instances[e.instance].material;
    let front = cosine > 0.0 || (materials[material].flags & MATERIAL_DOUBLE_SIDED) != 0u;
    out.plane = select(-plane, plane, cosine > 0.0);
    out.slack = slack_of(e.a, e.b, e.c);
    if !front || cosine == 0.0 {
        return out;
    }
    let ids = e.vertices;
    @if(scene.masked) {
        // A ray would pass there, and meet no emission.
        if materials[material].alpha_cutoff > 0.0 && hole_at(material, ids, w) {
            return out;
        }
    }
    out.density = e.probability * squared / (0.5 * doubled * abs(cosine));
    out.light = emission_at(
        material,
        w.x * corner_uv(ids.x) + w.y * corner_uv(ids.y) + w.z * corner_uv(ids.z),
        vec2f(0.0),
    );
    return out;
}

/// The environment's probability of being chosen; it is the last emitter.
@if(scene.environment)
fn environment_probability() -> f32 {
    let last = emitters[arrayLength(&emitters) - 1u];
    return select(0.0, last.probability, last.kind == EMITTER_ENVIRONMENT);
}
