// Voxelizes with one fragment for each column of each triangle (R 4.1.2).
//
// Most triangles are small: a fragment solves the tests of its triangle itself, since what a vertex hands on costs the
// rasterizer more. Large ones are better off in voxelize/deferred.
// Reads per vertex 3 corners; per fragment what the payload wants; writes per fragment what the payload does.

import lib/outline;

struct Knobs {
    separability: u32,
}

struct Outlined {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) a: vec4i,
    @location(1) @interpolate(flat) b: vec4i,
    @location(2) @interpolate(flat) c: vec4i,
    @location(3) @interpolate(flat) normal: vec3f,
    @location(4) @interpolate(flat) first: vec3i,
    @location(5) @interpolate(flat) size: vec3i,
}

var<uniform> knobs: Knobs;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Outlined {
    let there = placed_of(index / 3u);
    // Left early: with a single way out a dragon of 202,520 triangles took more than twice as long on lavapipe.
    if !there.meets {
        var nothing: Outlined;
        nothing.clip = vec4f(2.0, 2.0, 0.5, 1.0);
        return nothing;
    }
    let placed = placed_along(there, there.facing.axis);
    let clip = outline_vertex(placed, index % 3u, knobs.separability);
    let corners = packed_corners(placed);
    return Outlined(clip, corners[0], corners[1], corners[2], placed.facing.normal, placed.first, placed.size);
}

@fragment
fn fragment(in: Outlined) {
    let placed = placed_by(array(in.a, in.b, in.c), in.normal, in.first, in.size);
    let p = column_at(in.clip, placed);
    if !is_column(p, placed) {
        return;
    }
    fill_column(placed, prepared(placed, knobs.separability), p);
}
