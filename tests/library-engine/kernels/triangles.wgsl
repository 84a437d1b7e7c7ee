// The number of each triangle, from 1.

import lib/scene;

struct Camera {
    view_projection: mat4x4f,
}

var<uniform> camera: Camera;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) number: u32,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Varying {
    let position = corner_position(vertex_of(i), triangles[i / 3u].instance);
    return Varying(camera.view_projection * vec4f(position, 1.0), i / 3u + 1u);
}

struct Targets {
    @location(0) shade: u32,
}

@fragment
fn fragment(in: Varying) -> Targets {
    return Targets(in.number);
}
