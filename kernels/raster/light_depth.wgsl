// Depth of the scene from a light: one layer of the light maps.
//
// Reversed depth (1 near, 0 far). Both sides of every surface; holes of masked materials stay open.
// Reads per vertex: a triangle (16 B), a vertex (32 B), an instance (64 B); per fragment of masked materials 4 to 8
// texels.

import lib/scene;
@if(scene.masked) import lib/material;

struct ViewFacts {
    view_projection: mat4x4f,
}

var<uniform> view: ViewFacts;

struct Varying {
    @builtin(position) clip: vec4f,
    @if(scene.masked) @location(0) uv: vec2f,
    @if(scene.masked) @location(1) @interpolate(flat) material: u32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let instance = triangles[index / 3u].instance;
    let number = vertex_of(index);
    var out: Varying;
    out.clip = view.view_projection * vec4f(corner_position(number, instance), 1.0);
    @if(scene.masked) {
        out.uv = vec2f(vertices[number].u, vertices[number].v);
        out.material = instances[instance].material;
    }
    return out;
}

@if(scene.masked)
@fragment
fn fragment(in: Varying) {
    let footprint = max(length(dpdx(in.uv)), length(dpdy(in.uv)));
    if is_hole(in.material, base_color_at(in.material, in.uv, footprint).a) {
        discard;
    }
}
