// Weights (barycentric coordinates) of the point of a triangle that is nearest to a point.
//
// Always in [0, 1] with sum 1, slivers and triangles without area included: the plane's point where it lies inside,
// else the best of the three edges (Ericson 2004, "Real-Time Collision Detection", 5.1.5, by edges).

/// Position along the segment from 0 to `edge`, in [0, 1], nearest to `p`.
fn along_edge(edge: vec3f, p: vec3f) -> f32 {
    return clamp(dot(edge, p) / max(dot(edge, edge), 1e-30), 0.0, 1.0);
}

fn squared(v: vec3f) -> f32 {
    return dot(v, v);
}

fn nearest_weights(corners: array<vec3f, 3>, p: vec3f) -> vec3f {
    let ab = corners[1] - corners[0];
    let bc = corners[2] - corners[1];
    let ca = corners[0] - corners[2];
    let n = cross(ab, bc);
    let area = dot(n, n);
    if area > 0.0 {
        let to_b = p - corners[1];
        let a = dot(cross(bc, to_b), n) / area;
        let b = dot(cross(ca, p - corners[2]), n) / area;
        let c = 1.0 - a - b;
        if min(a, min(b, c)) >= 0.0 {
            return vec3f(a, b, c);
        }
    }
    let s = along_edge(ab, p - corners[0]);
    let t = along_edge(bc, p - corners[1]);
    let u = along_edge(ca, p - corners[2]);
    let d = vec3f(
        squared(p - corners[0] - s * ab),
        squared(p - corners[1] - t * bc),
        squared(p - corners[2] - u * ca),
    );
    if d.x <= d.y && d.x <= d.z {
        return vec3f(1.0 - s, s, 0.0);
    }
    if d.y <= d.z {
        return vec3f(0.0, 1.0 - t, t);
    }
    return vec3f(u, 0.0, 1.0 - u);
}
