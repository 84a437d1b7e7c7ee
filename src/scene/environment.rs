//! Environments: light that comes from infinitely far away, by direction.
//!
//! An environment is a picture of all directions: column u of [0, 1) is the direction `turn + (u − ½) · 360°` about the
//! vertical axis, 0° along −z and growing towards +x; row v of [0, 1) is v · 180° down from +y. Texels are radiances,
//! W/(sr·m²), in linear Rec. 709. A constant environment is one texel.

use glam::{Vec3, Vec4};
use image::{ImageReader, Limits};
use std::f32::consts::PI;
use std::path::Path;

/// Widest picture in texels: 8192 × 4096 with its mip levels take 683 MiB.
const MOST_WIDTH: u32 = 8192;
/// Brightest radiance, W/(sr·m²): sums over all texels stay finite.
const BRIGHTEST: f32 = 1e18;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Environment {
    pub width: u32,
    pub height: u32,
    pub levels: u32,
    /// The picture, then its mip levels, each half the one before, rounded down but at least 1; a level is the mean of
    /// the one before over solid angle. Then what directions are chosen by, in proportion to luminance: the fourth
    /// component of the picture's texels is the probability of this column or one before, given the row, and at the end
    /// each row has an element whose first component is the probability of this row or one above.
    pub texels: Vec<Vec4>,
    /// Radians by which the picture is turned about the vertical axis, from −z towards +x.
    pub turn: f32,
}

impl Environment {
    /// The same radiance from everywhere.
    ///
    /// Errors: a sentence, if it is negative or not finite.
    pub fn constant(radiance: Vec3) -> Result<Self, String> {
        Self::of(1, 1, vec![radiance.extend(0.0)])
    }

    /// A picture (`.hdr`, `.exr`), all of whose texels are multiplied by `strength`.
    ///
    /// Errors: a sentence that says what is wrong with the file.
    pub fn read(path: &Path, strength: f32) -> Result<Self, String> {
        let mut reader = ImageReader::open(path).map_err(|error| format!("it can't be read: {error}"))?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(MOST_WIDTH), Some(MOST_WIDTH / 2));
        limits.max_alloc = Some(1 << 30);
        reader.limits(limits);
        let reader = reader.with_guessed_format().map_err(|error| format!("it can't be read: {error}"))?;
        if !matches!(reader.format(), Some(image::ImageFormat::Hdr | image::ImageFormat::OpenExr)) {
            return Err("it is neither a Radiance (.hdr) nor an OpenEXR picture".to_owned());
        }
        let pixels = reader.decode().map_err(|error| format!("it can't be decoded: {error}"))?.into_rgb32f();
        let (width, height) = pixels.dimensions();
        let count = levels(width, height).map(|(w, h)| w as usize * h as usize).sum();
        let mut texels = Vec::with_capacity(count);
        texels.extend(pixels.pixels().map(|p| (Vec3::from(p.0) * strength).extend(0.0)));
        drop(pixels);
        Self::of(width, height, texels)
    }

    fn of(width: u32, height: u32, texels: Vec<Vec4>) -> Result<Self, String> {
        if width == 0 || height == 0 {
            return Err(format!("it has no texels: {width} × {height}"));
        }
        let wrong = |t: &Vec4| !(t.is_finite() && t.min_element() >= 0.0 && t.max_element() <= BRIGHTEST);
        if let Some(index) = texels.iter().position(wrong) {
            let (x, y) = (index as u32 % width, index as u32 / width);
            return Err(format!("the radiance at column {x}, row {y} is negative, or beyond {BRIGHTEST:e}"));
        }
        let mut made = Self { width, height, levels: 1, texels, turn: 0.0 };
        made.add_levels();
        made.add_probabilities();
        Ok(made)
    }

    fn add_levels(&mut self) {
        let mut start = 0;
        let sizes: Vec<_> = levels(self.width, self.height).collect();
        for pair in sizes.windows(2) {
            let level = shrink(&self.texels[start..], pair[0], pair[1]);
            start = self.texels.len();
            self.texels.extend(level);
        }
        self.levels = sizes.len() as u32;
    }

    fn add_probabilities(&mut self) {
        let (width, height) = (self.width as usize, self.height as usize);
        let luminances = self.bilinear_luminances();
        let angle = |row: usize| (row as f64 / height as f64 * std::f64::consts::PI).cos();
        let mut rows = Vec::with_capacity(height);
        for (y, row) in self.texels[..width * height].chunks_exact_mut(width).enumerate() {
            let sums = running(luminances[y * width..][..width].iter().copied());
            let total = sums.last().copied().unwrap_or(0.0);
            for (x, (texel, sum)) in row.iter_mut().zip(&sums).enumerate() {
                // A black row is never chosen.
                texel.w = if total > 0.0 { sum / total } else { (x + 1) as f64 / width as f64 } as f32;
            }
            rows.push(total * (angle(y) - angle(y + 1)));
        }
        let sums = running(rows.into_iter());
        let total = sums.last().copied().unwrap_or(0.0);
        let probability = |(y, sum)| if total > 0.0 { sum / total } else { (y + 1) as f64 / height as f64 };
        self.texels.extend(
            sums.into_iter().enumerate().map(|row| Vec4::new(probability(row) as f32, 0.0, 0.0, 0.0)),
        );
    }

    /// Mean luminance over each texel of the first level, as it is looked up: bilinearly, so that a texel has an eighth
    /// of each neighbour's along either axis.
    fn bilinear_luminances(&self) -> Vec<f64> {
        let (width, height) = (self.width as usize, self.height as usize);
        let luminance = |texel: &Vec4| f64::from(texel.truncate().dot(Vec3::new(0.2126, 0.7152, 0.0722)));
        let own: Vec<f64> = self.texels[..width * height].iter().map(luminance).collect();
        let spread = |from: &[f64], before: &dyn Fn(usize) -> usize, after: &dyn Fn(usize) -> usize| {
            let mean = |at| 0.75 * from[at] + 0.125 * (from[before(at)] + from[after(at)]);
            (0..from.len()).map(mean).collect::<Vec<f64>>()
        };
        let along = |at: usize, by: usize| at / width * width + (at + by) % width;
        let rows = spread(&own, &|at| along(at, width - 1), &|at| along(at, 1));
        let last = width * (height - 1);
        spread(&rows, &|at| if at < width { at } else { at - width }, &|at| {
            if at < last { at + width } else { at }
        })
    }

    /// Index of the element of the first row.
    pub fn first_row(&self) -> usize {
        self.texels.len() - self.height as usize
    }

    /// Mean radiance over all directions.
    pub fn mean(&self) -> Vec3 {
        self.texels[self.first_row() - 1].truncate()
    }
}

