//! Quantiles against another way to compute them.

use proptest::prelude::*;
use voxgi::record::quantile;

/// By ranks: `q` of the way from the least to the greatest along the samples in order, found by counting which samples
/// are smaller instead of by sorting.
fn by_rank(samples: &[f64], q: f64) -> f64 {
    let rank = |k: usize| {
        samples
            .iter()
            .enumerate()
            .find(|(i, x)| {
                let before = |(j, y): &(usize, &f64)| *y < *x || (*y == *x && j < i);
                samples.iter().enumerate().filter(before).count() == k
            })
            .map(|(_, x)| *x)
            .expect("a sample of each rank")
    };
    let steps = (samples.len() - 1) as f64;
    let mut k = 0;
    while k + 1 < samples.len() && (k + 1) as f64 <= q * steps {
        k += 1;
    }
    let part = q * steps - k as f64;
    let next = rank((k + 1).min(samples.len() - 1));
    (1.0 - part) * rank(k) + part * next
}

proptest! {
    #[test]
    fn quantiles_are_those_of_ranks(samples in prop::collection::vec(0.0..1e4, 1..40), q in 0.0..=1.0) {
        let found = quantile(&samples, q).expect("samples");
        let expected = by_rank(&samples, q);
        prop_assert!((found - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{found}, {expected}");
    }

    #[test]
    fn half_lie_on_each_side_of_the_median(samples in prop::collection::vec(0.0..10.0, 1..60)) {
        let median = quantile(&samples, 0.5).expect("samples");
        let below = samples.iter().filter(|x| **x < median - 1e-12).count();
        let above = samples.iter().filter(|x| **x > median + 1e-12).count();
        prop_assert!(2 * below <= samples.len() && 2 * above <= samples.len());
    }
}

#[test]
fn nothing_has_no_median() {
    assert_eq!(quantile(&[], 0.5), None);
    // The control: the other way is no copy of the first.
    assert_eq!(by_rank(&[3.0, 1.0, 2.0, 10.0], 0.5), 2.5);
    assert_ne!(by_rank(&[3.0, 1.0, 2.0, 10.0], 0.1), 1.0);
}
