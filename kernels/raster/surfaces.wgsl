// The surfaces that the camera sees: albedo, normals, emission, depth.
//
// Normals point to the camera's side: every surface reflects on both sides. Emission leaves the front only, unless the
// material is double-sided. Holes of masked materials stay open. Images are filtered to a pixel's longer side, normal
// maps as vectors.
// Reads per vertex: a triangle with 3 corners (ca. 400 B, 500 B with extras); per fragment a material and 4 to 8 texels
// for each image.

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
    @location(2) uv: vec4f,
    @location(3) @interpolate(flat) face_normal: vec3f,
    @location(4) @interpolate(flat) material: u32,
    @if(scene.vertex_colors) @location(5) color: vec4f,
    @if(scene.normal_mapped) @location(6) tangent: vec4f,
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
    @if(scene.vertex_colors) {
        out.color = corner.color;
    }
    @if(scene.normal_mapped) {
        out.tangent = corner_tangent(vertex_of(index), triangles[index / 3u].instance);
    }
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
    let footprint = footprint_of(dpdx(in.uv), dpdy(in.uv));
    var base = base_color_at(in.material, in.uv, footprint);
    @if(scene.vertex_colors) {
        base *= in.color;
    }
    if is_hole(in.material, base.a) {
        discard;
    }
    let to_camera = mix(camera.position - in.position, -camera.forward, camera.parallel);
    let front = dot(in.face_normal, to_camera) >= 0.0;
    let side = select(-1.0, 1.0, front);
    let face_normal = in.face_normal * side;
    let smooth_normal = outward(unit_or(in.normal, in.face_normal) * side, face_normal, face_normal);
    var out: Targets;
    out.albedo = vec4f(base.rgb, 1.0);
    out.face_normal = vec4f(face_normal, 0.0);
    out.normal = vec4f(smooth_normal, 0.0);
    @if(scene.normal_mapped) {
        let map = normal_map_at(in.material, in.uv, footprint);
        let mapped = mapped_normal(map, in.normal, in.tangent) * side;
        out.normal = vec4f(outward(mapped, face_normal, smooth_normal), 0.0);
    }
    @if(scene.emissive) {
        let double_sided = (materials[in.material].flags & MATERIAL_DOUBLE_SIDED) != 0u;
        let emission = emission_at(in.material, in.uv, footprint);
        // The target is of half floats.
        out.emission = vec4f(min(select(vec3f(0.0), emission, front || double_sided), vec3f(65504.0)), 0.0);
    }
    return out;
}
