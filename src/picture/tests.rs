use super::*;
use proptest::prelude::*;
use std::fs;

fn picture(channels: u32, data: &[f32]) -> Picture {
    let width = data.len() as u32 / channels;
    Picture::new(width, 1, channels, data.to_vec()).unwrap()
}

/// What a picture looks like as PNG, and how many texels are not finite.
fn shown(picture: &Picture, curve: Curve, exposure: f32) -> (Vec<[u8; 4]>, usize) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let signals = write_png(&path, picture, curve, exposure).unwrap();
    let read = read_png(&path).unwrap();
    assert_eq!((read.width(), read.height()), (picture.width(), picture.height()));
    (read.data().chunks(4).map(|texel| [texel[0], texel[1], texel[2], texel[3]]).collect(), signals)
}

#[test]
fn sizes_are_checked() {
    assert!(Picture::new(2, 3, 3, vec![0.0; 18]).is_some());
    assert!(Picture::new(2, 3, 3, vec![0.0; 17]).is_none());
    assert!(Picture::new(0, 3, 3, vec![]).is_none());
    assert!(Picture::new(1, 1, 0, vec![]).is_none());
    assert!(Picture::new(1, 1, 5, vec![0.0; 5]).is_none());
    assert!(Picture::new(u32::MAX, u32::MAX, 4, vec![]).is_none());
    assert!(Encoded::new(2, 2, vec![0; 16]).is_some());
    assert!(Encoded::new(2, 2, vec![0; 15]).is_none());
}

#[test]
fn srgb_has_the_published_values() {
    // IEC 61966-2-1: code values of linear light.
    for (linear, coded) in
        [(0.0, 0), (0.002, 7), (0.0031308, 10), (0.18, 118), (0.214_041, 127), (0.5, 188), (1.0, 255)]
    {
        assert_eq!(srgb::encode8(linear), coded, "{linear}");
    }
    assert_eq!((srgb::encode8(-1.0), srgb::encode8(7.0), srgb::encode8(f32::NAN)), (0, 255, 0));
    for code in 0..=255u8 {
        assert_eq!(srgb::encode8(srgb::decode(f32::from(code) / 255.0)), code);
    }
    assert!((srgb::decode(0.5) - 0.214_041).abs() < 1e-6);
}

#[test]
fn channels_become_colours() {
    let half = 188;
    let (texels, _) = shown(&picture(1, &[0.5]), Curve::Clip, 0.0);
    assert_eq!(texels, [[half, half, half, 255]]);
    let (texels, _) = shown(&picture(2, &[0.5, 1.0]), Curve::Clip, 0.0);
    assert_eq!(texels, [[half, 255, 0, 255]]);
    let (texels, _) = shown(&picture(3, &[0.5, 1.0, -3.0, 9.0, 0.0, 0.0]), Curve::Clip, 0.0);
    assert_eq!(texels, [[half, 255, 0, 255], [255, 0, 0, 255]]);
    // Alpha is neither exposed nor coded.
    let (texels, _) = shown(&picture(4, &[0.25, 0.5, 0.0, 0.5]), Curve::Clip, 1.0);
    assert_eq!(texels, [[half, 255, 0, 128]]);
}

#[test]
fn what_is_not_finite_is_signalled() {
    let (texels, signals) =
        shown(&picture(3, &[f32::NAN, 0., 0., 0., f32::INFINITY, 0., 1., 1., 1.]), Curve::Reinhard, 0.0);
    assert_eq!((&texels[..2], signals), (&[SIGNAL, SIGNAL][..], 2));
    assert_ne!(texels[2], SIGNAL);
    // A great exposure of a finite value is not.
    let (texels, signals) = shown(&picture(1, &[f32::MAX]), Curve::Reinhard, 100.0);
    assert_eq!((texels[0], signals), ([255; 4], 0));
}

