//! Structural similarity: Wang, Bovik, Sheikh and Simoncelli 2004, Image quality assessment: from error visibility to
//! structural similarity.
//!
//! As published: a Gaussian window of 11×11 pixels with σ = 1.5, K₁ = 0.01, K₂ = 0.03, weighted (not sample) variances,
//! windows that lie wholly inside the picture, no downscaling. Of coded values from 0 to 1, in each colour channel; a
//! pixel has the mean over its channels. A mask takes the windows whose centre is in it.

use super::pixels::{mean, within};
use crate::picture::Encoded;
use rayon::prelude::*;

const RADIUS: usize = 5;
const SIZE: usize = 2 * RADIUS + 1;
const SIGMA: f64 = 1.5;
/// (K L)² with L = 1.
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// Weighted means of t, r, t², r² and t r.
type Moments = [f64; 5];

/// The similarity at the centre of each window.
pub(super) struct Map {
    /// Of the picture.
    width: usize,
    /// `width − 10` in a row.
    values: Vec<f64>,
}

impl Map {
    /// Of the first `channels` of two pictures of one size; `None` where no window fits.
    pub(super) fn new(test: &Encoded, truth: &Encoded, channels: usize) -> Option<Self> {
        let (width, height) = (truth.width() as usize, truth.height() as usize);
        if width.min(height) < SIZE {
            return None;
        }
        let weights = weights();
        let rows = (0..=height - SIZE).into_par_iter().map(|y| {
            let rows = y * width..(y + SIZE) * width;
            let [t, r] = [test, truth].map(|picture| &picture.data()[4 * rows.start..4 * rows.end]);
            let mut row = vec![0.0; width + 1 - SIZE];
            for channel in 0..channels {
                let similarity = similarities(t, r, channel, width, &weights);
                row.iter_mut().zip(similarity).for_each(|(sum, ssim)| *sum += ssim / channels as f64);
            }
            row
        });
        let values = rows.collect::<Vec<_>>().concat();
        Some(Self { width, values })
    }

    /// `None` if no window's centre is in the mask.
    pub(super) fn mean(&self, mask: Option<&[bool]>) -> Option<f64> {
        let mask: Option<Vec<bool>> = mask.map(|mask| {
            let rows = mask.chunks_exact(self.width).skip(RADIUS);
            rows.flat_map(|row| &row[RADIUS..self.width - RADIUS]).copied().take(self.values.len()).collect()
        });
        let mut values = within(mask.as_deref(), self.values.iter().copied()).peekable();
        values.peek()?;
        Some(mean(values))
    }
}

/// Of a row of windows: `t` and `r` are the 11 rows of texels that they cover.
fn similarities(
    t: &[u8],
    r: &[u8],
    channel: usize,
    width: usize,
    weights: &[f64; SIZE],
) -> impl Iterator<Item = f64> {
    let mut columns = vec![Moments::default(); width];
    let rows = t.chunks_exact(4 * width).zip(r.chunks_exact(4 * width));
    for ((t, r), weight) in rows.zip(weights) {
        for ((column, t), r) in columns.iter_mut().zip(t.chunks_exact(4)).zip(r.chunks_exact(4)) {
            let [t, r] = [t, r].map(|texel| f64::from(texel[channel]) / 255.0);
            add(column, *weight, &[t, r, t * t, r * r, t * r]);
        }
    }
    let windows = 0..=width - SIZE;
    windows.map(move |x| {
        let mut moments = Moments::default();
        columns[x..x + SIZE]
            .iter()
            .zip(weights)
            .for_each(|(column, weight)| add(&mut moments, *weight, column));
        similarity(moments)
    })
}

fn add(sum: &mut Moments, weight: f64, moments: &Moments) {
    sum.iter_mut().zip(moments).for_each(|(sum, moment)| *sum += weight * moment);
}

fn similarity([t, r, tt, rr, tr]: Moments) -> f64 {
    let (variances, covariance) = ((tt - t * t) + (rr - r * r), tr - t * r);
    (2.0 * t * r + C1) * (2.0 * covariance + C2) / ((t * t + r * r + C1) * (variances + C2))
}

/// One axis of the window; the sum is 1.
fn weights() -> [f64; SIZE] {
    let weights: [f64; SIZE] =
        std::array::from_fn(|i| (-(i as f64 - RADIUS as f64).powi(2) / (2.0 * SIGMA * SIGMA)).exp());
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}
