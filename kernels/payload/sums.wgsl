// Module of the role `payload`: sums of albedo, normal, position and emission over the fragments of each voxel (a
// fragment: one triangle in one voxel), in fixed point, so that no order of the threads changes a bit (lib/sum_words).
//
// A fragment's attributes are those of the triangle's point nearest to the voxel's centre, images filtered to the width
// of a voxel. Normals are those of the corners, not of normal maps: what a map shows is finer than a voxel.
// Reads per triangle 3 corners (ca. 400 B); per fragment 8 texels (×2 where it emits) for textured materials; writes per
// fragment 10 atomic words (13).

import lib/fill;
import lib/fixed;
import lib/grid;
import lib/material;
import lib/nearest;
import lib/scene;
import lib/sum_words;

@if(scene.emissive)
struct SceneFacts {
    /// Largest component of the radiance that any material emits: the unit of their sums.
    max_emission: f32,
}

@if(scene.emissive)
var<uniform> scene: SceneFacts;

@if(geometry.moving) var<storage, read_write> moving_sums: array<atomic<u32>>;
@else var<storage, read_write> sums: array<atomic<u32>>;

/// Returns what it was.
fn add_word(at: u32, value: u32) -> u32 {
    @if(geometry.moving) {
        return atomicAdd(&moving_sums[at], value);
    } @else {
        return atomicAdd(&sums[at], value);
    }
}

struct Surface {
    /// In voxels.
    corners: array<vec3f, 3>,
    face: Face,
    /// Width of a voxel in each set of texture coordinates.
    footprint: vec2f,
}

fn uv_area(a: vec2f, b: vec2f, c: vec2f) -> f32 {
    return 0.5 * abs(determinant(mat2x2f(b - a, c - a)));
}

fn uv_footprint(face: Face) -> vec2f {
    let a = face.corners[0].uv;
    let b = face.corners[1].uv;
    let c = face.corners[2].uv;
    let areas = vec2f(uv_area(a.xy, b.xy, c.xy), uv_area(a.zw, b.zw, c.zw));
    return values.voxel_size * sqrt(areas / max(face.area, 1e-30));
}

/// `corners`: the triangle's, in voxels.
fn surface_of(triangle: u32, corners: array<vec3f, 3>) -> Surface {
    let face = face_of(triangle);
    return Surface(corners, face, uv_footprint(face));
}

/// Holes of masked materials have no fragments.
fn add_fragment(surface: Surface, voxel: vec3u) {
    let weights = nearest_weights(surface.corners, vec3f(voxel) + 0.5);
    let c = surface.face.corners;
    let uv = weights.x * c[0].uv + weights.y * c[1].uv + weights.z * c[2].uv;
    var base = base_color_at(surface.face.material, uv, surface.footprint);
    @if(scene.vertex_colors) {
        base *= weights.x * c[0].color + weights.y * c[1].color + weights.z * c[2].color;
    }
    if is_hole(surface.face.material, base.a) {
        return;
    }
    let n = unit_or(
        weights.x * c[0].normal + weights.y * c[1].normal + weights.z * c[2].normal,
        surface.face.normal,
    );
    let p = weights.x * surface.corners[0] + weights.y * surface.corners[1] + weights.z * surface.corners[2];
    let within = p - vec3f(voxel);
    let number = voxel_number(voxel);
    let at = number * SUM_WORDS;
    let before = add_word(at, 1u);
    if before >= MOST_TERMS {
        return;
    }
    if before == 0u {
        mark_filled(number);
    }
    for (var i = 0u; i < 3u; i++) {
        add_word(at + SUM_ALBEDO + i, fixed_unsigned(base[i]));
        add_word(at + SUM_NORMAL + i, fixed_signed(n[i]));
        add_word(at + SUM_WITHIN + i, fixed_unsigned(within[i]));
    }
    @if(scene.emissive) {
        let emission = emission_at(surface.face.material, uv, surface.footprint) / max(scene.max_emission, 1e-30);
        for (var i = 0u; i < 3u; i++) {
            if emission[i] > 0.0 {
                add_word(at + SUM_EMISSION + i, fixed_unsigned(emission[i]));
            }
        }
    }
}
