//! What can't be measured.

use super::pixels::colors;
use super::{Input, Options, Truth, refuse};
use crate::picture::Picture;
use crate::problem::{Problem, Problems, Result};

/// A picture and its reference: two, of one size, finite.
pub(super) fn pair(test: &Input, truth: &Truth) -> Result<()> {
    if test.name == truth.name || std::ptr::eq(test.picture.data(), truth.picture.data()) {
        let message = format!("`{}` is held against itself", test.name);
        return Err(refuse("measure-alike", message, "that says nothing: name another reference").into());
    }
    alike(test, &truth.input())?;
    finite(&[*test, truth.input()])
}

/// Of one size.
pub(super) fn same_size(a: &Input, b: &Input) -> Result<()> {
    let size = |input: &Input| (input.picture.width(), input.picture.height());
    unlike(a, b, size(a) != size(b))
}

/// Of one size, with as many colour channels.
fn alike(a: &Input, b: &Input) -> Result<()> {
    same_size(a, b)?;
    unlike(a, b, colors(a.picture) != colors(b.picture))
}

fn unlike(a: &Input, b: &Input, unlike: bool) -> Result<()> {
    if !unlike {
        return Ok(());
    }
    let message = format!("`{}` has {}, and `{}` has {}", a.name, words(a.picture), b.name, words(b.picture));
    Err(refuse("measure-size", message, "make both with one `--size` and from the same output").into())
}

fn words(picture: &Picture) -> String {
    let colors = colors(picture);
    let channels = if colors == 1 { "channel" } else { "channels" };
    format!("{}×{} pixels of {colors} {channels}", picture.width(), picture.height())
}

/// All channels, alpha too.
pub(super) fn finite(inputs: &[Input]) -> Result<()> {
    let found = inputs.iter().filter_map(|input| {
        let help = "`voxgi render --scan` finds the first stage that writes such a number";
        let code = "measure-finite";
        Some(Problem::failure(code, bad(input, "not finite", |value| !value.is_finite())?).help(help))
    });
    Problems::check(found.collect()).map(drop)
}

/// A variance is as large as its picture and has no negative or infinite values.
pub(super) fn variance(truth: &Truth) -> Result<()> {
    let Some(picture) = truth.variance else { return Ok(()) };
    let name = format!("variance of {}", truth.name);
    let variance = Input { name: &name, picture };
    alike(&variance, &truth.input())?;
    match bad(&variance, "no variance", |value| !(value.is_finite() && value >= 0.0)) {
        Some(message) => Err(refuse("measure-variance", message, "make the reference again").into()),
        None => Ok(()),
    }
}

/// How many pixels there are that a channel makes unfit, where the first is, and what it holds.
fn bad(input: &Input, what: &str, unfit: impl Fn(f32) -> bool) -> Option<String> {
    let picture = input.picture;
    let mut found = picture.texels().enumerate().filter(|(_, texel)| texel.iter().any(|value| unfit(*value)));
    let (first, texel) = found.next()?;
    let (count, width) = (1 + found.count(), picture.width() as usize);
    Some(format!(
        "`{}`: {count} of {} pixels {} {what}, the first at x = {}, y = {}: {texel:?}",
        input.name,
        picture.texels().len(),
        if count == 1 { "is" } else { "are" },
        first % width,
        first / width,
    ))
}

pub(super) fn exposure(options: &Options) -> Result<()> {
    if options.exposure.is_finite() {
        return Ok(());
    }
    let message = format!("an exposure of {} stops shows nothing", options.exposure);
    Err(refuse("measure-exposure", message, "give a number, such as 0").into())
}

pub(super) fn mask(mask: Option<&[bool]>, picture: &Picture) -> Result<()> {
    let Some(mask) = mask else { return Ok(()) };
    let pixels = picture.texels().len();
    if mask.len() != pixels {
        let message = format!("a mask of {} pixels does not fit a picture of {pixels}", mask.len());
        return Err(refuse("measure-mask", message, "make the mask from the same reference").into());
    }
    if !mask.contains(&true) {
        let message = format!("a mask leaves none of {pixels} pixels to measure");
        return Err(refuse("measure-mask", message, "leave this mask out").into());
    }
    Ok(())
}
