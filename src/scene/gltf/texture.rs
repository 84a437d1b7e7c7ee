//! Textures: an image with the sampler it is looked up by. Each image is decoded once, and only if asked for.

use super::file::File;
use super::notes::{Fault, Notes};
use crate::scene::image::{Image, Sampling, Wrap, append, words};
use glam::UVec4;
use gltf::json::texture::{MagFilter, Texture, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{self, Index};
use image::{ImageFormat, ImageReader, Limits};
use std::collections::HashMap;
use std::io::Cursor;

/// Longest side of an image in texels.
const MOST_SIDE: u32 = 16384;
/// Most memory that decoding one image may take.
const MOST_BYTES: u64 = 1 << 30;
/// Most texels of a scene with all mip levels: 1 GiB.
const MOST_TEXELS: u64 = 1 << 28;

#[derive(Default)]
pub struct Textures {
    pub texels: Vec<u32>,
    pub images: Vec<Image>,
    /// Place in `images` of the file's images that were asked for; `None` for those we can't read.
    decoded: HashMap<usize, Option<usize>>,
}

impl Textures {
    /// How a material refers to the texture `index`, whose image holds colour; `None` if it is left out.
    pub fn reference(
        &mut self,
        file: &mut File,
        index: Index<Texture>,
        notes: &mut Notes,
    ) -> Result<Option<UVec4>, Fault> {
        let root = &file.root;
        let texture = root
            .textures
            .get(index.value())
            .ok_or_else(|| Fault::beyond("texture", index.value(), root.textures.len()))?;
        let sampling = match texture.sampler {
            Some(sampler) => {
                let (index, count) = (sampler.value(), root.samplers.len());
                sampling(root.samplers.get(index).ok_or_else(|| Fault::beyond("sampler", index, count))?)?
            }
            None => Sampling { wrap: [Wrap::Repeat; 2], nearest: false },
        };
        let source = texture.source.value();
        // What the JSON types give for a texture without an image of a kind that core glTF has.
        if source == u32::MAX as usize {
            notes.lack("texture in a format of an extension", "left out");
            return Ok(None);
        }
        let place = match self.decoded.get(&source) {
            Some(place) => *place,
            None => {
                let place = self.decode(file, source, notes)?;
                self.decoded.insert(source, place);
                place
            }
        };
        Ok(place.and_then(|place| self.images.get(place)).map(|image| image.reference(sampling)))
    }

    fn decode(&mut self, file: &mut File, index: usize, notes: &mut Notes) -> Result<Option<usize>, Fault> {
        let count = file.root.images.len();
        let image = file.root.images.get(index).ok_or_else(|| Fault::beyond("image", index, count))?;
        let name = image.name.clone().unwrap_or_else(|| format!("image {index}"));
        let fetched;
        let data = match (image.buffer_view, image.uri.clone()) {
            (Some(view), _) => file.whole(view)?,
            (None, Some(uri)) => {
                fetched = file.fetch(&uri)?;
                &fetched
            }
            (None, None) => {
                let message = format!("image {index} has neither a buffer view nor a URI");
                return Err(Fault::new("gltf-image", message));
            }
        };
        let fault = |error: &dyn std::fmt::Display| {
            Fault::new("gltf-image", format!("can't decode image {index}: {error}"))
        };
        let format = image::guess_format(data).map_err(|error| fault(&error))?;
        if !matches!(format, ImageFormat::Png | ImageFormat::Jpeg) {
            notes.lack(&format!("{format:?} image"), "left out");
            return Ok(None);
        }
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(MOST_SIDE), Some(MOST_SIDE));
        limits.max_alloc = Some(MOST_BYTES);
        let mut reader = ImageReader::with_format(Cursor::new(data), format);
        reader.limits(limits);
        let pixels = reader.decode().map_err(|error| fault(&error))?.into_rgba8();
        let (width, height) = pixels.dimensions();
        let offset = self.texels.len() as u64;
        if offset + words(width, height) > MOST_TEXELS {
            let message = format!("with image {index} the scene has more than {MOST_TEXELS} texels");
            return Err(Fault::new("gltf-size", message));
        }
        let levels = append(&mut self.texels, pixels.as_raw(), width, height, true);
        self.images.push(Image { name, offset: offset as u32, width, height, levels, srgb: true });
        Ok(Some(self.images.len() - 1))
    }
}

fn sampling(sampler: &json::texture::Sampler) -> Result<Sampling, Fault> {
    let wrap = |mode| {
        Ok(match mode {
            Checked::Valid(WrappingMode::Repeat) => Wrap::Repeat,
            Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
            Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
            Checked::Invalid => return Err(Fault::new("gltf-value", "the sampler has an unknown wrap mode")),
        })
    };
    Ok(Sampling {
        wrap: [wrap(sampler.wrap_s)?, wrap(sampler.wrap_t)?],
        nearest: sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest)),
    })
}
