//! Outputs and dumps of a run, as files.

use crate::device::Gpu;
use crate::frame::{Frame, Image};
use crate::graph::Graph;
use crate::picture::{self, Curve, Encoded, Picture};
use crate::plan::Reference;
use crate::problem::{Problem, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// One thing to write.
pub struct Target {
    name: String,
    reference: Reference,
    path: PathBuf,
}

impl Target {
    /// What `--output`, `--dump` and `--out` ask for. `scene` and the pipeline's name give the default file's name.
    pub fn parse(
        graph: &Graph,
        scene: &Path,
        outputs: &[String],
        dumps: &[String],
        folder: Option<&Path>,
    ) -> Result<Vec<Self>> {
        let mut targets = Vec::new();
        let named = |name: &str| graph.plan.outputs.iter().find(|(n, _, _)| n == name).map(|(_, r, _)| *r);
        let all: Vec<&str> = graph.plan.outputs.iter().map(|(n, _, _)| n.as_str()).collect();
        for wanted in outputs {
            let (name, path) = split(wanted, "png");
            let reference = named(name).ok_or_else(|| {
                Problem::input("unknown-output", format!("the pipeline has no output `{name}`"))
                    .suggest(name, all.iter().copied())
            })?;
            targets.push(Self { name: name.to_owned(), reference, path });
        }
        for wanted in dumps {
            let (name, path) = split(wanted, "exr");
            let reference = graph.plan.resource(name)?;
            targets.push(Self { name: name.to_owned(), reference, path });
        }
        let there = |p: &Path| p.as_os_str().is_empty() || p.is_dir() || folder == Some(p);
        if let Some(target) = targets.iter().find(|t| !t.path.parent().is_some_and(there)) {
            let message = format!("`{}` would be in a folder that does not exist", target.path.display());
            let help = "make the folder first; only that of `--out` is made";
            return Err(Problem::input("no-folder", message).help(help).into());
        }
        if let Some(folder) = folder {
            for (name, reference, _) in &graph.plan.outputs {
                let extensions: &[&str] = if name == DISPLAY { &["png"] } else { &["png", "exr"] };
                for extension in extensions {
                    let path = folder.join(format!("{name}.{extension}"));
                    targets.push(Self { name: name.clone(), reference: *reference, path });
                }
            }
        }
        if targets.is_empty() {
            let (name, reference) = [DISPLAY, "color"]
                .into_iter()
                .find_map(|name| Some((name, named(name)?)))
                .or(graph.plan.outputs.first().map(|(n, r, _)| (n.as_str(), *r)))
                .ok_or_else(|| Problem::input("no-output", "the pipeline has no outputs"))?;
            let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let path = format!("{}-{}.png", stem(scene), stem(Path::new(&graph.plan.name)));
            targets.push(Self { name: name.to_owned(), reference, path: path.into() });
        }
        match targets.iter().find(|t| !matches!(extension(&t.path).as_str(), "png" | "exr")) {
            Some(target) => Err(Problem::input(
                "file-kind",
                format!("`{}` is neither .png nor .exr", target.path.display()),
            )
            .help("pictures are written as PNG (sRGB, 8 bit) or EXR (linear, float)")
            .into()),
            None => Ok(targets),
        }
    }
}

/// The output that is already fit for a display: sRGB-coded.
const DISPLAY: &str = "display";

fn split<'a>(wanted: &'a str, extension: &str) -> (&'a str, PathBuf) {
    match wanted.split_once('=') {
        Some((name, path)) => (name, path.into()),
        None => (wanted, format!("{wanted}.{extension}").into()),
    }
}

fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

pub struct Writer<'a> {
    pub gpu: &'a Gpu,
    pub frame: &'a Frame,
    pub curve: Curve,
    pub exposure: f32,
}

impl Writer<'_> {
    /// Writes all targets; the files by output name (a second file of one output has its extension in the name).
    pub fn write(&self, targets: &[Target]) -> Result<BTreeMap<String, String>> {
        let mut written = BTreeMap::new();
        for target in targets {
            let image = self.frame.read(self.gpu, &target.reference)?;
            let extension = extension(&target.path);
            if extension == "exr" {
                let picture = picture(&image)?;
                picture::write_exr(&target.path, &[(&target.name, &picture)])?;
            } else if target.name == DISPLAY && !image.float && image.channels == 4 {
                let encoded = Encoded::new(image.width, image.height, image.bytes).ok_or_else(too_large)?;
                picture::write_encoded(&target.path, &encoded)?;
            } else {
                let picture = picture(&visible(&target.name, image))?;
                picture::write_png(&target.path, &picture, self.curve, self.exposure)?;
            }
            let path = target.path.display().to_string();
            if written.contains_key(&target.name) {
                written.insert(format!("{}.{extension}", target.name), path);
            } else {
                written.insert(target.name.clone(), path);
            }
        }
        Ok(written)
    }
}

/// What a PNG can show of numbers that are no light: directions as ½ + ½ n.
fn visible(output: &str, mut image: Image) -> Image {
    if output == "normal" {
        image.data.iter_mut().for_each(|x| *x = 0.5 + 0.5 * *x);
    }
    image
}

fn too_large() -> Problem {
    Problem::failure("picture", "the picture is too large for a file")
}

/// Slices of a volume are laid side by side in a grid as square as can be.
fn picture(image: &Image) -> Result<Picture> {
    let columns = (f64::from(image.depth).sqrt().ceil() as u32).max(1);
    let rows = image.depth.div_ceil(columns);
    if image.depth == 1 {
        let picture = Picture::new(image.width, image.height, image.channels as u32, image.data.clone());
        return Ok(picture.ok_or_else(too_large)?);
    }
    let (width, height, channels) = (image.width * columns, image.height * rows, image.channels);
    let mut data = vec![0.0; width as usize * height as usize * channels];
    let row = image.width as usize * channels;
    for (i, line) in image.data.chunks_exact(row).enumerate() {
        let (slice, y) = (i as u32 / image.height, i as u32 % image.height);
        let (x0, y0) = ((slice % columns) * image.width, (slice / columns) * image.height);
        let at = ((y0 + y) as usize * width as usize + x0 as usize) * channels;
        data[at..at + row].copy_from_slice(line);
    }
    Ok(Picture::new(width, height, channels as u32, data).ok_or_else(too_large)?)
}
