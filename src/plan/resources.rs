//! From a resource as declared to its kind: format, size, mips, layers, count.

use super::world::{LazyResource, Live, World};
use super::{ResourceKind, Start};
use crate::document::{self, Cause, ExprText, Resource};
use crate::expr::Value;
use crate::problem::{Place, Problem};
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::Error;
use std::collections::BTreeSet;
use wgpu_types::TextureFormat;

/// The formats that kernels can write or draw to.
const FORMATS: &str = "r8unorm r8snorm r8uint r8sint r16uint r16sint r16unorm r16snorm r16float rg8unorm rg8snorm \
    rg8uint rg8sint r32uint r32sint r32float rg16uint rg16sint rg16unorm rg16snorm rg16float rgba8unorm \
    rgba8unorm-srgb rgba8snorm rgba8uint rgba8sint bgra8unorm bgra8unorm-srgb rgb9e5ufloat rgb10a2uint rgb10a2unorm \
    rg11b10ufloat r64uint rg32uint rg32sint rg32float rgba16uint rgba16sint rgba16unorm rgba16snorm rgba16float \
    rgba32uint rgba32sint rgba32float stencil8 depth16unorm depth24plus depth24plus-stencil8 depth32float \
    depth32float-stencil8";

fn format_named(name: &str) -> Option<TextureFormat> {
    let known = FORMATS.split(' ').any(|known| known == name);
    let parsed: Result<TextureFormat, Error> = TextureFormat::deserialize(name.into_deserializer());
    parsed.ok().filter(|_| known)
}

impl World<'_> {
    /// The kind of a resource, and what its size depends on. Where something is wrong, it is reported and unknown.
    pub(super) fn declared_kind(&self, resource: &LazyResource<'_>) -> (ResourceKind, BTreeSet<Cause>) {
        let mut causes = BTreeSet::new();
        let kind = match resource.declared {
            None => ResourceKind::Scene,
            Some(Resource::Buffer { count, .. }) => {
                causes.extend(count.iter().flat_map(|count| self.causes(count, resource.scope)));
                let count =
                    count.as_ref().map_or(Some(1), |n| self.whole(n, resource.scope, 1, resource.live));
                ResourceKind::Buffer { count }
            }
            Some(Resource::Texture { format, size, mips, layers, .. }) => {
                for text in size.iter().chain(mips.iter().filter(|mips| mips.value != "all")).chain(layers) {
                    causes.extend(self.causes(text, resource.scope));
                }
                self.texture(resource, format, size, mips.as_ref(), layers.as_ref())
            }
        };
        if causes.contains(&Cause::Frame) {
            self.report(
                Problem::input(
                    "size-per-frame",
                    format!("the size of `{}` depends on the frame", resource.path),
                )
                .at(&resource.place, "declared here")
                .help("make it as large as it can get"),
            );
        }
        (kind, causes)
    }

    fn texture(
        &self,
        resource: &LazyResource<'_>,
        format: &ExprText,
        sizes: &[ExprText],
        mips: Option<&ExprText>,
        layers: Option<&ExprText>,
    ) -> ResourceKind {
        let dimensions = if sizes.is_empty() { 2 } else { sizes.len() };
        let mut size = Some([1; 3]);
        if sizes.is_empty() {
            let [width, height] = self.setup.output;
            size = Some([width, height, 1]);
        }
        for (axis, text) in sizes.iter().enumerate() {
            let length = self.u32(text, resource);
            size = size.zip(length).map(|(mut size, length)| {
                size[axis] = length;
                size
            });
        }
        if let Some(layers) = layers.filter(|_| dimensions != 2) {
            let problem =
                Problem::input("layers", format!("a texture of {dimensions} dimensions has no layers"));
            self.report(
                problem.at(&layers.place, "layers").help("a texture with layers has a width and a height"),
            );
        }
        ResourceKind::Texture {
            format: self.format(format, resource),
            dimensions: dimensions as u8,
            size,
            mips: self.mips(mips, size, dimensions, resource),
            layers: layers.map_or(Some(1), |layers| self.u32(layers, resource)),
            array: layers.is_some(),
        }
    }

    fn u32(&self, text: &ExprText, resource: &LazyResource<'_>) -> Option<u32> {
        let number = self.whole(text, resource.scope, 1, resource.live)?;
        if let Ok(number) = u32::try_from(number) {
            return Some(number);
        }
        if resource.live == Live::Yes {
            let problem = Problem::input("out-of-range", format!("{number} is too large for a texture"));
            self.report(problem.at(&text.place, "this size"));
        }
        None
    }

    fn mips(
        &self,
        mips: Option<&ExprText>,
        size: Option<[u32; 3]>,
        dimensions: usize,
        resource: &LazyResource<'_>,
    ) -> Option<u32> {
        let Some(text) = mips else { return Some(1) };
        let chain = match (dimensions, size) {
            (1, _) => Some(1),
            (_, size) => size.map(|size| size.iter().fold(1, |most, length| most.max(*length)).ilog2() + 1),
        };
        if text.value == "all" {
            return chain;
        }
        let count = self.u32(text, resource)?;
        if let Some(chain) = chain.filter(|chain| *chain < count) {
            if resource.live == Live::Yes {
                let message = format!("{count} mips are too many: at this size there are {chain}");
                let problem =
                    Problem::input("too-many-mips", message).at(&text.place, format!("this is {count}"));
                self.report(problem.help("`mips: \"all\"` makes as many as there can be"));
            }
            return None;
        }
        Some(count)
    }

    /// A format's name, or an expression with such a text for its value. Where it is wrong, any format will do: the
    /// problem has been reported.
    fn format(&self, text: &ExprText, resource: &LazyResource<'_>) -> TextureFormat {
        const ANY: TextureFormat = TextureFormat::Rgba8Unorm;
        if let Some(format) = format_named(&text.value) {
            return format;
        }
        let plain =
            text.value.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'));
        if plain && self.lookup(resource.scope, &text.value).is_none() {
            self.report(unknown_format(&text.value, &text.place));
            return ANY;
        }
        let problem = match self.value(text, resource.scope, Live::Yes) {
            Value::Text(name) => match format_named(&name) {
                Some(format) => return format,
                None => unknown_format(&name, &text.place),
            },
            Value::Unknown => {
                let message = "this format is not known before the scene is";
                Problem::input("format-unknown", message)
                    .help("a format can depend on knobs only")
                    .at(&text.place, "depends on the scene or the frame, or is wrong itself")
            }
            other => Problem::input("wrong-type", format!("a format is a text, not {}", other.kind()))
                .at(&text.place, format!("this is {other}")),
        };
        self.report(problem);
        ANY
    }
}

fn unknown_format(name: &str, place: &Place) -> Problem {
    Problem::input("unknown-format", format!("there is no texture format `{name}`"))
        .at(place, "used here")
        .suggest(name, FORMATS.split(' '))
}

pub(super) fn start(declared: Option<&Resource>) -> Start {
    let Some(Resource::Texture { start, .. } | Resource::Buffer { start, .. }) = declared else {
        return Start::Given;
    };
    match &start.value {
        document::Start::Fill(value) => Start::Fill(*value),
        document::Start::Covered => Start::Covered,
        document::Start::Kept { value, reset, steady } => {
            Start::Kept { value: *value, reset: reset.iter().copied().collect(), steady: *steady }
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_listed_format_is_one() {
        for name in super::FORMATS.split(' ') {
            assert!(super::format_named(name).is_some(), "{name}");
        }
        assert_eq!(super::format_named("astc-4x4-unorm"), None);
    }
}
