//! The search against functions whose least value is found by looking at all.

use super::estimate::Estimate;
use super::range::Range;
use super::search::{ALIKE, Found, Known, MOST, Objective, choose, choose_unordered, search};
use super::table::{Measuring, Quantity, Series};
use crate::problem::Result;
use proptest::prelude::*;
use std::ops::RangeInclusive;

/// A function, with noise around it or without, that counts how often it is asked.
struct Function<F> {
    of: F,
    /// Standard deviation, as a part of the value.
    noise: f64,
    /// How many times slower or faster the machine may be from one batch to the next.
    drift: f64,
    rounds: usize,
    random: fastrand::Rng,
    asked: Vec<f64>,
    /// Whether yardsticks are measured as they should be.
    yardstick: bool,
}

impl<F: Fn(f64) -> f64> Function<F> {
    fn exact(of: F) -> Self {
        let random = fastrand::Rng::with_seed(0);
        Self { of, noise: 0.0, drift: 1.0, rounds: 1, random, asked: Vec::new(), yardstick: true }
    }

    fn noisy(of: F, noise: f64, drift: f64, seed: u64) -> Self {
        let random = fastrand::Rng::with_seed(seed);
        Self { noise, drift, rounds: 9, random, ..Self::exact(of) }
    }

    fn series(&mut self, number: f64, speed: f64) -> Vec<f64> {
        let sample = |_| {
            // The sum of twelve has a variance of one.
            let normal: f64 = (0..12).map(|_| self.random.f64()).sum::<f64>() - 6.0;
            (self.of)(number) * (1.0 + self.noise * normal).max(0.1) * speed
        };
        (0..self.rounds).map(sample).collect()
    }

    fn found(&mut self, range: &Range) -> Found {
        search(range, &[], &mut Measuring::new(self, 1)).expect("a number")
    }
}

impl<F: Fn(f64) -> f64> Quantity for Function<F> {
    fn samples(&mut self, _: usize, numbers: &[f64], yardstick: Option<f64>) -> Result<Vec<Series>> {
        self.asked.extend(numbers);
        let speed = self.drift.powf(2.0 * self.random.f64() - 1.0);
        let yardstick = yardstick.filter(|_| self.yardstick);
        let yardstick = yardstick.map(|number| (number, self.series(number, speed)));
        let series = numbers
            .iter()
            .map(|number| Series { samples: self.series(*number, speed), yardstick: yardstick.clone() });
        Ok(series.collect())
    }

    fn is_exact(&self) -> bool {
        self.noise == 0.0
    }
}

fn whole(ends: RangeInclusive<i32>) -> Range {
    let (least, most) = ends.into_inner();
    Range::new(f64::from(least)..=f64::from(most), true).expect("a range")
}

fn real(ends: RangeInclusive<f64>) -> Range {
    Range::new(ends, false).expect("a range")
}

/// The least of all whole numbers, and all that have it.
fn brute(ends: RangeInclusive<i32>, of: impl Fn(f64) -> f64) -> (f64, Vec<f64>) {
    let all: Vec<(f64, f64)> = ends.map(f64::from).map(|number| (number, of(number))).collect();
    let least = all.iter().map(|(_, value)| *value).fold(f64::INFINITY, f64::min);
    (least, all.iter().filter(|(_, value)| *value == least).map(|(number, _)| *number).collect())
}

#[test]
fn short_ranges_are_tried_number_by_number() {
    for (ends, least) in [(4..=4, 4.0), (4..=5, 5.0), (4..=6, 6.0), (1..=3, 3.0), (-1..=1, 1.0)] {
        let mut function = Function::exact(|x| 100.0 - x);
        assert_eq!(function.found(&whole(ends.clone())).number, least, "{ends:?}");
        assert_eq!(function.asked.len(), ends.count());
    }
}

