// Draws triangles where the atlas has them, into a texture of their numbers: first pass of the atlas voxelizer (T = the
// paper on voxel-based global illumination of 2011, chapter 3). T stores positions and data in the texels; they follow
// from the number.
//
// A texel belongs to the triangle that its centre lies in. With r texels to a voxel, every disc of 0.71 / r voxels on a
// surface holds a centre; a voxel of the thin set holds a disc of at least 0.29 of a plane through its whole column. So
// 2.5 texels leave no hole in a flat chart; holes remain along the borders of charts, and where they are narrow.
// Reads per vertex a triangle's record and 24 B; writes a texel per fragment.

import lib/atlas;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) triangle: u32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let place = atlas_corner(index / 3u, index % 3u);
    return Varying(vec4f(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y, 0.5, 1.0), index / 3u);
}

struct Targets {
    /// The triangle's number and 1; 0 where there is none.
    @location(0) triangle_map: u32,
}

@fragment
fn fragment(in: Varying) -> Targets {
    return Targets(in.triangle + 1u);
}
