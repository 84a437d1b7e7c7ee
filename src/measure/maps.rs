//! Errors as pictures.

use crate::picture::{Encoded, Picture};
use colorous::{Color, MAGMA, RED_BLUE};

/// Of the size of `like`.
pub(super) fn encoded(like: &Picture, colors: impl Iterator<Item = Color>) -> Option<Encoded> {
    Encoded::new(
        like.width(),
        like.height(),
        colors.flat_map(|color| [color.r, color.g, color.b, 255]).collect(),
    )
}

/// From 0 (black) to 1 (light yellow), with steps that look even.
pub(super) fn error_color(error: f32) -> Color {
    MAGMA.eval_continuous(f64::from(error))
}

/// From −1 (blue) over 0 (nearly white) to 1 (red): ColorBrewer's RdBu, made for those who don't see all colours too.
/// Lightness says how much, hue which way.
pub(super) fn signed_color(difference: f64) -> Color {
    RED_BLUE.eval_continuous((1.0 - difference) / 2.0)
}
