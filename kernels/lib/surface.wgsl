// What a payload can know of a fragment (one triangle in one voxel), images filtered to the width of a voxel.
//
// Normals are those of the corners, not of normal maps: what a map shows is finer than a voxel.
// Reads per triangle 3 corners (ca. 400 B); per fragment 8 texels (×2 where it emits) for textured materials.

import lib/grid;
import lib/material;
import lib/piece;
import lib/scene;

@if(scene.emissive)
struct SceneFacts {
    /// Largest component of the radiance that any material emits.
    max_emission: f32,
}

@if(scene.emissive)
var<uniform> scene: SceneFacts;

struct Surface {
    /// In voxels.
    corners: array<vec3f, 3>,
    face: Face,
    /// Width of a voxel in each set of texture coordinates.
    footprint: vec2f,
}

struct Fragment {
    albedo: vec3f,
    /// Unit length.
    normal: vec3f,
    /// Position in the voxel, [0, 1]; of what only touches it, on its side.
    within: vec3f,
    /// Radiance, in units of the scene's greatest emission.
    @if(scene.emissive) emission: vec3f,
    /// There is nothing: a hole of a masked material.
    hole: bool,
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

fn fragment_of(surface: Surface, voxel: vec3u, piece: Piece) -> Fragment {
    let weights = piece.weights;
    let c = surface.face.corners;
    let uv = weights.x * c[0].uv + weights.y * c[1].uv + weights.z * c[2].uv;
    var base = base_color_at(surface.face.material, uv, surface.footprint);
    @if(scene.vertex_colors) {
        base *= weights.x * c[0].color + weights.y * c[1].color + weights.z * c[2].color;
    }
    let n = unit_or(
        weights.x * c[0].normal + weights.y * c[1].normal + weights.z * c[2].normal,
        surface.face.normal,
    );
    var out: Fragment;
    out.hole = is_hole(surface.face.material, base.a);
    out.albedo = base.rgb;
    out.normal = n;
    out.within = clamp(piece.middle - vec3f(voxel), vec3f(0.0), vec3f(1.0));
    @if(scene.emissive) {
        out.emission = emission_at(surface.face.material, uv, surface.footprint) / max(scene.max_emission, 1e-30);
    }
    return out;
}
