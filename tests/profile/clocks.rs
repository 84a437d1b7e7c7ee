//! GPU times on the CPU's clock, where the distance between the two is known.

use proptest::prelude::*;
use voxgi::profile::align::{Bracket, align};

/// Frames as they would be seen if GPU times were `offset` less than the CPU's, plus `drift` more each frame.
fn seen(frames: &[(u32, u32, u32)], offset: i64, drift: i64) -> (Vec<Bracket>, Vec<i64>) {
    let mut now = 1000;
    let mut truths = Vec::new();
    let mut brackets = Vec::new();
    for (index, (wait, work, tail)) in
        frames.iter().map(|f| (i64::from(f.0), i64::from(f.1), i64::from(f.2))).enumerate()
    {
        let truth = offset + drift * index as i64;
        let (submit, first) = (now, now + wait);
        let last = first + work;
        now = last + tail;
        brackets.push(Bracket { submit, done: now, first: first - truth, last: last - truth });
        truths.push(truth);
    }
    (brackets, truths)
}

proptest! {
    #[test]
    fn the_true_distance_is_within_what_is_said(
        frames in prop::collection::vec((0..1_000_000u32, 1..100_000_000u32, 0..1_000_000u32), 1..30),
        offset in -1_000_000_000_000i64..1_000_000_000_000,
    ) {
        let (brackets, _) = seen(&frames, offset, 0);
        let alignment = align(&brackets);
        prop_assert!(alignment.steady);
        prop_assert_eq!(alignment.offsets.len(), frames.len());
        for found in &alignment.offsets {
            prop_assert!((found - offset).unsigned_abs() <= alignment.within);
        }
        // No frame alone can say it better.
        let narrowest = frames.iter().map(|(wait, _, tail)| u64::from(wait + tail).div_ceil(2)).min();
        prop_assert!(Some(alignment.within) <= narrowest);
    }

    /// Clocks that drift apart by more than the brackets leave open.
    #[test]
    fn drift_is_noticed_and_each_frame_put_right(
        frames in prop::collection::vec((0..1000u32, 1..100_000u32, 0..1000u32), 3..20),
        drift in 5000i64..100_000,
    ) {
        let (brackets, truths) = seen(&frames, 77, drift);
        let alignment = align(&brackets);
        prop_assert!(!alignment.steady);
        for (found, truth) in alignment.offsets.iter().zip(truths) {
            prop_assert!((found - truth).unsigned_abs() <= alignment.within);
        }
    }
}

#[test]
fn no_frames_need_no_distance() {
    assert!(align(&[]).offsets.is_empty());
}