#[test]
fn a_minimum_at_an_end_is_found() {
    for (range, first, last) in [
        (whole(0..=100_000), 0.0, 100_000.0),
        (whole(1..=1_000_000), 1.0, 1e6),
        (whole(-50..=50), -50.0, 50.0),
        (real(0.0..=1.0), 0.0, 1.0),
        (real(0.001..=10.0), 0.001, 10.0),
    ] {
        // A slope so steep that no neighbour is within what counts as alike.
        assert_eq!(Function::exact(|x: f64| 1.0 + range.place(x) * 1e9).found(&range).number, first);
        assert_eq!(Function::exact(|x: f64| 1.0 + (1.0 - range.place(x)) * 1e9).found(&range).number, last);
    }
}

#[test]
fn of_a_flat_function_the_middle_is_chosen_after_the_scan() {
    for (range, middle) in [(real(0.0..=2.0), 1.0), (whole(1..=65536), 256.0), (whole(3..=9), 6.0)] {
        let mut function = Function::exact(|_| 3.0);
        assert_eq!(function.found(&range).number, middle);
        assert_eq!(function.asked, range.scan(), "nothing is finer than what is alike");
    }
    // The control: a hole in it is not flat.
    let mut function = Function::exact(|x| if x == 4.0 { 1.0 } else { 3.0 });
    assert_eq!(function.found(&whole(3..=9)).number, 4.0);
}

#[test]
fn of_a_wide_stair_the_middle_is_chosen() {
    let stairs = |x: f64| match x as i64 {
        ..40 => 9.0,
        40..300 => 5.0,
        300..1000 => 2.0,
        1000..7000 => 6.0,
        _ => 8.0,
    };
    let range = whole(1..=65536);
    let mut function = Function::exact(stairs);
    let found = function.found(&range);
    let (first, last) = (range.place(300.0), range.place(999.0));
    let away = |number: f64, place: f64| (range.place(number) - place).abs() / (last - first);
    assert!(found.flat[0] >= 300.0 && found.flat[1] <= 999.0);
    assert!(away(found.flat[0], first) < 0.15 && away(found.flat[1], last) < 0.15, "{found:?}");
    assert!(away(found.number, f64::midpoint(first, last)) < 0.25, "{found:?}");
    assert!(function.asked.len() < 30, "{:?}", function.asked);
}

#[test]
fn lists_are_chosen_from_in_their_order_or_without_one() {
    let chosen = |of: fn(f64) -> f64, count: u32, ordered: bool| {
        let mut function = Function::exact(of);
        let mut measuring = Measuring::new(&mut function, 1);
        let all: Vec<f64> = (0..count).map(f64::from).collect();
        measuring.measure(&all).expect("measured");
        let found = if ordered { choose(&mut measuring, |x| x) } else { choose_unordered(&mut measuring) };
        found.map(|found| found.number)
    };
    let plateau = |x: f64| if (2.0..=6.0).contains(&x) { 1.0 } else { 2.0 };
    assert_eq!(chosen(plateau, 9, true), Ok(4.0));
    assert_eq!(chosen(plateau, 1, true), Ok(0.0));
    assert_eq!(chosen(|x| [3.0, 1.0, 2.0, 1.5][x as usize], 4, false), Ok(1.0));
    assert!(chosen(plateau, 0, false).is_err());
}

#[test]
fn luck_is_measured_again() {
    // All are alike but for noise, which makes one of the first samples very small.
    struct Lucky(Vec<Known>);
    let known =
        |number: f64, median: f64| Known { number, estimate: Estimate { median, low: 0.5, high: 2.0 } };
    impl Objective for Lucky {
        fn measure(&mut self, _: &[f64]) -> Result<()> {
            Ok(())
        }
        fn again(&mut self, numbers: &[f64]) -> Result<()> {
            for known in self.0.iter_mut().filter(|known| numbers.contains(&known.number)) {
                let median = if known.number == 1.0 { 1.5 } else { 1.0 };
                known.estimate = Estimate { median, low: median - 0.1, high: median + 0.1 };
            }
            Ok(())
        }
        fn known(&self) -> Vec<Known> {
            self.0.clone()
        }
    }
    let mut lucky = Lucky(vec![known(1.0, 0.6), known(2.0, 1.0), known(3.0, 1.1), known(4.0, 1.2)]);
    let found = choose(&mut lucky, |number| number).expect("one");
    assert_eq!((found.number, found.flat), (3.0, [2.0, 4.0]));
}

