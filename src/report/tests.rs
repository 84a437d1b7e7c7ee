//! Numbers, axes, labels, and the place of the largest error.

use super::axis::Axis;
use super::format::{bytes, count, number, ratio, signed};
use super::ink::Ink;
use super::labels::{Wish, place};
use super::plot::{plot, width};
use super::{crops, pictures};
use plotters::coord::ranged1d::ValueFormatter;
use plotters::style::text_anchor::{HPos, VPos};
use proptest::prelude::*;
use std::collections::BTreeSet;

#[test]
fn numbers_have_three_digits() {
    let given = [0.0, 0.001234, 0.9996, 9.996, 12.34, 123.4, 1234.5, 1.5e7, 1.234e-7, f64::NAN];
    let read = ["0", "0.00123", "1.00", "10.0", "12.3", "123", "1234", "1.50e7", "1.23e-7", "–"];
    assert_eq!(given.map(number), read);
    assert_eq!([signed(-0.25), signed(0.25), signed(0.0)], ["−0.250", "+0.250", "0"]);
    assert_eq!([ratio(Some(2.0)), ratio(None)], ["× 2.00", "–"]);
    assert_eq!([bytes(1000), bytes(1536), bytes(3 << 20)], ["1000 B", "1.5 KiB", "3.0 MiB"]);
    assert_eq!(
        [count(999), count(1_000), count(1_234_567)],
        ["999", "1\u{202f}000", "1\u{202f}234\u{202f}567"]
    );
}

#[test]
fn ticks_are_round() {
    let labels = |axis: &Axis| axis.ticks.iter().map(|tick| axis.format_ext(tick)).collect::<Vec<_>>();
    assert_eq!(labels(&Axis::log("", [1.5, 60.0])), ["2", "5", "10", "20", "50"]);
    assert_eq!(labels(&Axis::from_zero("", [0.9])), ["0", "0.2", "0.4", "0.6", "0.8"]);
    assert_eq!(labels(&Axis::names("", vec!["a".to_owned(), "b".to_owned()])), ["a", "b"]);
    let all_alike = Axis::log("", [3.0, 3.0]);
    assert!((all_alike.share(3.0) - 0.5).abs() < 1e-9);
}

#[test]
fn every_ink_has_a_colour_of_its_own() {
    let all = Ink::all();
    let colors: BTreeSet<_> = all
        .iter()
        .map(|ink| {
            let c = ink.color();
            (c.0, c.1, c.2)
        })
        .collect();
    assert_eq!(colors.len(), all.len());
}

#[test]
fn texts_of_charts_are_escaped() {
    let svg =
        plot([100, 50], "<b>\"", |plot| plot.text("<script>&", (5, 5), Ink::Text, (HPos::Left, VPos::Top)));
    let svg = svg.expect("it can be drawn").into_string();
    assert!(svg.contains("&lt;script&gt;&amp;") && svg.contains("&lt;b&gt;&quot;"), "{svg}");
    assert!(!svg.contains("<script>") && !svg.contains("<b>"), "{svg}");
}

#[test]
fn links_stay_in_the_folder() {
    assert_eq!(pictures::link("a b/c.exr"), "./a%20b/c.exr");
    assert_eq!(pictures::link("javascript:alert(1)"), "./javascript%3Aalert%281%29");
    assert_eq!(pictures::link("http://x"), "./http%3A//x");
}

#[test]
fn names_that_do_not_fit_are_shortened() {
    let wish = |x, y| Wish { at: (x, y), texts: vec!["a long name".to_owned(), "1".to_owned()], low: false };
    let bounds = [(0, 0), (200, 100)];
    assert_eq!(place(&[wish(50, 50)], bounds)[0].0, "a long name");
    assert_eq!(place(&[wish(50, 50)], [(0, 0), (80, 100)])[0].0, "1");
}

proptest! {
    #[test]
    fn placed_names_are_within_bounds_and_apart(at in prop::collection::vec((20..380_i32, 20..280_i32), 1..4)) {
        let wish = |at: &(i32, i32)| Wish { at: *at, texts: vec!["name".to_owned()], low: at.0 % 2 == 0 };
        let wishes: Vec<Wish> = at.iter().map(wish).collect();
        let placed = place(&wishes, [(0, 0), (400, 300)]);
        prop_assert_eq!(placed.len(), at.len());
        for (index, (text, (x, y))) in placed.iter().enumerate() {
            prop_assert!(*x >= 0 && x + width(text) <= 400 && y - 7 >= 0 && y + 7 <= 300);
            for (_, (other_x, other_y)) in &placed[index + 1..] {
                prop_assert!((x - other_x).abs() >= width(text) || (y - other_y).abs() >= 14);
            }
        }
    }

    #[test]
    fn the_worst_window_has_the_largest_sum(
        values in prop::collection::vec(0..9_u64, 30), w in 1..=6_u32, h in 1..=5_u32,
    ) {
        let sum = |x: u32, y: u32| -> u64 {
            let inside = (y..y + h).flat_map(|row| (x..x + w).map(move |column| row * 6 + column));
            inside.map(|at| values[at as usize]).sum()
        };
        let [x, y] = crops::worst(&values, [6, 5], [w, h]);
        let largest = (0..=5 - h).flat_map(|y| (0..=6 - w).map(move |x| (x, y))).map(|(x, y)| sum(x, y)).max();
        prop_assert_eq!(Some(sum(x, y)), largest);
    }
}
