//! Pictures in memory and on disk.
//!
//! A [`Picture`] is linear: scene values, unbounded, in 32-bit floats. It is kept without loss as OpenEXR
//! ([`write_exr`]), and shown ([`shown`]; as PNG, [`write_png`]) through an exposure, a tone [`Curve`] and the sRGB
//! transfer function. An [`Encoded`] picture is already what a display shows, and is written as it is. Row 0 is on top.
//!
//! Every write goes to a temporary file in the target's folder that takes the target's name when it is whole, so a file is
//! there whole or not at all. Errors are failures `picture-write` and `picture-read` with the path and the cause.

mod curve;
mod exr_file;
mod file;
mod png_file;
pub mod srgb;
#[cfg(test)]
mod tests;

pub use curve::Curve;
pub use exr_file::{read_exr, write_exr};
pub use file::write_bytes;
pub use png_file::{SIGNAL, read_png, shown, write_encoded, write_png};

/// A linear picture of 1 to 4 channels: `data[(y * width + x) * channels + c]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: u32,
    height: u32,
    channels: u32,
    data: Vec<f32>,
}

impl Picture {
    /// `None` if a side is 0, there are not 1 to 4 channels, or `data` has another length than these give.
    pub fn new(width: u32, height: u32, channels: u32, data: Vec<f32>) -> Option<Self> {
        let length = texels(width, height)?.checked_mul(channels as usize)?;
        let fits = (1..=4).contains(&channels) && length == data.len();
        fits.then_some(Self { width, height, channels, data })
    }

    pub fn width(&self) -> u32 {
        self.width
    }

    pub fn height(&self) -> u32 {
        self.height
    }

    pub fn channels(&self) -> u32 {
        self.channels
    }

    pub fn data(&self) -> &[f32] {
        &self.data
    }

    /// The channels of one texel; `None` outside.
    pub fn texel(&self, x: u32, y: u32) -> Option<&[f32]> {
        let inside = x < self.width && y < self.height;
        inside.then(|| self.texels().nth(y as usize * self.width as usize + x as usize)).flatten()
    }

    /// Row by row from the top.
    pub fn texels(&self) -> std::slice::ChunksExact<'_, f32> {
        self.data.chunks_exact(self.channels as usize)
    }
}

/// A picture as a display shows it: RGBA8, `data[(y * width + x) * 4 + c]`, not multiplied by alpha.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Encoded {
    width: u32,
    height: u32,
    data: Vec<u8>,
}

impl Encoded {
    /// `None` if a side is 0 or `data` has another length than 4 bytes a texel.
    pub fn new(width: u32, height: u32, data: Vec<u8>) -> Option<Self> {
        let length = texels(width, height)?.checked_mul(4)?;
        (length == data.len()).then_some(Self { width, height, data })
    }

    pub fn width(&self) -> u32 {
        self.width
    }

    pub fn height(&self) -> u32 {
        self.height
    }

    pub fn data(&self) -> &[u8] {
        &self.data
    }
}

fn texels(width: u32, height: u32) -> Option<usize> {
    (width as usize).checked_mul(height as usize).filter(|count| *count > 0)
}
