//! Textures: an image with the sampler it is looked up by.
//!
//! An image is decoded once, and only if a material in use asks for it; one that is asked for both as colour and as
//! data is stored twice. Where it will lie is settled by its header, so that nothing is decoded that can't be held, and each
//! image is decoded to its place: in parallel, and with the same result however many threads there are.

use super::file::File;
use super::notes::{Fault, Notes};
use super::picture::{Header, decode};
use crate::scene::image::{Image, Sampling, Wrap, fill_levels, levels, words};
use gltf::json::texture::{MagFilter, Texture, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{self, Index};
use rayon::prelude::*;
use std::collections::HashMap;

/// Most texels of a scene with all mip levels: 1 GiB.
const MOST_TEXELS: u64 = 1 << 28;
/// Texels of the images that are decoded at a time, unless one alone has more.
const MOST_AT_ONCE: u64 = 1 << 24;
/// Bytes that decoding takes at most for each.
const DECODING: u64 = 16;

/// What the texels of an image are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Coding {
    Srgb,
    Linear,
}

/// An image of the file that was asked for.
struct Source {
    header: Header,
    /// Where it was asked for first.
    pointer: String,
    /// In [`Textures::images`].
    places: Vec<usize>,
}

#[derive(Default)]
pub struct Textures {
    pub images: Vec<Image>,
    sources: Vec<Source>,
    /// The file's images that were asked for, in `sources`; `None` for those we can't read.
    asked: HashMap<usize, Option<usize>>,
}

impl Textures {
    /// The image of the texture `index`, as a place in `images`, and how it is looked up; `None` if it is left out.
    pub fn request(
        &mut self,
        file: &mut File,
        index: Index<Texture>,
        coding: Coding,
        pointer: &str,
        notes: &mut Notes,
    ) -> Result<Option<(usize, Sampling)>, Fault> {
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
            None => SAMPLING,
        };
        let number = texture.source.value();
        // What the JSON types give for a texture without an image of a kind that core glTF has.
        if number == u32::MAX as usize {
            notes.lack("texture in a format of an extension", "left out");
            return Ok(None);
        }
        let source = match self.asked.get(&number) {
            Some(source) => *source,
            None => {
                let header = Header::read(file, number, notes)?;
                let source = header.map(|header| {
                    self.sources.push(Source { header, pointer: pointer.to_owned(), places: Vec::new() });
                    self.sources.len() - 1
                });
                self.asked.insert(number, source);
                source
            }
        };
        source.map(|source| Ok((self.place(file, source, coding)?, sampling))).transpose()
    }

    /// Where the source lies in `images`, as the given coding.
    fn place(&mut self, file: &File, source: usize, coding: Coding) -> Result<usize, Fault> {
        let source = &mut self.sources[source];
        let srgb = coding == Coding::Srgb;
        if let Some(place) = source.places.iter().find(|place| self.images[**place].srgb == srgb) {
            return Ok(*place);
        }
        let Header { name, width, height, .. } = &source.header;
        let offset = self.images.last().map_or(0, end);
        if offset + words(*width, *height) > MOST_TEXELS {
            let message = format!("with image {name:?} the scene has more than {MOST_TEXELS} texels");
            return Err(Fault::new("gltf-size", message));
        }
        file.budget.hold(4 * words(*width, *height))?;
        source.places.push(self.images.len());
        self.images.push(Image {
            name: name.clone(),
            offset: offset as u32,
            width: *width,
            height: *height,
            levels: levels(*width, *height),
            srgb,
            least: [255; 4],
            greatest: [0; 4],
        });
        Ok(self.images.len() - 1)
    }

    /// Decodes what was asked for: the images, and all their texels.
    pub fn decode(mut self, file: &File, notes: &mut Notes) -> (Vec<Image>, Vec<u32>) {
        let sizes = || self.sources.iter().map(|s| u64::from(s.header.width) * u64::from(s.header.height));
        let at_once = sizes().max().unwrap_or(0).max(sizes().sum::<u64>().min(MOST_AT_ONCE));
        if let Err(fault) = file.budget.pass(at_once * DECODING) {
            notes.fault("/images", fault);
            return Default::default();
        }
        let mut texels = vec![0; self.images.last().map_or(0, end) as usize];
        let mut rest = texels.as_mut_slice();
        let mut targets = Vec::with_capacity(self.images.len());
        for image in &mut self.images {
            let (own, others) =
                std::mem::take(&mut rest).split_at_mut(words(image.width, image.height) as usize);
            targets.push(Some(Target { image, texels: own }));
            rest = others;
        }
        let mut jobs = Vec::with_capacity(self.sources.len());
        for source in self.sources {
            let own: Vec<Target> = source.places.iter().filter_map(|place| targets[*place].take()).collect();
            jobs.push((source.header, source.pointer, own));
        }
        let mut jobs = jobs.as_mut_slice();
        while !jobs.is_empty() {
            let mut total = 0;
            let several = jobs.iter().take_while(|(header, ..)| {
                total += u64::from(header.width) * u64::from(header.height);
                total <= MOST_AT_ONCE
            });
            let count = several.count().max(1);
            let (now, later) = std::mem::take(&mut jobs).split_at_mut(count);
            let results: Vec<_> =
                now.par_iter_mut().map(|(header, _, targets)| load(file, header, targets)).collect();
            for ((_, pointer, _), result) in now.iter().zip(results) {
                notes.catch(pointer, result);
            }
            jobs = later;
        }
        (self.images, texels)
    }
}

const SAMPLING: Sampling =
    Sampling { wrap: [Wrap::Repeat; 2], nearest: false, second_uv: false, transformed: false };

/// Index of the texel after the image's last.
fn end(image: &Image) -> u64 {
    u64::from(image.offset) + words(image.width, image.height)
}

/// An image, and its own part of the scene's texels.
struct Target<'a> {
    image: &'a mut Image,
    texels: &'a mut [u32],
}

fn load(file: &File, header: &Header, targets: &mut [Target]) -> Result<(), Fault> {
    let (width, height) = (header.width, header.height);
    let finest = width as usize * height as usize;
    let Some((first, others)) = targets.split_first_mut() else { return Ok(()) };
    decode(file, header, &mut first.texels[..finest])?;
    for other in others.iter_mut() {
        other.texels[..finest].copy_from_slice(&first.texels[..finest]);
    }
    for Target { image, texels } in std::iter::once(first).chain(others) {
        (image.least, image.greatest) = range(&texels[..finest]);
        fill_levels(texels, width, height, image.srgb);
    }
    Ok(())
}

/// Least and greatest value of each channel.
fn range(texels: &[u32]) -> ([u8; 4], [u8; 4]) {
    texels.iter().fold(([255; 4], [0; 4]), |(least, greatest), texel| {
        let texel = texel.to_le_bytes();
        let channels = [0, 1, 2, 3];
        (channels.map(|c: usize| texel[c].min(least[c])), channels.map(|c| texel[c].max(greatest[c])))
    })
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
        ..SAMPLING
    })
}
