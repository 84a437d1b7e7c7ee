//! PNG: 8 bits, sRGB.

use super::file::{unreadable, write_whole};
use super::{Curve, Encoded, Picture, srgb};
use crate::problem::Result;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageFormat, ImageReader};
use std::fs;
use std::io::Cursor;
use std::path::Path;

/// The colour of texels that are not finite: magenta, opaque.
pub const SIGNAL: [u8; 4] = [255, 0, 255, 255];

/// What a display shows of a linear picture: each colour channel times 2^`exposure`, through the curve, sRGB-coded,
/// rounded to nearest. One channel is grey, two are red and green, a fourth is alpha, which is clipped to 0..1 and not
/// curved. Texels with a channel that is not finite have the colour [`SIGNAL`].
///
/// Returns also how many texels are not finite.
pub fn shown(picture: &Picture, curve: Curve, exposure: f32) -> (Encoded, usize) {
    let scale = exposure.exp2();
    let color = |c: f32| srgb::encode8(curve.apply((c * scale).min(f32::MAX)));
    let mut signals = 0;
    let mut data = Vec::with_capacity(picture.texels().len() * 4);
    for texel in picture.texels() {
        if !texel.iter().all(|c| c.is_finite()) {
            signals += 1;
            data.extend(SIGNAL);
            continue;
        }
        data.extend(match *texel {
            [grey] => [color(grey), color(grey), color(grey), 255],
            [r, g] => [color(r), color(g), 0, 255],
            [r, g, b] => [color(r), color(g), color(b), 255],
            [r, g, b, alpha, ..] => {
                [color(r), color(g), color(b), (alpha.clamp(0.0, 1.0) * 255.0).round() as u8]
            }
            [] => SIGNAL,
        });
    }
    (Encoded { width: picture.width, height: picture.height, data }, signals)
}

/// Writes what [`shown`] makes of a linear picture. Returns how many texels are not finite.
pub fn write_png(path: &Path, picture: &Picture, curve: Curve, exposure: f32) -> Result<usize> {
    let (picture, signals) = shown(picture, curve, exposure);
    write_encoded(path, &picture)?;
    Ok(signals)
}

/// Writes a picture that is already display-referred, byte for byte.
pub fn write_encoded(path: &Path, picture: &Encoded) -> Result<()> {
    write(path, picture.width, picture.height, &picture.data)
}

/// Without the alpha channel where it is 255 everywhere.
fn write(path: &Path, width: u32, height: u32, rgba: &[u8]) -> Result<()> {
    let opaque = rgba.chunks_exact(4).all(|texel| texel[3] == 255);
    write_whole(path, |writer| {
        let encoder = PngEncoder::new(writer);
        if opaque {
            let rgb: Vec<u8> =
                rgba.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
            encoder.write_image(&rgb, width, height, ExtendedColorType::Rgb8)
        } else {
            encoder.write_image(rgba, width, height, ExtendedColorType::Rgba8)
        }
    })
}

/// Reads a PNG as it is, with an alpha of 255 where it has none.
pub fn read_png(path: &Path) -> Result<Encoded> {
    let bytes = fs::read(path).map_err(|error| unreadable(path, error))?;
    let reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
    let pixels = reader.decode().map_err(|error| unreadable(path, error))?.into_rgba8();
    let (width, height) = pixels.dimensions();
    let picture = Encoded::new(width, height, pixels.into_raw());
    picture.ok_or_else(|| unreadable(path, "it has no texels").into())
}
