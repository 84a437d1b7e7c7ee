use super::*;

/// Of one pixel of the map of two evenly grey pictures.
fn shown_difference(t: f32, r: f32) -> [i32; 3] {
    let even = |value| Picture::new(12, 12, 1, vec![value; 144]).unwrap();
    let (t, r) = (even(t), even(r));
    let map = measures(&t, &r).difference_map().unwrap();
    assert_eq!((map.width(), map.height()), (12, 12));
    assert!(map.data().chunks(4).all(|texel| *texel == map.data()[..4] && texel[3] == 255));
    [0, 1, 2].map(|c| i32::from(map.data()[c]))
}

#[test]
fn differences_are_red_or_blue() {
    // Alike: ColorBrewer's middle, nearly white.
    let [r, g, b] = shown_difference(0.5, 0.5);
    assert!(r.min(g).min(b) > 235, "{r} {g} {b}");
    // Each is darker the greater the difference; red and blue are not mixed up.
    let lightness = |[r, g, b]: [i32; 3]| r + g + b;
    for brighter in [true, false] {
        let steps = [0.5, 0.4, 0.25, 0.1, 0.0].map(|less: f32| if brighter { 1.0 - less } else { less });
        let colors = steps.map(|t| shown_difference(t, 0.5));
        assert!(colors.windows(2).all(|pair| lightness(pair[0]) > lightness(pair[1])), "{colors:?}");
        assert!(colors[2..].iter().all(|[r, _, b]| (r > b) == brighter && r != b), "{colors:?}");
    }
    // Cut off beyond ±1; a black reference is not divided by.
    assert_eq!(shown_difference(50.0, 0.5), shown_difference(9.0, 0.5));
    assert_eq!(shown_difference(0.1, 0.0), shown_difference(9.0, 0.5));
    assert_eq!(shown_difference(0.0, 0.0), shown_difference(0.5, 0.5));
}

/// 0.25 brighter than a reference of 0.5 everywhere, over 0.5 + 0.1·0.5.
#[test]
fn differences_have_their_scale() {
    let color = colorous::RED_BLUE.eval_continuous(0.5 - 0.5 / 2.2);
    assert_eq!(shown_difference(0.75, 0.5), [color.r, color.g, color.b].map(i32::from));
}

/// ꟻLIP's own colours: the authors' table, at the nearest of its 256 entries.
#[test]
fn flip_is_shown_as_its_authors_do() {
    let [truth, test, _] = pictures(3);
    let measures = measures(&test, &truth);
    let map = measures.flip_map().unwrap();
    let table = nv_flip::magma_lut().to_vec();
    let errors = measures.flip.as_ref().unwrap();
    assert!(errors.iter().any(|e| *e > 0.4) && errors.iter().any(|e| *e < 0.1));
    for (error, texel) in errors.iter().zip(map.data().chunks(4)) {
        let entry = 3 * (error * 255.0).round() as usize;
        let off = (0..3).map(|c| texel[c].abs_diff(table[entry + c])).max().unwrap();
        assert!(off <= 4 && texel[3] == 255, "{error}: {texel:?}");
    }
    let (test, truth) =
        (Input { name: "test", picture: &test }, Truth { name: "truth", picture: &truth, variance: None });
    let other = Measures::new(Kind::Other, test, truth, &Options::default()).unwrap();
    assert!(other.flip_map().is_none() && other.difference_map().is_some());
}
