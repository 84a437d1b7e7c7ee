//! How the camera moves.

use crate::problem::Result;
use crate::profile::path::{CameraPath, orbit};
use crate::scene::{Bounds, Camera};
use clap::Args;
use std::fmt;
use std::path::PathBuf;

#[derive(Args)]
#[group(multiple = false)]
pub struct CameraArgs {
    /// Move the camera along the keys of this RON file.
    #[arg(long, value_name = "FILE")]
    path: Option<PathBuf>,
    /// Move the camera around the middle of the scene, by so many degrees in all.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = degrees)]
    orbit: Option<f64>,
}

fn degrees(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok();
    number.filter(|n| n.is_finite()).ok_or_else(|| format!("`{text}` is no number of degrees"))
}

/// A way that was asked for.
pub enum Path {
    Keys(PathBuf, CameraPath),
    Orbit(f64),
}

impl CameraArgs {
    pub fn read(&self) -> Result<Option<Path>> {
        Ok(match (&self.path, self.orbit) {
            (Some(file), _) => Some(Path::Keys(file.clone(), CameraPath::read(file)?)),
            (None, degrees) => degrees.map(Path::Orbit),
        })
    }
}

impl Path {
    /// How many frames it has by itself.
    pub fn frames(&self) -> Option<u32> {
        match self {
            Path::Keys(_, path) => path.frames(),
            Path::Orbit(_) => None,
        }
    }

    pub fn cameras(&self, base: &Camera, bounds: &Bounds, frames: u32) -> Result<Vec<Camera>> {
        match self {
            Path::Keys(_, path) => Ok(path.cameras(base, frames)?),
            Path::Orbit(degrees) => Ok(orbit(base, bounds, *degrees, frames)),
        }
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Path::Keys(file, _) => write!(f, "along {}", file.display()),
            Path::Orbit(degrees) => write!(f, "by {degrees}° around the scene"),
        }
    }
}
