// The surface that a ray met: place, normals, what it reflects and emits.
//
// Positions are metres from `scene.center`. Images at their full size, bilinear: no footprint. Normals point to where the
// ray came from; a shading normal that turns away from the triangle's side is not used.
// Cost: 3 vertices, an instance, a material, 4 texels for each of its images.

import lib/bvh;
import lib/leaving;
import lib/material;
import lib/math;
import lib/scene;

struct Met {
    position: vec3f,
    /// Of the triangle.
    plane: vec3f,
    /// For shading.
    normal: vec3f,
    albedo: vec3f,
    metallic: f32,
    roughness: f32,
    /// Towards where the ray came from, W/(sr·m²).
    emission: vec3f,
    /// How likely a point chosen by `lib/emitters` lies in a unit of the triangle's area, 1/m².
    density: f32,
    /// Metres; see `leaving`.
    slack: f32,
}

fn met(hit: Hit, direction: vec3f) -> Met {
    let words = array<vec4u, 4>(
        bvh[hit.record],
        bvh[hit.record + 1u],
        bvh[hit.record + 2u],
        bvh[hit.record + 3u],
    );
    let a = bitcast<vec3f>(words[0].xyz);
    let b = bitcast<vec3f>(words[1].xyz);
    let c = bitcast<vec3f>(words[2].xyz);
    let ids = vec3u(words[0].w, words[1].w, words[2].w);
    let instance = words[3].x;
    let material = instances[instance].material;
    let w = vec3f(1.0 - hit.weights.x - hit.weights.y, hit.weights);
    let plane = unit_or(cross(b - a, c - a) * instances[instance].flip, vec3f(0.0));
    let front = dot(plane, direction) <= 0.0;
    let side = select(-1.0, 1.0, front);
    let to_world = instances[instance].normal_to_world;
    let smooth_normal = w.x * unit_or(to_world * vertices[ids.x].normal, vec3f(0.0))
        + w.y * unit_or(to_world * vertices[ids.y].normal, vec3f(0.0))
        + w.z * unit_or(to_world * vertices[ids.z].normal, vec3f(0.0));
    let uv = w.x * corner_uv(ids.x) + w.y * corner_uv(ids.y) + w.z * corner_uv(ids.z);
    var base = base_color_at(material, uv, vec2f(0.0)).rgb;
    @if(scene.vertex_colors) {
        base *= (w.x * corner_color(ids.x) + w.y * corner_color(ids.y) + w.z * corner_color(ids.z)).rgb;
    }
    var out: Met;
    out.position = w.x * a + w.y * b + w.z * c;
    out.slack = slack_of(a, b, c);
    out.plane = plane * side;
    out.normal = outward(unit_or(smooth_normal, plane) * side, out.plane, out.plane);
    @if(scene.normal_mapped) {
        let tangents = array<vec4f, 3>(
            corner_tangent(ids.x, instance),
            corner_tangent(ids.y, instance),
            corner_tangent(ids.z, instance),
        );
        let tangent = w.x * tangents[0] + w.y * tangents[1] + w.z * tangents[2];
        let map = normal_map_at(material, uv, vec2f(0.0));
        out.normal = outward(mapped_normal(map, smooth_normal, tangent) * side, out.plane, out.normal);
    }
    out.albedo = base;
    @if(!diffuse_only) {
        let gloss = metallic_roughness_at(material, uv, vec2f(0.0));
        out.metallic = gloss.x;
        out.roughness = gloss.y;
    }
    out.emission = vec3f(0.0);
    out.density = 0.0;
    @if(scene.emissive) {
        if front || (materials[material].flags & MATERIAL_DOUBLE_SIDED) != 0u {
            out.emission = emission_at(material, uv, vec2f(0.0));
            out.density = bitcast<f32>(words[3].z);
        }
    }
    return out;
}
