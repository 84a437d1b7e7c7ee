//! A median, and how sure it is.

use crate::record::quantile;
use serde::Serialize;

/// Of two medians whose intervals don't touch it is sure which is less.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    pub median: f64,
    /// Ends of the interval.
    pub low: f64,
    pub high: f64,
}

/// Most that is outside of an interval on each side, as a probability: 95 % are within.
const TAIL: f64 = 0.025;

impl Estimate {
    /// The median of `samples`, and the samples between which the true median lies with a probability of at least 95 %,
    /// whatever the distribution: each sample is below it or above it with equal chance, so that the number below is
    /// binomial (W. J. Conover, Practical Nonparametric Statistics, ch. 3.2). Below six samples no two are that far
    /// apart; the interval is then from the least to the most, and of a single sample, it is that.
    /// `None` without samples.
    pub fn of(samples: &[f64]) -> Option<Self> {
        let mut sorted = samples.to_vec();
        sorted.sort_by(f64::total_cmp);
        let rank = rank(sorted.len());
        let (low, high) = (*sorted.get(rank)?, *sorted.get(sorted.len() - 1 - rank)?);
        Some(Self { median: quantile(&sorted, 0.5)?, low, high })
    }

    /// Whether it is surely more than `other`.
    pub fn exceeds(&self, other: &Self) -> bool {
        self.low > other.high
    }
}

/// How many of `count` samples are left out on each side: the most, so that no more than so many are below the median
/// with a probability of at most [`TAIL`].
fn rank(count: usize) -> usize {
    // Probability that exactly `below` of them are; 0 where there are too many for it to matter.
    let mut exactly = 0.5_f64.powi(i32::try_from(count).unwrap_or(i32::MAX));
    let (mut rank, mut at_most) = (0, exactly);
    while at_most <= TAIL && 2 * (rank + 1) < count {
        rank += 1;
        exactly *= (count - rank + 1) as f64 / rank as f64;
        at_most += exactly;
    }
    rank.saturating_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_the_tables() {
        // Ranks of the lower end, from 1, of 95 % intervals: Conover's table A3, cut to whole samples.
        let table =
            [(1, 1), (5, 1), (6, 1), (8, 1), (9, 2), (11, 2), (12, 3), (15, 4), (20, 6), (25, 8), (30, 10)];
        for (count, lower) in table {
            let samples: Vec<f64> = (1..=count).rev().map(f64::from).collect();
            let estimate = Estimate::of(&samples).expect("samples");
            let upper = f64::from(count + 1) - f64::from(lower);
            assert_eq!((estimate.low, estimate.high), (f64::from(lower), upper), "of {count}");
            assert_eq!(estimate.median, f64::from(count + 1) / 2.0);
        }
        assert_eq!(Estimate::of(&[]), None);
    }

    #[test]
    fn the_median_is_within_in_ninety_five_of_a_hundred() {
        let mut random = fastrand::Rng::with_seed(7);
        for count in [6, 9, 15] {
            let mut missed = 0;
            for _ in 0..4000 {
                // A skewed distribution whose median is 1: ln 2 is that of the exponential one.
                let samples: Vec<f64> =
                    (0..count).map(|_| -(1.0 - random.f64()).ln() / std::f64::consts::LN_2).collect();
                let estimate = Estimate::of(&samples).expect("samples");
                missed += u32::from(estimate.low > 1.0 || estimate.high < 1.0);
            }
            // 5 %, and four standard deviations more; and not so wide that it says nothing.
            assert!((20..255).contains(&missed), "{missed} of 4000 with {count} samples");
        }
    }

    #[test]
    fn only_intervals_apart_are_sure() {
        let of = |low, high| Estimate { median: f64::midpoint(low, high), low, high };
        assert!(of(2.0, 3.0).exceeds(&of(0.0, 1.9)));
        assert!(!of(2.0, 3.0).exceeds(&of(0.0, 2.0)));
        assert!(!of(0.0, 1.0).exceeds(&of(2.0, 3.0)));
    }
}
