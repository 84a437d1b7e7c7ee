use super::*;
use proptest::prelude::*;

const PERFECT: [(&str, f64); 7] = [
    ("rmse", 0.0),
    ("relmse", 0.0),
    ("relmse_trimmed", 0.0),
    ("smape", 0.0),
    ("bias", 1.0),
    ("ssim", 1.0),
    ("flip", 0.0),
];

#[test]
fn like_pictures_have_no_error() {
    for channels in 1..=3 {
        let [truth, ..] = pictures(channels);
        assert_eq!(errors(&truth.clone(), &truth), BTreeMap::from(PERFECT), "{channels} channels");
    }
}

/// A comparison that looks away would not see it. The pixel lies in a corner, where windows hardly reach.
#[test]
fn every_measure_sees_one_pixel() {
    let [truth, ..] = pictures(3);
    let one = map(&truth, |i, r| if i < 3 { r + 0.5 } else { r });
    for ((name, perfect), error) in PERFECT.into_iter().zip(sorted(&errors(&one, &truth))) {
        let trimmed = name == "relmse_trimmed";
        assert_eq!(error == perfect, trimmed, "{name}: {error}");
    }
    // Trimming leaves out one pixel of these: that one, but not a second.
    let two = map(&truth, |i, r| if i < 6 { r + 0.5 } else { r });
    let two = errors(&two, &truth);
    assert!(two["relmse_trimmed"] > 0.0 && two["relmse_trimmed"] < two["relmse"]);
}

/// Alpha says nothing of light.
#[test]
fn alpha_is_not_measured() {
    let [truth, test, _] = pictures(3);
    let with_alpha = |of: &Picture, alpha| {
        picture(4, of.texels().flat_map(|texel| [texel[0], texel[1], texel[2], alpha]).collect())
    };
    let expected = errors(&test, &truth);
    assert_eq!(errors(&with_alpha(&test, 0.25), &with_alpha(&truth, 1.0)), expected);
    assert_eq!(errors(&with_alpha(&test, 0.25), &truth), expected);
}

/// One channel is grey, and each channel counts as much as another.
#[test]
fn channels_are_equal() {
    let [truth, test, _] = pictures(1);
    let grey = |of: &Picture| picture(3, of.data().iter().flat_map(|value| [*value; 3]).collect());
    close(&errors(&test, &truth), &errors(&grey(&test), &grey(&truth)), 1e-12);
    // A second channel that is right halves what is a mean of errors.
    let with_right =
        |of: &Picture| picture(2, of.data().iter().zip(truth.data()).flat_map(|(a, r)| [*a, *r]).collect());
    let (one, two) = (errors(&test, &truth), errors(&with_right(&test), &with_right(&truth)));
    for name in ["relmse", "relmse_trimmed", "smape"] {
        assert!((two[name] / one[name] - 0.5).abs() < 1e-12, "{name}");
    }
    assert!(((1.0 - two["ssim"]) / (1.0 - one["ssim"]) - 0.5).abs() < 1e-12);
}

/// Curves and exposure are for what is looked at, and for light alone.
#[test]
fn kinds_differ_in_how_they_are_shown() {
    let [truth, test, _] = pictures(3);
    let of = |kind, exposure| {
        let (test, truth) = (
            Input { name: "test", picture: &test },
            Truth { name: "truth", picture: &truth, variance: None },
        );
        Measures::new(kind, test, truth, &Options { exposure, curve: Curve::Reinhard })
            .unwrap()
            .errors(None)
            .unwrap()
    };
    let (dark, bright) = (of(Kind::Light, -3.0), of(Kind::Light, 1.0));
    for (name, value) in &dark {
        assert_eq!(bright[name] != *value, ["ssim", "flip"].contains(name), "{name}");
    }
    assert_eq!(of(Kind::Share, -3.0), of(Kind::Share, 1.0));
    assert_eq!(of(Kind::Share, 0.0), errors(&test, &truth));
    let other = of(Kind::Other, 0.0);
    assert!(other.keys().eq(["relmse", "relmse_trimmed", "rmse", "smape"].iter()));
    let kinds = ["color", "albedo", "normal", "depth"].map(Kind::of);
    assert_eq!(kinds, [Kind::Light, Kind::Share, Kind::Other, Kind::Other]);
}

