//! Numbers from which one is to be found: their scale, and how fine they are.

use std::ops::RangeInclusive;

/// Numbers from `least` to `most`, both included; `least < most` unless there is only one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    least: f64,
    most: f64,
    whole: bool,
    scale: Scale,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    Even,
    /// ln x, for positive ranges.
    Log,
    /// ln (1 + x), for ranges that begin at 0.
    LogFromZero,
}

/// A range that spans more has a logarithmic scale.
const DECADES: f64 = 100.0;
/// Steps on the scale that numbers which are not whole are told apart by.
const STEPS: f64 = 256.0;
/// Numbers of a scan, both ends included.
const SCAN: u32 = 9;
/// A range of no more whole numbers is tried number by number.
const FEW: f64 = 12.0;

impl Range {
    /// `None` if there is nothing in it: no number between its ends, or no whole one where they are to be `whole`.
    pub fn new(ends: RangeInclusive<f64>, whole: bool) -> Option<Self> {
        let (mut least, mut most) = ends.into_inner();
        if whole {
            (least, most) = (least.ceil(), most.floor());
        }
        let scale = if least > 0.0 && most / least > DECADES {
            Scale::Log
        } else if least == 0.0 && most > DECADES {
            Scale::LogFromZero
        } else {
            Scale::Even
        };
        (least.is_finite() && most.is_finite() && least <= most).then_some(Self { least, most, whole, scale })
    }

    pub fn contains(&self, number: f64) -> bool {
        (self.least..=self.most).contains(&number)
    }

    /// Where a number is on the scale, from 0 to 1.
    pub fn place(&self, number: f64) -> f64 {
        let on = |x: f64| match self.scale {
            Scale::Even => x,
            Scale::Log => x.ln(),
            Scale::LogFromZero => x.ln_1p(),
        };
        let (start, length) = (on(self.least), on(self.most) - on(self.least));
        if length > 0.0 { (on(number) - start) / length } else { 0.0 }
    }

    /// The number at a place of the scale, rounded: to a whole one, or to decimals that are much finer than a step.
    pub fn number(&self, place: f64) -> f64 {
        let number = self.exactly(place);
        let rounded = match self.whole {
            true => number.round(),
            false => shortened(number, (self.exactly(place + 1.0 / STEPS) - number).abs() / 10.0),
        };
        rounded.clamp(self.least, self.most)
    }

    fn exactly(&self, place: f64) -> f64 {
        let between = |least: f64, most: f64| least + (most - least) * place;
        match self.scale {
            Scale::Even => between(self.least, self.most),
            Scale::Log => between(self.least.ln(), self.most.ln()).exp(),
            Scale::LogFromZero => between(0.0, self.most.ln_1p()).exp_m1(),
        }
    }

    /// The number in the middle of two on the scale; `None` if they are next to each other: whole numbers without one
    /// between, others no more than a step apart.
    pub fn between(&self, low: f64, high: f64) -> Option<f64> {
        let (from, to) = (self.place(low), self.place(high));
        let middle = self.number(f64::midpoint(from, to));
        if self.whole {
            return (high - low >= 2.0).then(|| middle.clamp(low + 1.0, high - 1.0));
        }
        // Rounding moves numbers by much less than half a step.
        ((to - from) * STEPS > 1.5 && low < middle && middle < high).then_some(middle)
    }

    /// The numbers to begin with, rising: all, if they are few whole ones, or else nine at equal distances.
    pub fn scan(&self) -> Vec<f64> {
        let mut numbers: Vec<f64> = match self.whole && self.most - self.least < FEW {
            true => (0..=(self.most - self.least) as u32).map(|i| self.least + f64::from(i)).collect(),
            false => (0..SCAN).map(|i| self.number(f64::from(i) / f64::from(SCAN - 1))).collect(),
        };
        numbers.dedup();
        numbers
    }
}

/// A number with no more decimals than it takes to be right within `error`.
fn shortened(number: f64, error: f64) -> f64 {
    let digits = -error.log10().floor();
    if !digits.is_finite() {
        return number;
    }
    if digits <= 0.0 {
        let unit = 10.0_f64.powf(-digits);
        return (number / unit).round() * unit;
    }
    // By way of text: multiples of 0.1 are no short numbers.
    let text = format!("{number:.*}", digits.min(17.0) as usize);
    text.parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn scales_follow_the_span() {
        let scale = |ends, whole| Range::new(ends, whole).map(|range| range.scale);
        assert_eq!(scale(1.0..=100.0, true), Some(Scale::Even));
        assert_eq!(scale(1.0..=101.0, true), Some(Scale::Log));
        assert_eq!(scale(0.0..=100.0, false), Some(Scale::Even));
        assert_eq!(scale(0.0..=1000.0, false), Some(Scale::LogFromZero));
        assert_eq!(scale(-1000.0..=1000.0, false), Some(Scale::Even));
        assert_eq!(scale(0.2..=0.8, true), None);
        assert_eq!(scale(1.0..=0.0, false), None);
        assert_eq!(scale(0.0..=f64::INFINITY, false), None);
    }

    #[test]
    fn scans_are_short_numbers_at_equal_distances() {
        let scan = |ends, whole| Range::new(ends, whole).expect("a range").scan();
        assert_eq!(scan(0.0..=2.0, false), [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0]);
        assert_eq!(
            scan(1.0..=65536.0, true),
            [1.0, 4.0, 16.0, 64.0, 256.0, 1024.0, 4096.0, 16384.0, 65536.0]
        );
        assert_eq!(scan(3.0..=5.0, true), [3.0, 4.0, 5.0]);
        assert_eq!(scan(7.0..=7.0, true), [7.0]);
        assert_eq!(scan(7.5..=7.5, false), [7.5]);
        assert!(scan(0.0..=13.0, true).len() == 9);
    }

    fn range() -> impl Strategy<Value = Range> {
        let ends = prop_oneof![-1e3..1e3_f64, Just(0.0), 1e-3..1.0_f64];
        (ends, 1e-2..1e6_f64, any::<bool>())
            .prop_filter_map("empty", |(least, length, whole)| Range::new(least..=least + length, whole))
    }

    proptest! {
        #[test]
        fn places_and_numbers_are_inverse(range in range(), place in 0.0..=1.0_f64) {
            let number = range.number(place);
            prop_assert!(range.contains(number));
            if range.whole {
                prop_assert_eq!(number, number.round());
            } else if range.least < range.most {
                prop_assert!((range.place(number) - place).abs() < 0.1 / STEPS, "{number}");
            }
        }

        #[test]
        fn halving_ends_and_leaves_no_whole_number_out(range in range(), place in 0.0..1.0_f64) {
            let (mut low, mut high) = (range.least, range.most);
            let wanted = range.number(place);
            let mut steps = 0;
            while let Some(middle) = range.between(low, high) {
                prop_assert!(low < middle && middle < high);
                if middle <= wanted { low = middle } else { high = middle }
                steps += 1;
                prop_assert!(steps < 40);
            }
            if range.whole {
                prop_assert!(wanted == low || wanted == high);
            } else {
                prop_assert!(range.place(high) - range.place(low) < 2.0 / STEPS);
            }
        }
    }
}
