use super::*;

/// A surface of 20×10 pixels at (4, 4): dark on its left half but for a hint, lit on the right, a lamp of 3×3 in it.
fn scene() -> Masks {
    let inside = |x: u32, y: u32| (4..24).contains(&x) && (4..14).contains(&y);
    let light = |x: u32, y: u32| match (x, y) {
        _ if !inside(x, y) => 7.0,
        (18..21, 8..11) => 1e5,
        (14.., _) => 0.5,
        (10, 8) => 0.001,
        _ => 0.0,
    };
    let each =
        |value: &dyn Fn(u32, u32) -> f32| (0..WIDTH * HEIGHT).map(|i| value(i % WIDTH, i / WIDTH)).collect();
    let depth = picture(1, each(&|x, y| if inside(x, y) { 2.0 } else { 0.0 }));
    let direct = picture(1, each(&light));
    let of = |name, picture| Input { name, picture };
    Masks::new(&of("reference/depth", &depth), &of("reference/direct", &direct)).unwrap()
}

#[test]
fn masks_are_what_they_say() {
    let masks = scene();
    for i in 0..WIDTH * HEIGHT {
        let (x, y) = (i % WIDTH, i / WIDTH);
        let surface = (5..23).contains(&x) && (5..13).contains(&y);
        let found = [&masks.surface, &masks.lit, &masks.unlit].map(|mask| mask[i as usize]);
        // A lamp brightens nothing by being in the picture, and is lit itself.
        assert_eq!(found, [surface, surface && x >= 14, surface && x < 14], "{x}, {y}");
    }
    assert!(masks.named().map(|(name, _)| name).eq(["surface", "lit", "unlit"]));
}

#[test]
fn edges_of_the_picture_are_no_background() {
    let depth = picture(1, vec![3.0; 1536]);
    let dark = picture(3, vec![0.0; 3 * 1536]);
    let of = |name, picture| Input { name, picture };
    let masks = Masks::new(&of("reference/depth", &depth), &of("reference/direct", &dark)).unwrap();
    assert_eq!(masks, Masks { surface: vec![true; 1536], lit: vec![false; 1536], unlit: vec![true; 1536] });
    assert!(masks.named().map(|(name, _)| name).eq(["surface", "unlit"]));

    let small = Picture::new(2, 1, 1, vec![0.0; 2]).unwrap();
    assert!(Masks::new(&of("reference/depth", &small), &of("reference/direct", &dark)).is_err());
    let nan = picture(1, vec![f32::NAN; 1536]);
    assert!(Masks::new(&of("reference/depth", &nan), &of("reference/direct", &dark)).is_err());
}