/// What is divided by a reference that is black is left out, not infinite.
#[test]
fn black_references() {
    let black = picture(1, vec![0.0; (WIDTH * HEIGHT) as usize]);
    let test = map(&black, |i, _| if i % 2 == 0 { 0.5 } else { 0.0 });
    let found = errors(&test, &black);
    assert!(found.keys().eq(["flip", "rmse", "smape", "ssim"].iter()), "{found:?}");
    assert_eq!((found["rmse"], found["smape"]), (0.125f64.sqrt(), 1.0));
    let truth = Truth { name: "truth", picture: &black, variance: Some(&test) };
    assert_eq!(noise(&truth, None).unwrap(), None);
}

/// No window of 11×11 fits; ꟻLIP looks beyond the edge.
#[test]
fn small_pictures() {
    let [a, b] = [0.25, 0.5].map(|value| Picture::new(10, 11, 1, vec![value; 110]).unwrap());
    let found = errors(&a, &b);
    assert!(!found.contains_key("ssim") && found["flip"] > 0.0, "{found:?}");
    assert_eq!(found["bias"], 0.5);
    let [a, b] = [0.25, 0.5].map(|value| Picture::new(1, 1, 1, vec![value]).unwrap());
    assert!(errors(&a, &b)["flip"] > 0.0);
}

/// A reference with noise of a known variance: a perfect picture has just that much error, one that is 30 % off more.
#[test]
fn noise_is_what_a_perfect_picture_has() {
    let [truth, ..] = pictures(3);
    let truth = map(&truth, |_, r| r.min(1.0) + 0.125);
    let deviation = |r: f32| 0.05 * r;
    let mut random = fastrand::Rng::with_seed(7);
    let uniform: Vec<f32> = truth.data().iter().map(|_| 12f32.sqrt() * (random.f32() - 0.5)).collect();
    let noisy = map(&truth, |i, r| r + deviation(r) * uniform[i]);
    let variance = map(&truth, |_, r| deviation(r).powi(2));
    let reference = Truth { name: "truth", picture: &noisy, variance: Some(&variance) };
    let expected = noise(&reference, None).unwrap().unwrap();
    let found = |test: &Picture| {
        let test = Input { name: "test", picture: test };
        Measures::new(Kind::Light, test, reference, &Options::default()).unwrap().errors(None).unwrap()
    };
    let perfect = found(&truth);
    assert!((perfect["relmse"] / expected - 1.0).abs() < 0.05, "{} {expected}", perfect["relmse"]);
    assert!(perfect["relmse_above_noise"] < 0.05 * expected && within_noise(perfect["relmse"], expected));
    let off = found(&map(&truth, |_, r| 1.3 * r));
    assert_eq!(off["relmse_above_noise"], off["relmse"] - expected);
    assert!(!within_noise(off["relmse"], expected));
    assert!(within_noise(0.0, 0.0) && !within_noise(1e-9, 0.0));
}

/// No spread is no knowledge: a single sample differs from no other. Alpha of a variance is none.
#[test]
fn noise_of_a_single_sample_is_not_known() {
    let [truth, test, variance] = pictures(3);
    let zero = picture(4, truth.texels().flat_map(|_| [0.0, 0.0, 0.0, 1.0]).collect());
    let one = picture(4, (0..4 * 1536).map(|i| if i == 1000 { 1e-3 } else { 0.0 }).collect());
    let of = |variance| Truth { name: "truth", picture: &truth, variance };
    for (variance, known) in [(&zero, false), (&one, true), (&variance, true)] {
        assert_eq!(noise(&of(Some(variance)), None).unwrap().is_some(), known);
        let test = Input { name: "test", picture: &test };
        let measures = Measures::new(Kind::Light, test, of(Some(variance)), &Options::default()).unwrap();
        assert_eq!(measures.errors(None).unwrap().contains_key("relmse_above_noise"), known);
    }
    assert_eq!(noise(&of(None), None).unwrap(), None);
    // Under a mask where nothing varies it is known, and 0.
    let mask: Vec<bool> = (0..1536).map(|i| i < 7).collect();
    assert_eq!(noise(&of(Some(&one)), Some(&mask)).unwrap(), Some(0.0));
}

