//! OpenEXR: 32-bit linear floats with the chromaticities of Rec. 709.
//!
//! Each picture is a layer (in EXR's words a part) with its name; its channels are Y, or R G, R G B, R G B A.

use super::Picture;
use super::file::{unreadable, write_whole};
use crate::problem::{Problem, Result};
use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, ReadChannels, ReadLayers, Text, Vec2, WritableImage,
};
use std::path::Path;

/// Rec. ITU-R BT.709: primaries and D65.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Channel names by number of channels.
const NAMES: [&[&str]; 4] = [&["Y"], &["R", "G"], &["R", "G", "B"], &["R", "G", "B", "A"]];

/// Writes named layers of one size. Error: layers of different sizes, none at all, or a failed write.
pub fn write_exr(path: &Path, layers: &[(&str, &Picture)]) -> Result<()> {
    let refuse =
        |why: &str| Problem::failure("picture-write", format!("can't write `{}`: {why}", path.display()));
    let [(_, first), ..] = layers else { return Err(refuse("there is no picture to write").into()) };
    if layers.iter().any(|(_, p)| (p.width, p.height) != (first.width, first.height)) {
        return Err(refuse("its pictures differ in size").into());
    }
    let size = (first.width as usize, first.height as usize);
    let mut attributes = ImageAttributes::new(IntegerBounds::from_dimensions(size));
    attributes.chromaticities = Some(REC_709);
    let layers = layers.iter().map(|(name, picture)| {
        let name = Text::new_or_none(name).ok_or_else(|| refuse(&format!("{name:?} can't name a layer")))?;
        Ok(Layer::new(size, LayerAttributes::named(name), Encoding::SMALL_LOSSLESS, channels(picture)))
    });
    let layers = layers.collect::<Result<Vec<_>, Problem>>()?;
    let image = Image::from_layers(attributes, layers);
    write_whole(path, |writer| image.write().non_parallel().to_buffered(writer))
}

fn channels(picture: &Picture) -> AnyChannels<FlatSamples> {
    let names = NAMES[picture.channels as usize - 1];
    let list = names.iter().enumerate().map(|(c, name)| {
        let samples = picture.texels().map(|texel| texel[c]).collect();
        AnyChannel::new(*name, FlatSamples::F32(samples))
    });
    AnyChannels::sort(list.collect())
}

/// Reads the layers of an EXR file as floats: those whose channels are named as [`write_exr`] names them.
pub fn read_exr(path: &Path) -> Result<Vec<(String, Picture)>> {
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
    let image =
        reader.all_layers().all_attributes().from_file(path).map_err(|error| unreadable(path, error))?;
    let layers = image.layer_data.iter().filter_map(|layer| {
        let name = layer.attributes.layer_name.as_ref().map(Text::to_string).unwrap_or_default();
        Some((name, picture(layer)?))
    });
    Ok(layers.collect())
}

fn picture(layer: &Layer<AnyChannels<FlatSamples>>) -> Option<Picture> {
    let list = &layer.channel_data.list;
    let names = NAMES.get(list.len().checked_sub(1)?)?;
    let find = |name: &&str| list.iter().find(|channel| channel.name == **name);
    let channels: Vec<Vec<f32>> = names
        .iter()
        .map(|name| find(name).map(|channel| channel.sample_data.values_as_f32().collect()))
        .collect::<Option<_>>()?;
    let count = layer.size.area();
    let data =
        (0..count).flat_map(|i| channels.iter().map(move |c| c.get(i).copied())).collect::<Option<_>>()?;
    Picture::new(layer.size.width() as u32, layer.size.height() as u32, names.len() as u32, data)
}
