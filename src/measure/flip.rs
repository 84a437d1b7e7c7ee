//! ꟻLIP: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild 2020, ꟻLIP: A Difference Evaluator for
//! Alternating Images. What a person notices who sees the two pictures in turn.
//!
//! The authors' own code, for pictures of low dynamic range, with what their tool has as default: a display of 3840
//! pixels on 0.7 m, seen from 0.7 m (67.02 pixels per degree).

use super::refuse;
use crate::picture::Encoded;
use crate::problem::Result;
use nv_flip::FlipImageRgb8;

/// Metres to the display, its pixels and its metres in width.
const DISPLAY: (f32, f32, f32) = (0.7, 3840.0, 0.7);

/// For each pixel, of two pictures of one size; without their alpha. Error: more pixels than the authors' 32-bit
/// indices can tell apart.
pub(super) fn map(test: &Encoded, truth: &Encoded) -> Result<Vec<f32>> {
    let (width, height) = (truth.width(), truth.height());
    if u64::from(width) * u64::from(height) * 3 > i32::MAX as u64 {
        let message = format!("ꟻLIP has no measure of pictures as large as {width}×{height}");
        return Err(refuse("measure-size", message, "render smaller ones").into());
    }
    let [test, truth] = [test, truth].map(|picture| {
        let colors = picture.data().chunks_exact(4).flat_map(|texel| &texel[..3]).copied();
        FlipImageRgb8::with_data(width, height, &colors.collect::<Vec<u8>>())
    });
    let pixels_per_degree = nv_flip::pixels_per_degree(DISPLAY.0, DISPLAY.1, DISPLAY.2);
    Ok(nv_flip::flip(truth, test, pixels_per_degree).to_vec())
}