/// A function that falls to its least at `at` and rises from there, in stairs of `step` where that is above 0.
fn valley(at: f64, power: f64, step: f64) -> impl Fn(f64) -> f64 {
    move |x| {
        let away = 1.0 + (x - at).abs().powf(power);
        if step > 0.0 { (away / step).ceil() * step } else { away }
    }
}

proptest! {
    #[test]
    fn whole_numbers_are_found_exactly(
        (least, length) in (-300..300_i32, 0..4000_i32),
        at in 0.0..1.0_f64,
        power in 1.0..3.0_f64,
        step in prop_oneof![Just(0.0), 0.1..30.0_f64],
    ) {
        let ends = least..=least + length;
        let of = valley(f64::from(least) + (at * f64::from(length)).round(), power, step);
        let mut function = Function::exact(&of);
        let found = function.found(&whole(ends.clone()));
        let (best, all) = brute(ends, &of);
        prop_assert!(of(found.number) <= ALIKE * best, "{found:?} for {all:?}");
        // In each round of halving three; and none is asked twice.
        let rounds = f64::from(length + 1).log2().ceil() as usize;
        prop_assert!(function.asked.len() <= 12 + 3 * rounds + 3, "{:?}", function.asked);
        let mut asked = function.asked.clone();
        asked.sort_by(f64::total_cmp);
        asked.dedup();
        prop_assert_eq!(asked.len(), function.asked.len());
        // What is as good on both sides is as good: brute force over a flat without noise.
        prop_assert!(found.flat[0] <= found.number && found.number <= found.flat[1]);
    }

    #[test]
    fn real_numbers_are_found_within_a_step(
        least in prop_oneof![-10.0..10.0_f64, Just(0.0), 1e-4..1e-2_f64],
        length in 0.1..1e4_f64,
        at in 0.0..=1.0_f64,
    ) {
        let range = real(least..=least + length);
        let place = |x| range.place(x);
        // So steep that what counts as alike is much less than a step.
        let of = |x| 1.0 + 1e6 * (place(x) - at).abs();
        let mut function = Function::exact(of);
        let found = function.found(&range);
        prop_assert!((place(found.number) - at).abs() < 2.0 / 256.0, "{found:?}");
        prop_assert!(function.asked.len() <= 9 + 3 * 6, "{:?}", function.asked);
    }

    #[test]
    fn noise_and_drift_do_not_lead_far_astray(
        seed in 0..10_000_u64,
        at in 0.0..=1.0_f64,
        flat in 0.0..0.3_f64,
        drift in prop_oneof![Just(1.0), 1.0..2.0_f64],
    ) {
        let mut function = Function::noisy(slopes(at, flat, 1.0), 0.02, drift, seed);
        let found = function.found(&whole(1..=4096));
        // Some standard errors of medians of nine on both sides, and what counts as alike.
        let of = slopes(at, flat, 1.0)(found.number);
        prop_assert!(of <= 1.12, "{of} for {found:?}");
        prop_assert!(function.asked.len() <= 2 * MOST);
    }
}

/// 1 where it is flat, and `steep` more at the far end of the scale from 1 to 4096.
fn slopes(at: f64, flat: f64, steep: f64) -> impl Fn(f64) -> f64 {
    move |x: f64| 1.0 + steep * ((x.ln() / 4096.0_f64.ln() - at).abs() - flat).max(0.0)
}

#[test]
fn without_a_yardstick_drift_leads_astray() {
    // The control of the property above: how far off the worst of so many searches is.
    let worst = |yardstick: bool| {
        let off = (0..60).map(|seed| {
            let of = slopes(f64::from(seed % 10) / 10.0, 0.0, 6.0);
            let mut function = Function { yardstick, ..Function::noisy(&of, 0.02, 2.0, seed as u64) };
            of(function.found(&whole(1..=4096)).number)
        });
        off.fold(0.0, f64::max)
    };
    let (with, without) = (worst(true), worst(false));
    assert!(with < 1.12 && without > 1.2, "{with} with, {without} without");
}
