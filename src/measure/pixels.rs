//! The measures that look at each pixel alone.

use crate::picture::Picture;

/// relMSE's share of M² that keeps dark pixels from deciding.
const FLOOR: f64 = 0.01;
/// The part of the pixels that a trimmed mean leaves out: one in so many.
const TRIM: usize = 1000;
/// The share of M that keeps relative differences of dark pixels small.
const DIFFERENCE_FLOOR: f64 = 0.1;

/// Channels that are measured: not alpha.
pub(super) fn colors(picture: &Picture) -> usize {
    picture.channels().min(3) as usize
}

/// Of at least one value.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0usize), |(sum, count), value| (sum + value, count + 1));
    sum / count as f64
}

/// The values of the mask's pixels.
pub(super) fn within<T>(mask: Option<&[bool]>, values: impl Iterator<Item = T>) -> impl Iterator<Item = T> {
    values.enumerate().filter(move |(i, _)| mask.is_none_or(|mask| mask[*i])).map(|(_, value)| value)
}

/// The colour channels of each of the mask's pixels of two pictures, channel by channel.
fn pairs<'a>(
    a: &'a Picture,
    b: &'a Picture,
    mask: Option<&'a [bool]>,
) -> impl Iterator<Item = impl Iterator<Item = (f64, f64)>> {
    let colors = colors(b);
    within(mask, a.texels().zip(b.texels()))
        .map(move |(a, b)| a.iter().zip(b).take(colors).map(|(a, b)| (f64::from(*a), f64::from(*b))))
}

/// M.
fn mean_size(picture: &Picture) -> f64 {
    mean(picture.texels().flat_map(|texel| texel.iter().take(colors(picture))).map(|r| f64::from(r.abs())))
}

/// Mean (t−r)².
pub(super) fn squares(test: &Picture, truth: &Picture, mask: Option<&[bool]>) -> f64 {
    mean(pairs(test, truth, mask).flatten().map(|(t, r)| (t - r).powi(2)))
}

/// Mean 2|t−r| / (|t|+|r|).
pub(super) fn smape(test: &Picture, truth: &Picture, mask: Option<&[bool]>) -> f64 {
    mean(
        pairs(test, truth, mask)
            .flatten()
            .map(|(t, r)| if t == r { 0.0 } else { 2.0 * (t - r).abs() / (t.abs() + r.abs()) }),
    )
}

/// Mean t / mean r.
pub(super) fn bias(test: &Picture, truth: &Picture, mask: Option<&[bool]>) -> Option<f64> {
    let (t, r) = pairs(test, truth, mask).flatten().fold((0.0, 0.0), |(a, b), (t, r)| (a + t, b + r));
    (r > 0.0).then(|| t / r)
}

/// (t−r)² / (r² + 0.01 M²) of each pixel: the mean over its channels.
pub(super) fn relative_squares(test: &Picture, truth: &Picture, mask: Option<&[bool]>) -> Option<Vec<f64>> {
    let floor = floor(truth)?;
    let pixel =
        |channels| mean(Iterator::map(channels, |(t, r): (f64, f64)| (t - r).powi(2) / (r * r + floor)));
    Some(pairs(test, truth, mask).map(pixel).collect())
}

/// Mean v / (r² + 0.01 M²), unless no pixel has a variance.
pub(super) fn relative_variance(truth: &Picture, variance: &Picture, mask: Option<&[bool]>) -> Option<f64> {
    let floor = floor(truth)?;
    if mean_size(variance) == 0.0 {
        return None;
    }
    Some(mean(pairs(variance, truth, mask).flatten().map(|(v, r)| v / (r * r + floor))))
}

/// 0.01 M², unless that is 0.
fn floor(truth: &Picture) -> Option<f64> {
    Some(FLOOR * mean_size(truth).powi(2)).filter(|floor| *floor > 0.0)
}

/// Without the largest thousandth. Leaves the values in another order.
pub(super) fn trimmed_mean(values: &mut [f64]) -> f64 {
    let kept = values.len() - values.len() / TRIM;
    if let Some(last) = kept.checked_sub(1) {
        values.select_nth_unstable_by(last, f64::total_cmp);
    }
    mean(values[..kept].iter().copied())
}

/// Σ(t−r) / Σ(|r| + 0.1 M) of each pixel; 0/0 as 0.
pub(super) fn differences<'a>(test: &'a Picture, truth: &'a Picture) -> impl Iterator<Item = f64> + use<'a> {
    let floor = DIFFERENCE_FLOOR * mean_size(truth);
    pairs(test, truth, None).map(move |channels| {
        let sums = |(above, below), (t, r): (f64, f64)| (above + (t - r), below + (r.abs() + floor));
        let (above, below) = channels.fold((0.0, 0.0), sums);
        if above == 0.0 { 0.0 } else { above / below }
    })
}
