//! Pictures in files: PNG and JPEG, decoded to RGBA8.

use super::file::File;
use super::notes::{Fault, Notes};
use gltf::json::{Index, buffer};
use image::{DynamicImage, ImageFormat, ImageReader, Limits};
use std::io::Cursor;

/// Longest side of an image in texels.
const MOST_SIDE: u32 = 16384;
/// Most memory that decoding one image may take.
const MOST_BYTES: u64 = 1 << 30;

/// What an image says of itself before it is decoded.
pub struct Header {
    pub name: String,
    pub width: u32,
    pub height: u32,
    number: usize,
    content: Content,
    format: ImageFormat,
}

enum Content {
    View(Index<buffer::View>),
    Fetched(Vec<u8>),
}

impl Content {
    fn bytes<'a>(&'a self, file: &'a File) -> Result<&'a [u8], Fault> {
        match self {
            Content::View(view) => file.whole(*view),
            Content::Fetched(bytes) => Ok(bytes),
        }
    }
}

impl Header {
    /// Of image `number` of the file; `None` if it is of a format that is left out.
    pub fn read(file: &mut File, number: usize, notes: &mut Notes) -> Result<Option<Self>, Fault> {
        let count = file.root.images.len();
        let image = file.root.images.get(number).ok_or_else(|| Fault::beyond("image", number, count))?;
        let name = image.name.clone().unwrap_or_else(|| format!("image {number}"));
        let content = match (image.buffer_view, image.uri.clone()) {
            (Some(view), _) => Content::View(view),
            (None, Some(uri)) => Content::Fetched(file.fetch(&uri)?),
            (None, None) => {
                let message = format!("image {number} has neither a buffer view nor a URI");
                return Err(Fault::new("gltf-image", message));
            }
        };
        let data = content.bytes(file)?;
        let format = image::guess_format(data).map_err(|error| fault(number, &error))?;
        if !matches!(format, ImageFormat::Png | ImageFormat::Jpeg) {
            notes.lack(&format!("{format:?} image"), "left out");
            return Ok(None);
        }
        let size = reader(data, format).into_dimensions();
        let (width, height) = size.map_err(|error| fault(number, &error))?;
        if width.max(height) > MOST_SIDE || width.min(height) == 0 {
            let message = format!("its sides are {width} and {height} texels, not 1 to {MOST_SIDE}");
            return Err(fault(number, &message));
        }
        Ok(Some(Self { name, width, height, number, content, format }))
    }
}

fn fault(number: usize, error: &dyn std::fmt::Display) -> Fault {
    Fault::new("gltf-image", format!("can't decode image {number}: {error}"))
}

fn reader(data: &[u8], format: ImageFormat) -> ImageReader<Cursor<&[u8]>> {
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MOST_SIDE), Some(MOST_SIDE));
    limits.max_alloc = Some(MOST_BYTES);
    let mut reader = ImageReader::with_format(Cursor::new(data), format);
    reader.limits(limits);
    reader
}

/// Decodes an image into its texels, row by row, red in the lowest byte.
pub fn decode(file: &File, header: &Header, texels: &mut [u32]) -> Result<(), Fault> {
    let data = header.content.bytes(file)?;
    let picture = reader(data, header.format).decode().map_err(|error| fault(header.number, &error))?;
    if (picture.width(), picture.height()) != (header.width, header.height) {
        return Err(fault(header.number, &"its size is not what its header says"));
    }
    let word = |[r, g, b, a]: [u8; 4]| u32::from_le_bytes([r, g, b, a]);
    // The most common kind needs no copy.
    match picture {
        DynamicImage::ImageRgb8(picture) => {
            for (texel, pixel) in texels.iter_mut().zip(picture.pixels()) {
                let [r, g, b] = pixel.0;
                *texel = word([r, g, b, 255]);
            }
        }
        other => {
            for (texel, pixel) in texels.iter_mut().zip(other.into_rgba8().pixels()) {
                *texel = word(pixel.0);
            }
        }
    }
    Ok(())
}
