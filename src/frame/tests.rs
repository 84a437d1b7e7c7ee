use super::layout::{components, encode};
use super::stage::workgroups;
use proptest::prelude::*;
use wgpu::TextureFormat;

/// What a kernel would read from a texel that was filled with `value`.
fn filled(format: TextureFormat, value: f64) -> Vec<f32> {
    let (component, count) = components(format).unwrap();
    let bytes = encode(format, value).unwrap();
    assert_eq!(bytes.len(), component.bytes() * count);
    bytes.chunks_exact(component.bytes()).enumerate().map(|(i, b)| component.decode(b, i < 3)).collect()
}

#[test]
fn fills_are_read_back_as_they_were_meant() {
    use TextureFormat as F;
    for format in [F::R32Float, F::Rgba32Float, F::Rgba16Float, F::R16Float] {
        assert!(filled(format, -2.5).iter().all(|x| *x == -2.5), "{format:?}");
    }
    for format in [F::R32Uint, F::Rgba16Uint, F::Rg8Uint] {
        assert!(filled(format, 200.0).iter().all(|x| *x == 200.0), "{format:?}");
    }
    assert_eq!(filled(F::Rgba8Unorm, 1.0), [1.0; 4]);
    assert_eq!(filled(F::Rgba8Unorm, 7.0), [1.0; 4]);
    assert_eq!(filled(F::R8Snorm, -1.0), [-1.0]);
    assert_eq!(filled(F::Rgba32Sint, -3.0), [-3.0; 4]);
}

#[test]
fn srgb_is_decoded_in_colours_and_not_in_alpha() {
    // 0.5 is stored as 128; IEC 61966-2-1 makes 128 a linear 0.21586.
    let texel = filled(TextureFormat::Rgba8UnormSrgb, 0.5);
    assert!(texel[..3].iter().all(|x| (x - 0.215_86).abs() < 1e-4), "{texel:?}");
    assert!((texel[3] - 128.0 / 255.0).abs() < 1e-6);
}

proptest! {
    /// Every thread is there, no dimension is over the limit, and folding wastes less than a row.
    #[test]
    fn workgroups_cover_all_threads(threads in 1u64..50_000_000, size in 1u32..256, limit in 256u32..70_000) {
        let groups = workgroups([threads, 1, 1], [size, 1, 1], limit);
        let needed = threads.div_ceil(u64::from(size));
        match groups {
            Some([x, y, z]) => {
                prop_assert!(x <= limit && y <= limit && z == 1);
                let all = u64::from(x) * u64::from(y);
                prop_assert!(all >= needed && all < needed + u64::from(y.max(1)));
            }
            None => prop_assert!(needed > u64::from(limit) * u64::from(limit)),
        }
    }
}

#[test]
fn only_one_dimension_is_folded() {
    assert_eq!(workgroups([100_000, 2, 1], [1, 1, 1], 65_535), None);
    assert_eq!(workgroups([64, 64, 64], [4, 4, 4], 65_535), Some([16, 16, 16]));
    assert_eq!(workgroups([100_000, 1, 1], [1, 1, 1], 65_535), Some([50_000, 2, 1]));
}
