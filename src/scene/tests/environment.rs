//! Environments against what they must hold.

use crate::scene::environment::Environment;
use crate::scene::{self, Scene, generate};
use glam::Vec3;
use image::{ImageFormat, Rgb32FImage};
use std::f64::consts::PI;
use std::path::Path;

fn load(folder: &Path, environment: &str) -> crate::problem::Result<Scene> {
    let (name, make) = generate::ALL[0];
    std::fs::write(folder.join(name), make()).unwrap();
    let path = folder.join("day.ron");
    std::fs::write(&path, format!("Setting(gltf: {name:?}, environment: {environment})")).unwrap();
    scene::load(&path)
}

#[test]
fn a_constant_environment() {
    let folder = tempfile::tempdir().unwrap();
    let scene = load(folder.path(), "Constant(radiance: (1, 2, 3))").unwrap();
    let environment = scene.environment.unwrap();
    assert_eq!((environment.width, environment.height, environment.levels), (1, 1, 1));
    assert_eq!(environment.mean(), Vec3::new(1.0, 2.0, 3.0));
}

/// Both formats, with odd sizes: texels as they are, and a last level that is the mean over the sphere.
#[test]
fn pictures_and_their_levels() {
    let folder = tempfile::tempdir().unwrap();
    // Powers of two and their sums survive the shared exponent of .hdr.
    let texel = |x: u32, y: u32| [1.0 + x as f32, if y == 0 { 8.0 } else { 0.0 }, 0.5];
    let picture = Rgb32FImage::from_fn(13, 6, |x, y| image::Rgb(texel(x, y)));
    for (name, format) in [("sky.hdr", ImageFormat::Hdr), ("sky.exr", ImageFormat::OpenExr)] {
        picture.save_with_format(folder.path().join(name), format).unwrap();
        let scene =
            load(folder.path(), &format!("Picture(file: {name:?}, strength: 2, turn_degrees: 90)")).unwrap();
        assert_eq!(scene.files.len(), 3, "the setting, the model, the picture");
        let environment = scene.environment.unwrap();
        assert_eq!((environment.width, environment.height, environment.levels), (13, 6, 4));
        let sizes = [(13, 6), (6, 3), (3, 1), (1, 1)];
        assert_eq!(environment.first_row(), sizes.iter().map(|(w, h)| w * h).sum::<usize>());
        assert_eq!(environment.texels.len(), environment.first_row() + 6, "an element for each row");
        for (i, found) in environment.texels[..13 * 6].iter().enumerate() {
            let expected = Vec3::from(texel(i as u32 % 13, i as u32 / 13)) * 2.0;
            assert!((found.truncate() - expected).length() < 0.02 * expected.length(), "{name} {i}: {found}");
        }
        // The top row is a cap: this is its share of the sphere.
        let cap = (1.0 - (PI / 6.0).cos()) / 2.0;
        let mean = environment.mean();
        assert!((f64::from(mean.y) - 16.0 * cap).abs() < 1e-4 * 16.0, "{mean} {cap}");
        assert!((mean.x - 2.0 * 7.0).abs() < 0.02 * 14.0 && (mean.z - 1.0).abs() < 1e-3, "{mean}");
        assert!((environment.turn - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
    }
}

#[test]
fn what_is_no_environment() {
    let folder = tempfile::tempdir().unwrap();
    let negative =
        Rgb32FImage::from_fn(4, 2, |x, y| image::Rgb([if (x, y) == (2, 1) { -1.0 } else { 1.0 }; 3]));
    negative.save_with_format(folder.path().join("negative.exr"), ImageFormat::OpenExr).unwrap();
    std::fs::write(folder.path().join("text.hdr"), "no picture").unwrap();
    std::fs::write(folder.path().join("cut.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 900 +X 1800\n")
        .unwrap();
    let huge = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 120000\n";
    std::fs::write(folder.path().join("huge.hdr"), huge).unwrap();
    for (text, code, word) in [
        ("Constant(radiance: (1, -1, 1))", "setting-value", "negative"),
        ("Picture(file: \"negative.exr\")", "setting-value", "column 2, row 1"),
        ("Picture(file: \"text.hdr\")", "setting-value", "signature"),
        ("Picture(file: \"cornell-box.glb\")", "setting-value", "neither"),
        ("Picture(file: \"cut.hdr\")", "setting-value", "decoded"),
        ("Picture(file: \"huge.hdr\")", "setting-value", "decoded"),
        ("Picture(file: \"none.hdr\")", "setting-file", "no \"none.hdr\""),
        ("Picture(file: \"../sky.hdr\")", "setting-file", "not a path below"),
        ("Picture(file: \"text.hdr\", strength: -1)", "setting-value", "strength"),
        ("Picture(file: \"text.hdr\", strenght: 1)", "setting", "strength"),
    ] {
        let problems = load(folder.path(), text).unwrap_err();
        let problem = problems.iter().next().unwrap();
        let said = format!("{} {}", problem.message, problem.help.as_deref().unwrap_or_default());
        assert!(problem.code == code && said.contains(word), "{text}: {} {said}", problem.code);
        assert!(!problem.labels.is_empty(), "{text}");
    }
    assert!(Environment::constant(Vec3::NAN).is_err());
}
