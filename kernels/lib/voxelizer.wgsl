// What a thread does that voxelizes a triangle: it adds the triangle's fragments to the voxels' sums. The kernel that
// imports this says in `first_touch` what is to be done with a voxel that had none before.
//
// Source: R 4.1.1 (triangle-parallel), tests in lib/overlap. A fragment's attributes are those of the triangle's point
// nearest to the voxel's centre, images filtered to the width of a voxel.
// Normals are those of the corners, not of normal maps: what a map shows is finer than a voxel.
// Reads per thread: a triangle with 3 corners (ca. 400 B); per fragment 8 texels (×2 where it emits) for textured
// materials; writes per fragment 10 atomic words (13). One thread walks all columns of its triangle: large triangles
// are slow (R figure 4.6).

import lib/fixed;
import lib/grid;
import lib/material;
import lib/nearest;
import lib/overlap;
import lib/scene;
import lib/sum_words;

struct Knobs {
    resolution: u32,
    separability: u32,
}

var<uniform> knobs: Knobs;

@if(scene.emissive)
struct SceneFacts {
    /// Largest component of the radiance that any material emits: the unit of their sums.
    max_emission: f32,
}

@if(scene.emissive)
var<uniform> scene: SceneFacts;

var<storage, read_write> sums: array<atomic<u32>>;

/// A triangle ready to be put into voxels.
struct Source {
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

/// Returns whether there was something to add: holes of masked materials have no fragments.
fn add_fragment(source: Source, voxel: vec3i) -> bool {
    let weights = nearest_weights(source.corners, vec3f(voxel) + 0.5);
    let c = source.face.corners;
    let uv = weights.x * c[0].uv + weights.y * c[1].uv + weights.z * c[2].uv;
    var base = base_color_at(source.face.material, uv, source.footprint);
    @if(scene.vertex_colors) {
        base *= weights.x * c[0].color + weights.y * c[1].color + weights.z * c[2].color;
    }
    if is_hole(source.face.material, base.a) {
        return false;
    }
    let n = unit_or(
        weights.x * c[0].normal + weights.y * c[1].normal + weights.z * c[2].normal,
        source.face.normal,
    );
    let p = weights.x * source.corners[0] + weights.y * source.corners[1] + weights.z * source.corners[2];
    let within = p - vec3f(voxel);
    let number = voxel_number(vec3u(voxel), knobs.resolution);
    let at = number * SUM_WORDS;
    let before = atomicAdd(&sums[at], 1u);
    if before >= MOST_TERMS {
        return false;
    }
    if before == 0u {
        first_touch(number);
    }
    for (var i = 0u; i < 3u; i++) {
        atomicAdd(&sums[at + SUM_ALBEDO + i], fixed_unsigned(base[i]));
        atomicAdd(&sums[at + SUM_NORMAL + i], fixed_signed(n[i]));
        atomicAdd(&sums[at + SUM_WITHIN + i], fixed_unsigned(within[i]));
    }
    @if(scene.emissive) {
        let emission = emission_at(source.face.material, uv, source.footprint) / max(scene.max_emission, 1e-30);
        for (var i = 0u; i < 3u; i++) {
            if emission[i] > 0.0 {
                atomicAdd(&sums[at + SUM_EMISSION + i], fixed_unsigned(emission[i]));
            }
        }
    }
    return true;
}

/// Returns how many fragments it added.
fn voxelize(triangle: u32) -> u32 {
    let face = face_of(triangle);
    var corners: array<vec3i, 3>;
    for (var i = 0u; i < 3u; i++) {
        corners[i] = snapped(to_grid(face.corners[i].position));
    }
    let last = vec3i(i32(knobs.resolution) - 1);
    let least = voxel_of(min(corners[0], min(corners[1], corners[2])));
    let greatest = voxel_of(max(corners[0], max(corners[1], corners[2])));
    if any(least > last) || any(greatest < vec3i(0)) {
        return 0u;
    }
    let low = max(least, vec3i(0));
    let size = min(greatest, last) - low;
    let normal = normal_of(corners);
    let flat = all(normal[0] == vec2u(0u)) && all(normal[1] == vec2u(0u)) && all(normal[2] == vec2u(0u));
    let axis = select(dominant_axis(normal), longest_axis(line_of(corners)), flat);
    let first = turn(low, axis);
    var placed: array<vec3f, 3>;
    var turned: array<vec3i, 3>;
    for (var i = 0u; i < 3u; i++) {
        placed[i] = vec3f(corners[i]) / f32(UNITS);
        turned[i] = turn(corners[i] - low * UNITS, axis);
    }
    let source = Source(placed, face, uv_footprint(face));
    if flat {
        return voxelize_line(source, line_of(turned), first, turn(size, axis), axis);
    }
    return voxelize_area(source, turned, first, turn(size, axis), axis);
}

/// `first`: the voxel that `corners` are relative to; `size`: the last voxel from there.
fn voxelize_area(source: Source, corners: array<vec3i, 3>, first: vec3i, size: vec3i, axis: u32) -> u32 {
    let overlap = overlap_of(corners, knobs.separability == 6u, size);
    var fragments = 0u;
    for (var y = 0; y <= size.y; y++) {
        for (var x = 0; x <= size.x; x++) {
            if !inside(overlap, overlap.xy, 0u, 1u, 2u, vec2i(x, y)) {
                continue;
            }
            let range = column_range(overlap, vec2i(x, y));
            for (var z = max(range.x, 0); z <= min(range.y, size.z); z++) {
                let voxel = vec3i(x, y, z);
                if fills(overlap, range, voxel) {
                    fragments += u32(add_fragment(source, turn_back(first + voxel, axis)));
                }
            }
        }
    }
    return fragments;
}

/// The same for what has no area.
fn voxelize_line(source: Source, line: Line, first: vec3i, size: vec3i, axis: u32) -> u32 {
    var fragments = 0u;
    for (var z = 0; z <= size.z; z++) {
        let range = line_range(line, z);
        for (var y = max(range.y, 0); y <= min(range.w, size.y); y++) {
            for (var x = max(range.x, 0); x <= min(range.z, size.x); x++) {
                let voxel = vec3i(x, y, z);
                if line_meets(line, voxel) {
                    fragments += u32(add_fragment(source, turn_back(first + voxel, axis)));
                }
            }
        }
    }
    return fragments;
}
