use crate::scene::image::{self, Image, Sampling, Wrap, fill_levels, words};
use glam::UVec4;
use proptest::prelude::*;

/// Texels of all levels as bytes.
fn levels(pixels: &[u8], width: u32, height: u32, srgb: bool) -> (u32, Vec<[u8; 4]>) {
    let mut texels: Vec<u32> =
        pixels.chunks_exact(4).map(|p| u32::from_le_bytes([p[0], p[1], p[2], p[3]])).collect();
    texels.resize(words(width, height) as usize, 7);
    fill_levels(&mut texels, width, height, srgb);
    (image::levels(width, height), texels.iter().map(|texel| texel.to_le_bytes()).collect())
}

fn grey(values: &[u8]) -> Vec<u8> {
    values.iter().flat_map(|v| [*v; 4]).collect()
}

#[test]
fn levels_halve_and_round_down() {
    let (count, texels) = levels(&grey(&[9; 7 * 3]), 7, 3, false);
    // 7×3, 3×1, 1×1
    assert_eq!((count, texels.len()), (3, 21 + 3 + 1));
    let (count, texels) = levels(&grey(&[9]), 1, 1, true);
    assert_eq!((count, texels.len()), (1, 1));
}

#[test]
fn odd_sides_are_weighted_by_area() {
    // Two texels over five: the middle one belongs half to each.
    let (_, texels) = levels(&grey(&[10, 20, 100, 30, 40]), 5, 1, false);
    assert_eq!(texels[5][0], ((10.0 + 20.0 + 50.0) / 2.5f64).round() as u8);
    assert_eq!(texels[6][0], ((30.0 + 40.0 + 50.0) / 2.5f64).round() as u8);
    let (_, texels) = levels(&grey(&[0, 90, 30]), 1, 3, false);
    assert_eq!(texels[3][0], 40);
}

#[test]
fn colour_is_averaged_as_light_and_alpha_as_it_is() {
    let (_, texels) = levels(&[0, 0, 0, 0, 255, 255, 255, 255], 2, 1, true);
    // Half the light of white is coded as 188, not 128 (IEC 61966-2-1).
    assert_eq!(texels[2], [188, 188, 188, 128]);
    let (_, texels) = levels(&[0, 0, 0, 0, 255, 255, 255, 255], 2, 1, false);
    assert_eq!(texels[2], [128; 4]);
}

#[test]
fn references_are_packed_as_documented() {
    let [least, greatest] = [[0; 4], [255; 4]];
    let image =
        Image { name: String::new(), offset: 5, width: 6, height: 7, levels: 3, srgb: true, least, greatest };
    let mut sampling =
        Sampling { wrap: [Wrap::Clamp, Wrap::Mirror], nearest: true, second_uv: false, transformed: false };
    let bits = 0b1 | 0b10 << 2 | 1 << 4 | 1 << 5 | 3 << 8;
    assert_eq!(image.reference(sampling), UVec4::new(5, 6, 7, bits));
    (sampling.second_uv, sampling.transformed) = (true, true);
    assert_eq!(image.reference(sampling), UVec4::new(5, 6, 7, bits | 1 << 6 | 1 << 7));
}

/// As many vectors this way as that: nothing is left but what they share.
#[test]
fn normals_are_averaged_as_vectors() {
    let [left, right] = [[27, 128, 206, 255], [228, 128, 206, 255]];
    let (_, texels) = levels(&[left, right].concat(), 2, 1, false);
    assert_eq!(texels[2], [128, 128, 206, 255]);
}

proptest! {
    #[test]
    fn a_constant_stays(width in 1u32..40, height in 1u32..40, texel: [u8; 4], srgb: bool) {
        let pixels = texel.repeat((width * height) as usize);
        let (_, texels) = levels(&pixels, width, height, srgb);
        prop_assert!(texels.iter().all(|t| *t == texel));
    }

    /// The last level is the mean of the first, whatever the sides: no texel counts more than another.
    #[test]
    fn the_mean_stays(width in 1u32..24, height in 1u32..24, seed: u64) {
        let random = |i: u64| (seed ^ i.wrapping_mul(0x9e37_79b9_7f4a_7c15)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let values: Vec<u8> = (0..u64::from(width * height)).map(|i| (random(i) >> 56) as u8).collect();
        let (_, texels) = levels(&grey(&values), width, height, false);
        let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64;
        let last = f64::from(texels.last().unwrap()[2]);
        prop_assert!((last - mean).abs() <= 0.51, "{} is not {}", last, mean);
    }
}