fn sorted(errors: &BTreeMap<&str, f64>) -> Vec<f64> {
    PERFECT.iter().map(|(name, _)| errors[name]).collect()
}

fn close(a: &BTreeMap<&str, f64>, b: &BTreeMap<&str, f64>, tolerance: f64) {
    assert!(a.keys().eq(b.keys()));
    for (name, value) in a {
        assert!((value - b[name]).abs() <= tolerance * (1.0 + value.abs()), "{name}: {value}, {}", b[name]);
    }
}

fn any_picture() -> impl Strategy<Value = Picture> {
    proptest::collection::vec(0f32..4.0, 16 * 13 * 3).prop_map(|data| Picture::new(16, 13, 3, data).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// `rmse`, `smape`, `ssim` and `flip` don't ask which is the reference.
    #[test]
    fn symmetry(a in any_picture(), b in any_picture()) {
        let (there, back) = (errors(&a, &b), errors(&b, &a));
        for name in ["rmse", "smape", "ssim"] {
            prop_assert!((there[name] - back[name]).abs() < 1e-12, "{}", name);
        }
        prop_assert!((there["flip"] - back["flip"]).abs() < 1e-5);
        prop_assert!((there["bias"] * back["bias"] - 1.0).abs() < 1e-12);
        // So few pixels that none is left out.
        prop_assert!((there["relmse_trimmed"] / there["relmse"] - 1.0).abs() < 1e-12);
        prop_assert!((0.0..=2.0).contains(&there["smape"]) && (-1.0..1.0).contains(&there["ssim"]));
    }

    /// In other units all but `rmse` is the same, and k times the light has a bias of k.
    #[test]
    fn scales(a in any_picture(), b in any_picture(), k in prop::sample::select(vec![0.25f32, 0.5, 8.0])) {
        let (k_a, k_b) = (map(&a, |_, value| k * value), map(&b, |_, value| k * value));
        let (plain, scaled) = (errors(&a, &b), errors(&k_a, &k_b));
        let k = f64::from(k);
        prop_assert!((scaled["rmse"] / plain["rmse"] - k).abs() < 1e-9 * k);
        for name in ["relmse", "relmse_trimmed", "smape", "bias"] {
            prop_assert!((scaled[name] - plain[name]).abs() < 1e-12 * plain[name], "{}", name);
        }
        prop_assert!((errors(&k_b, &b)["bias"] - k).abs() < 1e-9);
        prop_assert!((errors(&k_b, &b)["smape"] - 2.0 * (k - 1.0).abs() / (k + 1.0)).abs() < 1e-9);
    }

    /// Means over masks that share out the pixels add up to that over all.
    #[test]
    fn masks_partition(a in any_picture(), b in any_picture(), mask in prop::collection::vec(any::<bool>(), 16 * 13)) {
        prop_assume!(mask.contains(&true) && mask.contains(&false));
        let rest: Vec<bool> = mask.iter().map(|on| !on).collect();
        let measures = measures(&a, &b);
        let [all, some, others] = [None, Some(&mask), Some(&rest)]
            .map(|mask| measures.errors(mask.map(Vec::as_slice)).unwrap());
        let share = mask.iter().filter(|on| **on).count() as f64 / mask.len() as f64;
        for (name, power) in [("rmse", 2), ("relmse", 1), ("smape", 1), ("flip", 1)] {
            let [all, some, others] = [&all, &some, &others].map(|errors| errors[name].powi(power));
            let sum = share * some + (1.0 - share) * others;
            prop_assert!((all - sum).abs() < 1e-12 * (1.0 + all), "{}: {} {}", name, all, sum);
        }
    }
}
