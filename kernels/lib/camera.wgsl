// Where the surface seen in a pixel is, from its depth.

struct Camera {
    position: vec3f,
    forward: vec3f,
    /// Scaled by the tangent of half the field of view, as `up` is.
    right: vec3f,
    up: vec3f,
    near: f32,
}

var<uniform> camera: Camera;

/// Point on the ray through the centre of a pixel, one unit along `forward`, relative to the camera.
fn pixel_ray(pixel: vec2u, size: vec2u) -> vec3f {
    let at = (vec2f(pixel) + 0.5) / vec2f(size) * 2.0 - 1.0;
    return camera.forward + at.x * camera.right - at.y * camera.up;
}

/// Distance along `forward`, metres. Depth is reversed with an infinite far plane: `near / distance`, 0 for nothing.
/// (Going by the rays rather than by an inverse matrix keeps the full precision of the depth.)
fn depth_to_distance(depth: f32) -> f32 {
    return camera.near / max(depth, 1e-30);
}

fn pixel_position(pixel: vec2u, size: vec2u, depth: f32) -> vec3f {
    return camera.position + pixel_ray(pixel, size) * depth_to_distance(depth);
}
