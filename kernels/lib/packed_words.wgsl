// A voxel's attributes, packed: two words in `packed`, albedo and normal, and one in `packed_emission` where the scene
// emits; a byte for each component. What the fourth byte, the highest, holds is the payload's.

const PACKED_WORDS: u32 = 2u;
const PACKED_ALBEDO: u32 = 0u;
const PACKED_NORMAL: u32 = 1u;

/// Of values in [0, 1].
fn bytes_of(value: vec3f) -> vec3u {
    return vec3u(clamp(value, vec3f(0.0), vec3f(1.0)) * 255.0 + 0.5);
}

fn packed_bytes(bytes: vec3u, fourth: u32) -> u32 {
    return bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (fourth << 24u);
}

fn unpacked_bytes(word: u32) -> vec4u {
    return (vec4u(word) >> vec4u(0u, 8u, 16u, 24u)) & vec4u(255u);
}

fn unpacked(word: u32) -> vec3f {
    return vec3f(unpacked_bytes(word).xyz) / 255.0;
}

/// Of a unit vector: its components in [0, 1].
fn normal_to_unit(n: vec3f) -> vec3f {
    return 0.5 + 0.5 * n;
}

/// Zero stays zero: there is no byte for it, and what is within half a step of it is taken for it.
fn normal_of_unit(value: vec3f) -> vec3f {
    let n = 2.0 * value - 1.0;
    return select(n, vec3f(0.0), abs(n) < vec3f(0.004));
}
