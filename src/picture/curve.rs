//! Tone curves: from unbounded linear values to those that a display can show.

use std::fmt;
use std::str::FromStr;

/// Maps each colour channel from 0..∞ to 0..1, rising, 0 to 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Curve {
    /// x, cut off at 1. Pictures compare with those of other renderers.
    #[default]
    Clip,
    /// x / (1 + x), Reinhard et al. 2002, equation 3.
    Reinhard,
    /// 1 − exp(−x), as film answers to light.
    Exponential,
}

impl Curve {
    pub const ALL: [Curve; 3] = [Curve::Clip, Curve::Reinhard, Curve::Exponential];

    pub fn name(self) -> &'static str {
        match self {
            Curve::Clip => "clip",
            Curve::Reinhard => "reinhard",
            Curve::Exponential => "exponential",
        }
    }

    /// `x` finite; negative values become 0.
    pub fn apply(self, x: f32) -> f32 {
        let x = x.max(0.0);
        match self {
            Curve::Clip => x.min(1.0),
            Curve::Reinhard => 1.0 - 1.0 / (1.0 + x),
            Curve::Exponential => -(-x).exp_m1(),
        }
    }
}

impl fmt::Display for Curve {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Curve {
    type Err = String;

    /// The error is a sentence with the names there are.
    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        let found = Self::ALL.into_iter().find(|curve| curve.name() == name);
        found.ok_or_else(|| format!("there is no tone curve `{name}`; there are: {}", names()))
    }
}