fn running(numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    numbers
        .scan(0.0, |sum, number| {
            *sum += number;
            Some(*sum)
        })
        .collect()
}

/// The sizes of all levels.
fn levels(width: u32, height: u32) -> impl Iterator<Item = (u32, u32)> {
    std::iter::successors(Some((width, height)), |(w, h)| {
        (*w > 1 || *h > 1).then(|| ((w / 2).max(1), (h / 2).max(1)))
    })
}

/// The mean of `from` over the solid angle of each texel of the size `to`.
fn shrink(from: &[Vec4], size: (u32, u32), to: (u32, u32)) -> Vec<Vec4> {
    let columns = overlaps(size.0, to.0, |begin, end| end - begin);
    let angle = |at: f32| (at / size.1 as f32 * PI).cos();
    let rows = overlaps(size.1, to.1, |begin, end| angle(begin) - angle(end));
    let mut out = Vec::with_capacity(columns.len() * rows.len());
    for row in &rows {
        out.extend(columns.iter().map(|column| {
            let (mut sum, mut weights) = (Vec4::ZERO, 0.0);
            for (y, height) in row {
                for (x, width) in column {
                    sum += from[y * size.0 as usize + x] * (height * width);
                    weights += height * width;
                }
            }
            sum / weights
        }));
    }
    out
}

/// For each of `to` even pieces of a line of `from` units: the units it overlaps, each with what `measure` makes of
/// where the overlap begins and ends.
fn overlaps(from: u32, to: u32, measure: impl Fn(f32, f32) -> f32) -> Vec<Vec<(usize, f32)>> {
    let ratio = from as f32 / to as f32;
    let piece = |i: u32| {
        let (begin, end) = (i as f32 * ratio, (i + 1) as f32 * ratio);
        let units = begin as usize..(end.ceil() as usize).min(from as usize);
        let part = |unit: usize| (begin.max(unit as f32), end.min((unit + 1) as f32));
        let parts = units.map(|unit| (unit, part(unit))).filter(|(_, (begin, end))| begin < end);
        parts.map(|(unit, (begin, end))| (unit, measure(begin, end))).collect()
    };
    (0..to).map(piece).collect()
}
