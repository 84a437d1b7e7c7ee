// Depth of the scene from a light: one layer of the light maps.
//
// Reversed depth (1 near, 0 far). Both sides of every surface; holes of masked materials stay open.
// Reads per vertex: a triangle (16 B), a vertex (32 B, or 64 B), an instance (64 B); per fragment of masked materials 4 to
// 8 texels.

import lib/scene;
@if(scene.masked) import lib/material;

struct ViewFacts {
    view_projection: mat4x4f,
}

var<uniform> view: ViewFacts;

struct Varying {
    @builtin(position) clip: vec4f,
    @if(scene.masked) @location(0) uv: vec4f,
    @if(scene.masked) @location(1) @interpolate(flat) material: u32,
    @if(scene.masked && scene.vertex_colors) @location(2) opacity: f32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let instance = triangles[index / 3u].instance;
    let number = vertex_of(index);
    var out: Varying;
    out.clip = view.view_projection * vec4f(corner_position(number, instance), 1.0);
    @if(scene.masked) {
        out.uv = corner_uv(number);
        out.material = instances[instance].material;
        @if(scene.vertex_colors) {
            out.opacity = corner_color(number).a;
        }
    }
    return out;
}

@if(scene.masked)
@fragment
fn fragment(in: Varying) {
    let footprint = footprint_of(dpdx(in.uv), dpdy(in.uv));
    var opacity = base_color_at(in.material, in.uv, footprint).a;
    @if(scene.vertex_colors) {
        opacity *= in.opacity;
    }
    if is_hole(in.material, opacity) {
        discard;
    }
}
