// The picture: direct light of each pixel's surface and, with the indirect light, all of it.
//
// direct = emission that the camera sees + ρ/π · Σ E max(0, n·l) S over the lights (R eq. 7.1, corrected: E the
// irradiance facing the light, ρ once) + what emitting surfaces add, as traced. A light behind the triangle's plane
// adds nothing. Radiances, W/(sr·m²); where there is no surface, that of the environment. `linear_depth`: metres along the camera's
// forward axis, 0 where there is no surface.
// Reads per pixel: up to 7 texels, per light 64 + 112 B and 4 depths; writes 3 texels.

import lib/camera;
import lib/math;
@if(scene.environment) import lib/environment;
@if(lights.total > 0) import lib/lights;

var depth: texture_depth_2d;
var albedo: texture_2d<f32>;
@if(lights.total > 0)
var normal: texture_2d<f32>;
@if(lights.total > 0)
var face_normal: texture_2d<f32>;
@if(scene.emissive)
var emission: texture_2d<f32>;
@if(scene.emissive || scene.environment)
var emissive_light: texture_2d<f32>;
var indirect: texture_2d<f32>;
var direct: texture_storage_2d<rgba32float, write>;
var color: texture_storage_2d<rgba32float, write>;
var linear_depth: texture_storage_2d<r32float, write>;

/// Σ E max(0, n·l) S.
@if(lights.total > 0)
fn irradiance(position: vec3f, n: vec3f, plane: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < lighting.total; i++) {
        let light = lights[i];
        let arriving = arrival(light, position);
        let cosine = dot(n, arriving.to_light);
        if cosine > 0.0 && dot(plane, arriving.to_light) > 0.0 && any(arriving.irradiance > vec3f(0.0)) {
            sum += arriving.irradiance * (cosine * visibility(light, arriving, position, plane, 0.0));
        }
    }
    return sum;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(direct);
    if any(id.xy >= size) {
        return;
    }
    let pixel = id.xy;
    let seen = textureLoad(depth, pixel, 0);
    var light = vec3f(0.0);
    var far = 0.0;
    if seen > 0.0 {
        far = depth_to_distance(seen);
        @if(lights.total > 0) {
            let plane = unit_or(textureLoad(face_normal, pixel, 0).xyz, vec3f(0.0, 1.0, 0.0));
            let n = unit_or(textureLoad(normal, pixel, 0).xyz, plane);
            let rho = textureLoad(albedo, pixel, 0).rgb;
            light += rho / PI * irradiance(pixel_position(pixel, size, seen), n, plane);
        }
        @if(scene.emissive) {
            light += textureLoad(emission, pixel, 0).rgb;
        }
        @if(scene.emissive || scene.environment) {
            light += textureLoad(emissive_light, pixel, 0).rgb;
        }
    } else {
        @if(scene.environment) {
            let width = 2.0 * length(camera.up) / f32(size.y);
            light = environment_at(normalize(pixel_ray(pixel, size).direction), (1.0 - camera.parallel) * width);
        }
    }
    textureStore(direct, pixel, vec4f(light, 1.0));
    textureStore(color, pixel, vec4f(light + textureLoad(indirect, pixel, 0).rgb, 1.0));
    textureStore(linear_depth, pixel, vec4f(far, 0.0, 0.0, 1.0));
}
