// Filled voxels as cubes, from their list (list/filled), shaded by side as debug/filled does, and in their albedo where
// that is to be shown.
//
// Reads a word per vertex, and a voxel per fragment that shows it; writes a texel per fragment.

import lib/grid;
import lib/listed;
@if(shown == "albedo") import role/voxels;

struct Camera {
    view_projection: mat4x4f,
}

var<uniform> camera: Camera;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) shade: f32,
    @if(shown == "albedo") @location(1) @interpolate(flat) voxel: vec3u,
}

/// The corner of a side: 6 of them for each of 3 axes, at its lower and its upper end.
fn cube_corner(vertex: u32) -> vec3u {
    let side = vertex / 6u;
    // 0 1 2, 2 1 3 of a square's corners.
    let corner = array(0u, 1u, 2u, 2u, 1u, 3u)[vertex % 6u];
    let p = vec3u(corner & 1u, corner >> 1u, side & 1u);
    return array(p.zxy, p.yzx, p.xyz)[side / 2u];
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let voxel = listed_voxel(index / 36u);
    let corner = from_grid(vec3f(voxel + cube_corner(index % 36u)));
    let shade = vec3f(0.5, 0.9, 0.65)[index % 36u / 12u];
    var out: Varying;
    out.clip = camera.view_projection * vec4f(corner, 1.0);
    out.shade = shade;
    @if(shown == "albedo") {
        out.voxel = voxel;
    }
    return out;
}

struct Targets {
    @location(0) color: vec4f,
}

@fragment
fn fragment(in: Varying) -> Targets {
    var color = vec3f(in.shade);
    @if(shown == "albedo") {
        color *= surfel_of(in.voxel).albedo;
    }
    return Targets(vec4f(color, 1.0));
}
