use super::*;
use crate::problem::Problems;

fn refused(test: Input, truth: Truth, options: &Options) -> Problems {
    Measures::new(Kind::Light, test, truth, options).err().unwrap()
}

/// One line for each problem: code, exit code and message.
fn said(problems: &Problems) -> Vec<String> {
    assert!(problems.iter().all(|problem| problem.help.is_some()));
    problems.iter().map(|p| format!("{} {}: {}", p.code, p.kind.exit_code(), p.message)).collect()
}

#[test]
fn what_is_no_pair() {
    let [truth, test, _] = pictures(3);
    let options = Options::default();
    let of = |name, picture| Input { name, picture };
    let held = |name, picture| Truth { name, picture, variance: None };
    let itself = "measure-alike 2: `a/color` is held against itself";
    assert_eq!(said(&refused(of("a/color", &test), held("a/color", &truth), &options)), [itself]);
    assert_eq!(said(&refused(of("a/color", &test), held("b/color", &test), &options)), [itself]);

    let small = Picture::new(2, 1, 3, vec![0.0; 6]).unwrap();
    assert_eq!(
        said(&refused(of("a/color", &small), held("b/color", &truth), &options)),
        [
            "measure-size 2: `a/color` has 2×1 pixels of 3 channels, and `b/color` has 48×32 pixels of 3 channels"
        ]
    );
    let [grey, ..] = pictures(1);
    assert_eq!(
        said(&refused(of("a/depth", &grey), held("b/depth", &truth), &options)),
        [
            "measure-size 2: `a/depth` has 48×32 pixels of 1 channel, and `b/depth` has 48×32 pixels of 3 channels"
        ]
    );
    let options = Options { exposure: f32::NAN, ..options };
    assert_eq!(
        said(&refused(of("a/color", &test), held("b/color", &truth), &options)),
        ["measure-exposure 2: an exposure of NaN stops shows nothing"]
    );
}

#[test]
fn what_is_no_number() {
    let [truth, test, variance] = pictures(3);
    let at = |of: &Picture, pixels: [usize; 2], bad: f32| {
        map(of, |i, value| if pixels.map(|pixel| 3 * pixel + 1).contains(&i) { bad } else { value })
    };
    let (nan, infinite) = (at(&test, [50, 60], f32::NAN), at(&truth, [47, 47], f32::INFINITY));
    let of = |picture| Input { name: "a/color", picture };
    let held = |picture, variance| Truth { name: "b/color", picture, variance };
    let options = Options::default();
    let found = said(&refused(of(&nan), held(&infinite, None), &options));
    assert_eq!(found.len(), 2);
    let words = "measure-finite 1: `a/color`: 2 of 1536 pixels are not finite, the first at x = 2, y = 1: [";
    assert!(found[0].starts_with(words) && found[0].contains(", NaN, "), "{found:?}");
    let words = "measure-finite 1: `b/color`: 1 of 1536 pixels is not finite, the first at x = 47, y = 0: [";
    assert!(found[1].starts_with(words) && found[1].contains(", inf, "), "{found:?}");
    assert_eq!(said(&noise(&held(&infinite, None), None).unwrap_err()), [found[1].clone()]);

    let negative = at(&variance, [9, 9], -1e-9);
    let found = said(&refused(of(&test), held(&truth, Some(&negative)), &options));
    let words = "measure-variance 2: `variance of b/color`: 1 of 1536 pixels is no variance, the first at x = 9, y = 0";
    assert!(found[0].starts_with(words), "{found:?}");
    assert!(noise(&held(&truth, Some(&negative)), None).is_err());
    let [grey, ..] = pictures(1);
    assert_eq!(
        said(&refused(of(&test), held(&truth, Some(&grey)), &options)),
        ["measure-size 2: `variance of b/color` has 48×32 pixels of 1 channel, \
          and `b/color` has 48×32 pixels of 3 channels"]
    );
}

#[test]
fn what_is_no_mask() {
    let [truth, test, variance] = pictures(3);
    let measures = measures(&test, &truth);
    let truth = Truth { name: "truth", picture: &truth, variance: Some(&variance) };
    for (mask, message) in [
        (vec![true; 7], "measure-mask 2: a mask of 7 pixels does not fit a picture of 1536"),
        (vec![false; 1536], "measure-mask 2: a mask leaves none of 1536 pixels to measure"),
    ] {
        assert_eq!(said(&measures.errors(Some(&mask)).unwrap_err()), [message]);
        assert_eq!(said(&noise(&truth, Some(&mask)).unwrap_err()), [message]);
    }
    // A mask at the edge has no window of its own, and is measured otherwise.
    let edge: Vec<bool> = (0..1536).map(|i| i % 48 < 5).collect();
    let found = measures.errors(Some(&edge)).unwrap();
    assert!(!found.contains_key("ssim") && found.contains_key("flip"));
}
