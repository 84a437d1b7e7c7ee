//! Measures of error: how far a picture is from its reference.
//!
//! [`Measures::new`] holds one picture against one reference and refuses what can't be compared; [`Measures::errors`]
//! gives the numbers, over all pixels or over those of a mask ([`Masks`]). t is the picture, r the reference; alpha is
//! not measured; sums are in 64 bits. M is the mean of |r| over all pixels and channels of the reference, also under a
//! mask, so that the means of masks that share out the pixels add up to that of all.
//!
//! | name | is | if alike | left out |
//! |---|---|---|---|
//! | `rmse` | √ mean (t−r)², in the unit of the pictures | 0 | – |
//! | `relmse` | mean (t−r)² / (r² + 0.01 M²) over pixels and channels | 0 | r black everywhere |
//! | `relmse_trimmed` | the same without the 0.1 % of pixels (rounded down) where it is largest | 0 | as `relmse` |
//! | `relmse_above_noise` | `relmse` less the reference's own [`noise`], at least 0 | 0 | noise not known |
//! | `smape` | mean 2\|t−r\| / (\|t\|+\|r\|), 0/0 as 0; 0 to 2 | 0 | – |
//! | `bias` | mean t / mean r: the ratio of means | 1 | mean r not above 0; [`Kind::Other`] |
//! | `ssim` | mean SSIM (Wang et al. 2004: 11×11, σ = 1.5); −1 to 1 | 1 | no such window; [`Kind::Other`] |
//! | `flip` | mean ꟻLIP (Andersson et al. 2020: LDR, 67.02 pixels per degree); 0 to 1 | 0 | [`Kind::Other`] |
//!
//! `ssim` and `flip` are of what a display shows ([`crate::picture::shown`], 8 bits, by [`Kind::display`]), so that
//! whoever has the PNG files of both pictures can compute them again.

mod check;
mod flip;
mod maps;
mod masks;
mod pixels;
mod ssim;
#[cfg(test)]
mod tests;

pub use masks::Masks;

use crate::picture::{Curve, Encoded, Picture, shown};
use crate::problem::{Problem, Result};
use std::collections::BTreeMap;

/// How the numbers of an output are to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Radiances: unbounded from 0, shown through exposure and tone curve.
    Light,
    /// Shares from 0 to 1, shown as they are.
    Share,
    /// Signed, or in units that no display has: neither shown nor summed up.
    Other,
}

impl Kind {
    /// Of an output, by its standard name. What has none is [`Kind::Other`].
    pub fn of(output: &str) -> Self {
        match output {
            "color" | "direct" | "indirect" => Kind::Light,
            "ambient_occlusion" | "albedo" => Kind::Share,
            _ => Kind::Other,
        }
    }

    /// The curve and exposure that pictures of this kind are shown and measured by.
    pub fn display(self, options: &Options) -> (Curve, f32) {
        match self {
            Kind::Light => (options.curve, options.exposure),
            Kind::Share | Kind::Other => (Curve::Clip, 0.0),
        }
    }
}

/// A picture and what it is called in messages, such as `draft/color`.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    pub name: &'a str,
    pub picture: &'a Picture,
}

/// A reference.
#[derive(Clone, Copy, Debug)]
pub struct Truth<'a> {
    pub name: &'a str,
    pub picture: &'a Picture,
    /// Of the mean that `picture` is, not of its samples; for each pixel and channel.
    pub variance: Option<&'a Picture>,
}

impl<'a> Truth<'a> {
    fn input(&self) -> Input<'a> {
        Input { name: self.name, picture: self.picture }
    }
}

/// How light is shown before it is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// In stops: 1 doubles.
    pub exposure: f32,
    pub curve: Curve,
}

/// A picture held against its reference.
pub struct Measures<'a> {
    kind: Kind,
    test: Input<'a>,
    truth: Truth<'a>,
    ssim: Option<ssim::Map>,
    /// For each pixel.
    flip: Option<Vec<f32>>,
}

impl<'a> Measures<'a> {
    /// Computes what needs a pixel's neighbours, once for all masks. Errors are inputs `measure-alike` (a picture
    /// against itself), `measure-size`, `measure-variance`, `measure-exposure`, and failures `measure-finite`.
    pub fn new(kind: Kind, test: Input<'a>, truth: Truth<'a>, options: &Options) -> Result<Self> {
        check::pair(&test, &truth)?;
        check::variance(&truth)?;
        check::exposure(options)?;
        let mut measures = Self { kind, test, truth, ssim: None, flip: None };
        if kind != Kind::Other {
            let (curve, exposure) = kind.display(options);
            let [t, r] = [test.picture, truth.picture].map(|picture| shown(picture, curve, exposure).0);
            measures.ssim = ssim::Map::new(&t, &r, pixels::colors(truth.picture));
            measures.flip = Some(flip::map(&t, &r)?);
        }
        Ok(measures)
    }

