// Where the surface seen in a pixel is, from its depth; for perspective and orthographic cameras alike.

struct Camera {
    position: vec3f,
    /// Metres along `forward`; nothing nearer is seen.
    near: f32,
    forward: vec3f,
    /// Half the picture's width at distance 1, as `up` is half its height.
    right: vec3f,
    up: vec3f,
    /// 1 for an orthographic camera, whose rays are parallel, else 0.
    parallel: f32,
    distance: vec4f,
}

var<uniform> camera: Camera;

struct Ray {
    origin: vec3f,
    /// One unit along `camera.forward`.
    direction: vec3f,
}

/// The ray through the centre of a pixel.
fn pixel_ray(pixel: vec2u, size: vec2u) -> Ray {
    return picture_ray((vec2f(pixel) + 0.5) / vec2f(size));
}

/// The ray through a point of the picture: (0, 0) is its upper left corner, (1, 1) its lower right one.
fn picture_ray(point: vec2f) -> Ray {
    let at = 2.0 * point - 1.0;
    let aside = at.x * camera.right - at.y * camera.up;
    return Ray(camera.position + camera.parallel * aside, camera.forward + (1.0 - camera.parallel) * aside);
}

/// Distance along `forward`, metres. Depth is reversed: 1 at the near plane; 0 for nothing.
/// (Going by the rays rather than by an inverse matrix keeps the full precision of the depth.)
fn depth_to_distance(depth: f32) -> f32 {
    let c = camera.distance;
    return (c.x + c.y * depth) / max(c.z + c.w * depth, 1e-30);
}

fn pixel_position(pixel: vec2u, size: vec2u, depth: f32) -> vec3f {
    let ray = pixel_ray(pixel, size);
    return ray.origin + ray.direction * depth_to_distance(depth);
}
