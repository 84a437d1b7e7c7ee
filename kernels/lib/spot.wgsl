// Spot cones: KHR_lights_punctual's formula.

/// Share of its intensity that a spot light sends along a direction; `cosine`: of the angle to its axis.
fn spot_share(cosine: f32, cos_outer: f32, cos_inner: f32) -> f32 {
    let t = clamp((cosine - cos_outer) / max(cos_inner - cos_outer, 0.001), 0.0, 1.0);
    return t * t;
}
