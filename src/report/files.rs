//! Pictures of the folder, as data URIs.

use crate::comparison::Comparison;
use crate::picture::{Encoded, read_png};
use crate::problem::{Problem, Result};
use data_encoding::BASE64;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageFormat, ImageReader};
use std::fs;
use std::io::Cursor;
use std::path::{Component, Path, PathBuf};

/// The files of a comparison. What can't be used is a problem `report-picture`, which says whose picture it is.
pub struct Files<'a> {
    folder: &'a Path,
    size: [u32; 2],
}

impl<'a> Files<'a> {
    pub fn new(comparison: &Comparison, folder: &'a Path) -> Self {
        Self { folder, size: comparison.size }
    }

    /// The PNG at `path` as a data URI. `whose` names it in messages: "output `color` of run `a`".
    pub fn embed(&self, path: &str, whose: &str) -> Result<String> {
        let bytes = fs::read(self.inside(path, whose)?).map_err(|error| unusable(path, whose, error))?;
        let reader = ImageReader::with_format(Cursor::new(&bytes), ImageFormat::Png);
        let (width, height) = reader.into_dimensions().map_err(|error| unusable(path, whose, error))?;
        self.sized(width, height, path, whose)?;
        Ok(data_uri(&bytes))
    }

    /// The PNG at `path`, decoded.
    pub fn read(&self, path: &str, whose: &str) -> Result<Encoded> {
        let picture = read_png(&self.inside(path, whose)?)?;
        self.sized(picture.width(), picture.height(), path, whose)?;
        Ok(picture)
    }

    /// A page that is passed on must hold nothing of other folders.
    fn inside(&self, path: &str, whose: &str) -> Result<PathBuf> {
        let inner = Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
        if path.is_empty() || !inner {
            return Err(unusable(path, whose, "its path leads out of the folder").into());
        }
        Ok(self.folder.join(path))
    }

    fn sized(&self, width: u32, height: u32, path: &str, whose: &str) -> Result<()> {
        let [w, h] = self.size;
        if [width, height] == self.size {
            return Ok(());
        }
        let cause = format!("it has {width}×{height} pixels, and the comparison is of {w}×{h}");
        Err(unusable(path, whose, cause).into())
    }
}

fn unusable(path: &str, whose: &str, cause: impl std::fmt::Display) -> Problem {
    Problem::input("report-picture", format!("can't use `{path}`, the picture of {whose}: {cause}"))
        .help("keep the folder together as it was written, or make it again")
}

fn data_uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", BASE64.encode(png))
}

/// A part of `picture` as a data URI: `size` pixels from `corner` on, which must be inside.
pub fn crop(picture: &Encoded, corner: [u32; 2], size: [u32; 2]) -> Result<String> {
    let mut rgb = Vec::with_capacity(size[0] as usize * size[1] as usize * 3);
    let row = picture.width() as usize * 4;
    for line in picture.data().chunks_exact(row).skip(corner[1] as usize).take(size[1] as usize) {
        let texels = line.chunks_exact(4).skip(corner[0] as usize).take(size[0] as usize);
        rgb.extend(texels.flat_map(|texel| [texel[0], texel[1], texel[2]]));
    }
    let mut png = Vec::new();
    let written = PngEncoder::new(&mut png).write_image(&rgb, size[0], size[1], ExtendedColorType::Rgb8);
    written.map_err(|error| {
        Problem::failure("report-picture", format!("can't cut a part out of a picture: {error}"))
    })?;
    Ok(data_uri(&png))
}