    /// By name; the mask has a value for each pixel. Errors are inputs `measure-mask`: one of another size, or
    /// without a pixel.
    pub fn errors(&self, mask: Option<&[bool]>) -> Result<BTreeMap<&'static str, f64>> {
        check::mask(mask, self.truth.picture)?;
        let (test, truth) = (self.test.picture, self.truth.picture);
        let mut errors = BTreeMap::new();
        errors.insert("rmse", pixels::squares(test, truth, mask).sqrt());
        errors.insert("smape", pixels::smape(test, truth, mask));
        let relative = pixels::relative_squares(test, truth, mask);
        if let Some(mut relative) = relative {
            let relmse = pixels::mean(relative.iter().copied());
            errors.insert("relmse", relmse);
            errors.insert("relmse_trimmed", pixels::trimmed_mean(&mut relative));
            if let Some(noise) = self.noise(mask) {
                errors.insert("relmse_above_noise", (relmse - noise).max(0.0));
            }
        }
        if self.kind != Kind::Other {
            errors.extend(pixels::bias(test, truth, mask).map(|bias| ("bias", bias)));
        }
        errors.extend(self.ssim.as_ref().and_then(|map| map.mean(mask)).map(|ssim| ("ssim", ssim)));
        if let Some(map) = &self.flip {
            errors.insert("flip", pixels::mean(pixels::within(mask, map.iter().map(|e| f64::from(*e)))));
        }
        Ok(errors)
    }

    fn noise(&self, mask: Option<&[bool]>) -> Option<f64> {
        pixels::relative_variance(self.truth.picture, self.truth.variance?, mask)
    }

    /// ꟻLIP of each pixel in the colours of its authors (magma, black alike); `None` for [`Kind::Other`].
    pub fn flip_map(&self) -> Option<Encoded> {
        let map = self.flip.as_ref()?;
        maps::encoded(self.truth.picture, map.iter().map(|error| maps::error_color(*error)))
    }

    /// Where the picture is too dark (blue) or too bright (red), and where alike (nearly white): for each pixel
    /// Σ(t−r) / Σ(|r| + 0.1 M) over its channels, from −1 (black where the reference has light) to 1 (about twice the
    /// reference), cut off beyond.
    pub fn difference_map(&self) -> Option<Encoded> {
        let differences = pixels::differences(self.test.picture, self.truth.picture);
        maps::encoded(self.truth.picture, differences.map(maps::signed_color))
    }
}

/// What the reference's own variance amounts to as relMSE: what a perfect picture is expected to have. Mean of
/// variance / (r² + 0.01 M²). `None` where it is not known: without variance, with one that is 0 in every pixel (a
/// single sample differs from no other), and where the reference is black everywhere.
///
/// Errors as those of [`Measures::new`] and [`Measures::errors`].
pub fn noise(truth: &Truth, mask: Option<&[bool]>) -> Result<Option<f64>> {
    check::finite(&[truth.input()])?;
    check::variance(truth)?;
    check::mask(mask, truth.picture)?;
    Ok(truth.variance.and_then(|variance| pixels::relative_variance(truth.picture, variance, mask)))
}

/// Whether a picture can't be told from a perfect one by this reference: `relmse` is no more than twice the reference's
/// `noise`.
///
/// With an unbiased reference the expected `relmse` is the picture's own plus `noise`. Up to twice the noise, what the
/// subtraction leaves to the picture is no more than what was subtracted: the picture is as near to the truth as the
/// reference itself. A second reference of as many samples is expected right at the limit.
pub fn within_noise(relmse: f64, noise: f64) -> bool {
    relmse <= 2.0 * noise
}

/// `relmse`, or the most that is [`within_noise`]: what is below can't be told apart.
pub fn above_noise(relmse: f64, noise: f64) -> f64 {
    relmse.max(2.0 * noise)
}

/// A refusal.
fn refuse(code: &'static str, message: String, help: &str) -> Problem {
    Problem::input(code, message).help(help)
}
