// The surfaces that the camera sees: albedo, normals, emission, depth.
//
// Normals point to the camera's side: every surface reflects on both sides. Emission leaves the front only, unless the
// material is double-sided. Holes of masked materials stay open. Images are filtered to a pixel's longer side.
// Reads per vertex: a triangle with 3 corners (ca. 400 B); per fragment a material and 4 to 8 texels for each image.

import lib/material;
import lib/scene;

struct Camera {
    view_projection: mat4x4f,
    position: vec3f,
    forward: vec3f,
    parallel: f32,
}

var<uniform> camera: Camera;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) @interpolate(flat) face_normal: vec3f,
    @location(4) @interpolate(flat) material: u32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let face = face_of(index / 3u);
    var corners = face.corners;
    let corner = corners[index % 3u];
    var out: Varying;
    out.clip = camera.view_projection * vec4f(corner.position, 1.0);
    out.position = corner.position;
    out.normal = corner.normal;
    out.uv = corner.uv;
    out.face_normal = face.normal;
    out.material = face.material;
    return out;
}

struct Targets {
    /// a is 1 where there is a surface.
    @location(0) albedo: vec4f,
    /// Shading normal, world space, unit length.
    @location(1) normal: vec4f,
    /// Normal of the triangle, world space, unit length.
    @location(2) face_normal: vec4f,
    /// Radiance towards the camera, W/(sr·m²).
    @if(scene.emissive) @location(3) emission: vec4f,
}

@fragment
fn fragment(in: Varying) -> Targets {
    let footprint = max(length(dpdx(in.uv)), length(dpdy(in.uv)));
    let base = base_color_at(in.material, in.uv, footprint);
    if is_hole(in.material, base.a) {
        discard;
    }
    let to_camera = mix(camera.position - in.position, -camera.forward, camera.parallel);
    let front = dot(in.face_normal, to_camera) >= 0.0;
    let side = select(-1.0, 1.0, front);
    let face_normal = in.face_normal * side;
    let smooth_normal = unit_or(in.normal, in.face_normal) * side;
    var out: Targets;
    out.albedo = vec4f(base.rgb, 1.0);
    out.face_normal = vec4f(face_normal, 0.0);
    // Interpolated normals that turn away from the triangle's own side light it from behind: the triangle's is taken.
    out.normal = vec4f(select(face_normal, smooth_normal, dot(smooth_normal, face_normal) > 0.0), 0.0);
    @if(scene.emissive) {
        let double_sided = (materials[in.material].flags & MATERIAL_DOUBLE_SIDED) != 0u;
        let emission = emission_at(in.material, in.uv, footprint);
        out.emission = vec4f(select(vec3f(0.0), emission, front || double_sided), 0.0);
    }
    return out;
}