#[test]
fn curves_by_name() {
    for curve in Curve::ALL {
        assert_eq!(curve.to_string().parse(), Ok(curve));
    }
    let error = "reinhart".parse::<Curve>().unwrap_err();
    assert!(error.contains("reinhart") && error.contains("reinhard"), "{error}");
    let values = Curve::ALL.map(|curve| curve.apply(3.0));
    assert_eq!(values[..2], [1.0, 0.75]);
    assert!((values[2] - (1.0 - 1.0 / 20.085_537)).abs() < 1e-6);
}

#[test]
fn encoded_pictures_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    for alpha in [255, 7] {
        let encoded = Encoded::new(2, 1, vec![1, 2, 3, 255, 5, 6, 7, alpha]).unwrap();
        write_encoded(&path, &encoded).unwrap();
        assert_eq!(read_png(&path).unwrap(), encoded);
    }
}

#[test]
fn exr_keeps_every_bit_and_says_its_colours() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    let pictures: Vec<Picture> = (1..=4)
        .map(|channels| {
            let values = [0.1, -2.5, 1e-40, 65_505.0, f32::MAX, f32::INFINITY, 1.0 / 3.0, 0.0];
            let data = (0..6 * channels).map(|i| values[(i * 3 % 8) as usize]).collect();
            Picture::new(3, 2, channels, data).unwrap()
        })
        .collect();
    let names = ["depth", "motion", "direct", "color"];
    let layers: Vec<_> = names.into_iter().zip(&pictures).collect();
    write_exr(&path, &layers).unwrap();
    let read = read_exr(&path).unwrap();
    assert_eq!(read.len(), 4);
    for ((name, picture), (read_name, read)) in layers.iter().zip(&read) {
        assert_eq!(name, read_name);
        let bits = |p: &Picture| p.data().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!((picture.channels(), bits(picture)), (read.channels(), bits(read)), "{name}");
    }
    let meta = exr::meta::MetaData::read_from_file(&path, false).unwrap();
    let chromaticities = meta.headers[0].shared_attributes.chromaticities.unwrap();
    assert_eq!((chromaticities.red.0, chromaticities.white.1), (0.64, 0.329));
}

#[test]
fn exr_refuses_what_it_cannot_hold() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    let (a, b) = (picture(1, &[1.0]), picture(1, &[1.0, 2.0]));
    assert!(write_exr(&path, &[]).is_err());
    assert!(write_exr(&path, &[("a", &a), ("b", &b)]).is_err());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// Whole or not at all: a write that fails leaves what was there, and nothing else.
#[test]
fn failed_writes_leave_no_trace() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    fs::write(&path, "before").unwrap();
    let failed = file::write_whole(&path, |writer| {
        std::io::Write::write_all(writer, b"half a pic").and(Err(std::io::Error::other("the lamp went out")))
    });
    let problems = failed.unwrap_err();
    let problem = problems.iter().next().unwrap();
    assert_eq!((problem.code, problems.exit_code()), ("picture-write", 1));
    assert!(problem.message.contains("picture.png") && problem.message.contains("the lamp went out"));
    assert_eq!(fs::read(&path).unwrap(), b"before");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    let missing = folder.path().join("no/such/folder/picture.png");
    assert!(write_png(&missing, &picture(1, &[1.0]), Curve::Clip, 0.0).is_err());
}

#[cfg(unix)]
#[test]
fn files_are_as_readable_as_any_other() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (ours, plain) = (folder.path().join("ours.png"), folder.path().join("plain"));
    write_png(&ours, &picture(1, &[1.0]), Curve::Clip, 0.0).unwrap();
    fs::write(&plain, "").unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&ours), mode(&plain));
}

proptest! {
    /// Curves rise from 0 and stay within what a display shows.
    #[test]
    fn curves_rise(a in 0f32..1e30, b in 0f32..1e30) {
        for curve in Curve::ALL {
            let (low, high) = (curve.apply(a.min(b)), curve.apply(a.max(b)));
            prop_assert!(0.0 <= low && low <= high && high <= 1.0);
            prop_assert_eq!((curve.apply(0.0), curve.apply(-a)), (0.0, 0.0));
        }
    }
}
