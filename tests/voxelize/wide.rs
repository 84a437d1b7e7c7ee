//! The integers that decide where floats are not sure, of all sizes.

use std::path::Path;
use voxgi::scene;
use voxgi::session::Request;

/// Columns of the picture; three for each choice.
const WIDTH: usize = 192;

#[test]
fn wide_integers_are_exact() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-point.glb");
    let scene = scene::load(&path).expect("a scene of this repository");
    let request = Request { pipeline: "wide".to_owned(), size: [8, 8], ..Request::default() };
    let image = crate::voxelizer::run(&request, "wide", &scene).expect("a picture");
    let texels: Vec<&[f32]> = image.data.chunks_exact(4).collect();
    assert_eq!(image.width as usize, WIDTH);
    let hash = |x: u32| -> u32 {
        let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
        (word >> 22) ^ word
    };
    let chosen = |index: u32| i128::from(hash(index).cast_signed() >> (1 + hash(hash(index)) % 31));
    let (mut largest, mut negative) = (0, 0);
    for (y, row) in texels.chunks_exact(WIDTH).enumerate() {
        for (x, found) in row.chunks_exact(3).enumerate() {
            let first = 8 * (y * WIDTH + x) as u32;
            let [a, b, c, d, e, f, g, h] = std::array::from_fn(|i| chosen(first + i as u32));
            let (one, other) = (a * b - c * d, e * f);
            let sum = one * g + other * h;
            let halves = found[0].iter().chain(found[1]).rev();
            let value = halves.fold(0_u128, |value, half| value << 16 | *half as u128).cast_signed();
            assert_eq!(value, sum, "({a} · {b} − {c} · {d}) · {g} + {e} · {f} · {h}");
            let [sign, factor_sign, float, less] = [0, 1, 2, 3].map(|i| found[2][i]);
            assert_eq!([sign, factor_sign], [sum.signum() as f32, one.signum() as f32]);
            assert!((f64::from(float) - one as f64).abs() <= one.abs() as f64 * 2.5e-7, "{one}");
            assert_eq!(less == 1.0, one.abs() < other.abs());
            (largest, negative) = (largest.max(sum.abs()), negative + usize::from(sum < 0));
        }
    }
    assert!(largest > 1 << 80 && negative > 1000, "{largest} {negative}");
}
