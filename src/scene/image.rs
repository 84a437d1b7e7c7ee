//! Images of materials: RGBA8 texels with their mip levels, at their own size, all in one list.
//!
//! A texel is one word, red in the lowest byte. Levels follow one another, each half the one before, rounded down
//! but at least 1. A level is the area-weighted mean of the one before: in linear light where texels hold sRGB-coded
//! colour, alpha always linearly. Means are carried in floats from level to level and rounded once. A mean of normals is
//! the mean of the vectors, not made a unit vector again: the shorter it is, the more they differ.

use crate::picture::srgb;
use glam::{UVec4, Vec4};

/// Where an image lies in [`super::Scene::texels`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    pub name: String,
    /// Index of the first texel of level 0.
    pub offset: u32,
    pub width: u32,
    pub height: u32,
    pub levels: u32,
    /// Whether texels hold sRGB-coded colour.
    pub srgb: bool,
    /// Of each channel, as stored.
    pub least: [u8; 4],
    pub greatest: [u8; 4],
}

/// What a texture coordinate outside 0..1 means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    Repeat = 0,
    Clamp = 1,
    Mirror = 2,
}

/// How a material looks up an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Along u, along v.
    pub wrap: [Wrap; 2],
    /// Magnified without interpolation.
    pub nearest: bool,
    /// By the vertices' second set of texture coordinates.
    pub second_uv: bool,
    /// The material has a transform for the texture coordinates.
    pub transformed: bool,
}

/// Flags of an image reference.
pub const NEAREST: u32 = 1 << 4;
pub const SRGB: u32 = 1 << 5;
pub const SECOND_UV: u32 = 1 << 6;
pub const TRANSFORMED: u32 = 1 << 7;

impl Image {
    /// The image as a material refers to it: (offset, width, height, flags). Flags: bits 0–1 wrap along u, 2–3 along v (0
    /// repeat, 1 clamp, 2 mirror), bit 4 nearest, bit 5 sRGB-coded, bit 6 second set of texture coordinates, bit 7
    /// transformed ones, bits 8–15 number of levels.
    pub fn reference(&self, sampling: Sampling) -> UVec4 {
        let [u, v] = sampling.wrap.map(|wrap| wrap as u32);
        let flag = |set: bool, flag: u32| if set { flag } else { 0 };
        let flags = flag(sampling.nearest, NEAREST)
            | flag(self.srgb, SRGB)
            | flag(sampling.second_uv, SECOND_UV)
            | flag(sampling.transformed, TRANSFORMED);
        UVec4::new(self.offset, self.width, self.height, u | v << 2 | flags | self.levels << 8)
    }
}

/// Words that an image of this size takes with all its levels.
pub fn words(width: u32, height: u32) -> u64 {
    sizes(width, height).map(|(w, h)| u64::from(w) * u64::from(h)).sum()
}

fn sizes(width: u32, height: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..levels(width, height)).map(move |level| ((width >> level).max(1), (height >> level).max(1)))
}

/// How many levels an image of this size has.
pub fn levels(width: u32, height: u32) -> u32 {
    width.max(height).max(1).ilog2() + 1
}

/// Makes all levels from level 0, with which `texels` begins; it has [`words`] of them.
pub fn fill_levels(texels: &mut [u32], width: u32, height: u32, srgb: bool) {
    let decode = decoder(srgb);
    let mut sizes = sizes(width, height);
    let Some(mut size) = sizes.next() else { return };
    let (finest, mut rest) = texels.split_at_mut(size.0 as usize * size.1 as usize);
    let mut level: Vec<Vec4> = Vec::new();
    for (number, next) in sizes.enumerate() {
        level = if number == 0 {
            shrink(size, next, |i| {
                let [r, g, b, a] = finest[i].to_le_bytes();
                let [r, g, b] = [r, g, b].map(|c| decode[usize::from(c)]);
                Vec4::new(r, g, b, f32::from(a) / 255.0)
            })
        } else {
            shrink(size, next, |i| level[i])
        };
        let (coded, coarser) = std::mem::take(&mut rest).split_at_mut(level.len());
        coded.iter_mut().zip(&level).for_each(|(coded, texel)| *coded = encode(*texel, srgb));
        rest = coarser;
        size = next;
    }
}

fn decoder(srgb: bool) -> [f32; 256] {
    std::array::from_fn(|i| {
        let coded = i as f32 / 255.0;
        if srgb { srgb::decode(coded) } else { coded }
    })
}

fn encode(texel: Vec4, srgb: bool) -> u32 {
    let color = |c: f32| if srgb { srgb::encode8(c) } else { (c * 255.0).round() as u8 };
    let alpha = (texel.w * 255.0).round() as u8;
    u32::from_le_bytes([color(texel.x), color(texel.y), color(texel.z), alpha])
}

/// The area-weighted mean of `from` at the size `to`; `texel` gives the texels of `from`.
fn shrink(from: (u32, u32), to: (u32, u32), texel: impl Fn(usize) -> Vec4) -> Vec<Vec4> {
    let (columns, rows) = (taps(from.0, to.0), taps(from.1, to.1));
    let mut out = Vec::with_capacity(columns.len() * rows.len());
    for row in &rows {
        out.extend(columns.iter().map(|column| {
            let mut sum = Vec4::ZERO;
            for (y, wy) in row {
                for (x, wx) in column {
                    sum += texel(y * from.0 as usize + x) * (wx * wy);
                }
            }
            sum
        }));
    }
    out
}

/// For each of `to` intervals that divide a line of `from` unit intervals evenly: the units it overlaps, with the
/// part of it that each covers.
fn taps(from: u32, to: u32) -> Vec<Vec<(usize, f32)>> {
    let ratio = f64::from(from) / f64::from(to);
    (0..to)
        .map(|i| {
            let (start, end) = (f64::from(i) * ratio, f64::from(i + 1) * ratio);
            let units = start as usize..(end.ceil() as usize).min(from as usize);
            let overlap = |unit: usize| end.min((unit + 1) as f64) - start.max(unit as f64);
            units.map(|unit| (unit, (overlap(unit) / ratio) as f32)).filter(|(_, w)| *w > 0.0).collect()
        })
        .collect()
}
