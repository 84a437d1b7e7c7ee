// Voxelizes the triangles of a list with one fragment for each of their columns (R 4.1.2, figure 4.15).
//
// They are large: tests are solved once for each vertex, and handed on to all its fragments.
// Reads per vertex a word and 3 corners; per fragment what the payload wants; writes per fragment what the payload does.

import lib/outline;

struct Knobs {
    separability: u32,
}

struct Outlined {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) a: vec4i,
    @location(1) @interpolate(flat) b: vec4i,
    @location(2) @interpolate(flat) c: vec4i,
    @location(3) @interpolate(flat) first: vec3i,
    @location(4) @interpolate(flat) size: vec3i,
    // `Bounds`; `plane_doubt` is the w of the first.
    @location(5) @interpolate(flat) xy_place: vec4f,
    @location(6) @interpolate(flat) xy_slope: vec3f,
    @location(7) @interpolate(flat) xy_doubt: vec3f,
    @location(8) @interpolate(flat) yz_place: vec3f,
    @location(9) @interpolate(flat) yz_slope: vec3f,
    @location(10) @interpolate(flat) yz_doubt: vec3f,
    @location(11) @interpolate(flat) zx_place: vec3f,
    @location(12) @interpolate(flat) zx_slope: vec3f,
    @location(13) @interpolate(flat) zx_doubt: vec3f,
    @location(14) @interpolate(flat) plane: vec4f,
}

var<uniform> knobs: Knobs;
var<storage, read> large: array<u32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Outlined {
    let there = placed_of(large[index / 3u]);
    let placed = placed_along(there, select(there.facing.axis, BIT_AXIS, MOST_AT_ONCE > 1u));
    let corners = packed_corners(placed);
    let bounds = bounds_of(asked_about(placed, knobs.separability), placed.facing, placed.size);
    return Outlined(
        outline_vertex(placed, index % 3u, knobs.separability),
        corners[0],
        corners[1],
        corners[2],
        placed.first,
        placed.size,
        vec4f(bounds.xy.place, bounds.plane_doubt),
        bounds.xy.slope,
        bounds.xy.doubt,
        bounds.yz.place,
        bounds.yz.slope,
        bounds.yz.doubt,
        bounds.zx.place,
        bounds.zx.slope,
        bounds.zx.doubt,
        bounds.plane,
    );
}

@fragment
fn fragment(in: Outlined) {
    // Of the normal no more than its signs is needed here.
    let placed = placed_by(array(in.a, in.b, in.c), vec3f(0.0), in.first, in.size);
    let p = column_at(in.clip, placed);
    if !is_column(p, placed) {
        return;
    }
    let bounds = Bounds(
        Sides(in.xy_place.xyz, in.xy_slope, in.xy_doubt),
        Sides(in.yz_place, in.yz_slope, in.yz_doubt),
        Sides(in.zx_place, in.zx_slope, in.zx_doubt),
        in.plane,
        in.xy_place.w,
    );
    let overlap = overlap_of(asked_about(placed, knobs.separability), bounds, placed.size.z);
    fill_column(placed, overlap, p);
}
