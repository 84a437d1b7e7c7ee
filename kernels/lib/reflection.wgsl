// How surfaces reflect: Lambert, or glTF's metallic-roughness model (glTF 2.0, appendix B.3: Lambert below a dielectric
// coat of refractive index 1.5, and a metal, mixed; GGX with Smith's separable shadowing, Schlick's Fresnel), and directions
// chosen by it. No clamp; roughness is at least 0.03, below which single floats fail.
//
// Directions are unit vectors away from the surface, seen from the shading normal `n`.

import lib/color;
import lib/math;

/// Roughness squared, at least.
const LEAST_ALPHA: f32 = 0.0009;

/// What a dielectric reflects of light that arrives along its normal.
const COAT: f32 = 0.04;

struct Reflecting {
    n: vec3f,
    /// Of the triangle, on the same side.
    plane: vec3f,
    /// Towards where the light goes.
    to_viewer: vec3f,
    diffuse: vec3f,
    @if(!diffuse_only) f0: vec3f,
    @if(!diffuse_only) alpha: f32,
    /// Of choosing a direction by the gloss.
    @if(!diffuse_only) glossy: f32,
}

/// What a direction is worth.
struct Reflected {
    /// Reflected radiance to arriving radiance, times the cosine.
    value: vec3f,
    /// Of `choose_direction`, per steradian.
    density: f32,
}

fn reflecting(n: vec3f, plane: vec3f, to_viewer: vec3f, albedo: vec3f, metallic: f32, roughness: f32) -> Reflecting {
    var out: Reflecting;
    out.n = n;
    out.plane = plane;
    out.to_viewer = to_viewer;
    out.diffuse = albedo;
    @if(!diffuse_only) {
        out.diffuse = albedo * (1.0 - metallic);
        out.f0 = mix(vec3f(COAT), albedo, metallic);
        out.alpha = max(roughness * roughness, LEAST_ALPHA);
        let f = luminance(fresnel(out.f0, max(dot(n, to_viewer), 0.0)));
        let rest = luminance(out.diffuse) * (1.0 - f);
        out.glossy = select(clamp(f / max(f + rest, 1e-6), 0.1, 0.9), 1.0, rest <= 0.0);
    }
    return out;
}

@if(!diffuse_only)
fn fresnel(f0: vec3f, cosine: f32) -> vec3f {
    let x = clamp(1.0 - cosine, 0.0, 1.0);
    let x2 = x * x;
    return f0 + (1.0 - f0) * (x2 * x2 * x);
}

/// D of GGX, per steradian of half vectors.
@if(!diffuse_only)
fn ggx(alpha: f32, cosine: f32) -> f32 {
    let a2 = alpha * alpha;
    let d = (cosine * cosine) * (a2 - 1.0) + 1.0;
    return a2 / (PI * d * d);
}

/// G1 / (2 cos): Smith's shadowing in one direction.
@if(!diffuse_only)
fn smith(alpha: f32, cosine: f32) -> f32 {
    let a2 = alpha * alpha;
    return 1.0 / (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine));
}

fn reflected(r: Reflecting, to_light: vec3f) -> Reflected {
    let cosine = dot(r.n, to_light);
    var out = Reflected(vec3f(0.0), 0.0);
    let cosine_density = max(cosine, 0.0) / PI;
    // Below the triangle's own plane there is nothing.
    let seen = cosine > 0.0 && dot(r.plane, to_light) > 0.0;
    @if(diffuse_only) {
        out.density = cosine_density;
        if seen {
            out.value = r.diffuse * cosine_density;
        }
    }
    @if(!diffuse_only) {
        // A viewer below the shading normal's horizon sees the grazing surface.
        let view_cosine = max(dot(r.n, r.to_viewer), 1e-4);
        let half_vector = unit_or(r.to_viewer + to_light, r.n);
        let half_cosine = clamp(dot(r.n, half_vector), 0.0, 1.0);
        let d = ggx(r.alpha, half_cosine);
        let view_smith = smith(r.alpha, view_cosine);
        // Of visible normals, mirrored: G1 D / (4 cos).
        out.density = mix(cosine_density, 0.5 * d * view_smith, r.glossy);
        if cosine <= 0.0 {
            out.density = 0.5 * d * view_smith * r.glossy;
        }
        if seen {
            let half_way = dot(r.to_viewer, half_vector);
            let gloss = d * view_smith * smith(r.alpha, cosine) * fresnel(r.f0, half_way);
            // What the metal reflects does not dim the rest beside it.
            let coat = fresnel(vec3f(COAT), half_way);
            out.value = (1.0 - coat) * r.diffuse * cosine_density + gloss * cosine;
        }
    }
    return out;
}

/// A direction around `n`, dense as its cosine.
fn cosine_direction(n: vec3f, random: vec2f) -> vec3f {
    let radius = sqrt(random.x);
    let angle = 2.0 * PI * random.y;
    let up = sqrt(max(1.0 - random.x, 0.0));
    return frame_around(n) * vec3f(radius * cos(angle), up, radius * sin(angle));
}

/// Whether `choose_direction` takes a direction around the normal, dense as its cosine.
fn by_cosine(r: Reflecting, choice: f32) -> bool {
    @if(!diffuse_only) {
        return choice >= r.glossy;
    }
    @if(diffuse_only) {
        return true;
    }
}

fn choose_direction(r: Reflecting, random: vec2f, choice: f32) -> vec3f {
    @if(!diffuse_only) {
        if !by_cosine(r, choice) {
            // Visible normals by a spherical cap (Dupuy and Benyoub 2023).
            let frame = frame_around(r.n);
            let view = transpose(frame) * r.to_viewer;
            let above = max(view.y, 1e-4);
            let stretched = normalize(vec3f(r.alpha * view.x, above, r.alpha * view.z));
            let angle = 2.0 * PI * random.x;
            let height = (1.0 - random.y) * (1.0 + stretched.y) - stretched.y;
            let radius = sqrt(clamp(1.0 - height * height, 0.0, 1.0));
            let cap = vec3f(radius * cos(angle), height, radius * sin(angle)) + stretched;
            let m = frame * unit_or(vec3f(r.alpha * cap.x, max(cap.y, 0.0), r.alpha * cap.z), vec3f(0.0, 1.0, 0.0));
            return unit_or(2.0 * dot(r.to_viewer, m) * m - r.to_viewer, r.n);
        }
    }
    return cosine_direction(r.n, random);
}
