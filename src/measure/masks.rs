//! Which pixels an error is the mean of.

use super::pixels::{colors, mean};
use super::{Input, check};
use crate::picture::Picture;
use crate::problem::Result;

/// A pixel counts as lit from this share of the usual direct radiance on.
const LIT: f64 = 0.01;

/// Pixels by what the reference says of them; one value for each, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Masks {
    /// The background is out, and so are its edges: those that see a surface, as all their neighbours do. A pixel
    /// that is part surface and part background says more of how edges are smoothed than of light.
    pub surface: Vec<bool>,
    /// Of `surface`, those that light reaches directly, or that give it off: whose direct radiance, the mean over
    /// channels, is above 1 % of the median over all of `surface` that have any. (A median, since a small light in
    /// the picture may be brighter than all that it lights.)
    pub lit: Vec<bool>,
    /// Of `surface`, the others: next to all their light is indirect.
    pub unlit: Vec<bool>,
}

impl Masks {
    /// From two outputs of a reference: `depth`, above 0 where any sample of a pixel meets a surface, and `direct`.
    /// Errors as those of [`super::Measures::new`].
    pub fn new(depth: &Input, direct: &Input) -> Result<Self> {
        check::same_size(depth, direct)?;
        check::finite(&[*depth, *direct])?;
        let surface = inner(depth.picture);
        let light: Vec<f64> = direct
            .picture
            .texels()
            .map(|texel| mean(texel.iter().take(colors(direct.picture)).map(|c| f64::from(*c))))
            .collect();
        let mut seen: Vec<f64> = light
            .iter()
            .zip(&surface)
            .filter(|(light, on)| **on && **light > 0.0)
            .map(|(light, _)| *light)
            .collect();
        let middle = seen.len() / 2;
        let usual =
            if seen.is_empty() { 0.0 } else { *seen.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let lit: Vec<bool> =
            light.iter().zip(&surface).map(|(light, on)| *on && *light > LIT * usual).collect();
        let unlit = surface.iter().zip(&lit).map(|(surface, lit)| *surface && !lit).collect();
        Ok(Self { surface, lit, unlit })
    }

    /// Those that have a pixel, by name.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, &[bool])> {
        let all: [(&str, &[bool]); 3] =
            [("surface", &self.surface), ("lit", &self.lit), ("unlit", &self.unlit)];
        all.into_iter().filter(|(_, mask)| mask.contains(&true))
    }
}

/// Pixels that have a depth, as have all of the up to eight around them.
fn inner(depth: &Picture) -> Vec<bool> {
    let (width, height) = (depth.width() as usize, depth.height() as usize);
    let covered: Vec<bool> = depth.texels().map(|texel| texel[0] > 0.0).collect();
    let around = |i: usize, end: usize| i.saturating_sub(1)..end.min(i + 2);
    let whole = |x, y| around(y, height).all(|y| covered[y * width..][around(x, width)].iter().all(|on| *on));
    (0..width * height).map(|i| whole(i % width, i / width)).collect()
}
