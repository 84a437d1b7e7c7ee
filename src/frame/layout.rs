//! Texels as bytes and as numbers, for the formats that pipelines use.

use half::f16;
use wgpu::TextureFormat;

/// How the components of a texel are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    Unorm8,
    /// Unorm8 whose first three components hold the sRGB curve.
    Srgb8,
    Snorm8,
    Uint8,
    Sint8,
    Uint16,
    Sint16,
    Float16,
    Uint32,
    Sint32,
    Float32,
}

/// Components of a texel, and how many; `None` for formats that can't be read back as numbers.
pub fn components(format: TextureFormat) -> Option<(Component, usize)> {
    use Component as C;
    use TextureFormat as F;
    Some(match format {
        F::R8Unorm => (C::Unorm8, 1),
        F::Rg8Unorm => (C::Unorm8, 2),
        F::Rgba8Unorm => (C::Unorm8, 4),
        F::Rgba8UnormSrgb => (C::Srgb8, 4),
        F::R8Snorm => (C::Snorm8, 1),
        F::Rg8Snorm => (C::Snorm8, 2),
        F::Rgba8Snorm => (C::Snorm8, 4),
        F::R8Uint => (C::Uint8, 1),
        F::Rg8Uint => (C::Uint8, 2),
        F::Rgba8Uint => (C::Uint8, 4),
        F::R8Sint => (C::Sint8, 1),
        F::Rgba8Sint => (C::Sint8, 4),
        F::R16Uint => (C::Uint16, 1),
        F::Rg16Uint => (C::Uint16, 2),
        F::Rgba16Uint => (C::Uint16, 4),
        F::R16Sint => (C::Sint16, 1),
        F::Rgba16Sint => (C::Sint16, 4),
        F::R16Float => (C::Float16, 1),
        F::Rg16Float => (C::Float16, 2),
        F::Rgba16Float => (C::Float16, 4),
        F::R32Uint => (C::Uint32, 1),
        F::Rg32Uint => (C::Uint32, 2),
        F::Rgba32Uint => (C::Uint32, 4),
        F::R32Sint => (C::Sint32, 1),
        F::Rg32Sint => (C::Sint32, 2),
        F::Rgba32Sint => (C::Sint32, 4),
        F::R32Float | F::Depth32Float => (C::Float32, 1),
        F::Rg32Float => (C::Float32, 2),
        F::Rgba32Float => (C::Float32, 4),
        _ => return None,
    })
}

impl Component {
    pub fn bytes(self) -> usize {
        use Component as C;
        match self {
            C::Unorm8 | C::Srgb8 | C::Snorm8 | C::Uint8 | C::Sint8 => 1,
            C::Uint16 | C::Sint16 | C::Float16 => 2,
            C::Uint32 | C::Sint32 | C::Float32 => 4,
        }
    }

    /// Whether the stored bits can be NaN or infinite.
    pub fn is_float(self) -> bool {
        matches!(self, Component::Float16 | Component::Float32)
    }

    /// The number that a kernel would read; `color`: one of the first three components.
    pub fn decode(self, bytes: &[u8], color: bool) -> f32 {
        use Component as C;
        let half = || u16::from_le_bytes([bytes[0], bytes[1]]);
        let word = || u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        match self {
            C::Srgb8 if color => srgb_to_linear(f32::from(bytes[0]) / 255.0),
            C::Unorm8 | C::Srgb8 => f32::from(bytes[0]) / 255.0,
            C::Snorm8 => (f32::from(bytes[0] as i8) / 127.0).max(-1.0),
            C::Uint8 => f32::from(bytes[0]),
            C::Sint8 => f32::from(bytes[0] as i8),
            C::Uint16 => f32::from(half()),
            C::Sint16 => f32::from(half() as i16),
            C::Float16 => f16::from_bits(half()).to_f32(),
            C::Uint32 => word() as f32,
            C::Sint32 => word() as i32 as f32,
            C::Float32 => f32::from_bits(word()),
        }
    }

    fn encode(self, value: f64) -> Vec<u8> {
        use Component as C;
        let scaled = |most: f64, least: f64| (value.clamp(least, 1.0) * most).round();
        match self {
            C::Unorm8 | C::Srgb8 => vec![scaled(255.0, 0.0) as u8],
            C::Snorm8 => vec![scaled(127.0, -1.0) as i8 as u8],
            C::Uint8 => vec![value as u8],
            C::Sint8 => vec![value as i8 as u8],
            C::Uint16 => (value as u16).to_le_bytes().to_vec(),
            C::Sint16 => (value as i16).to_le_bytes().to_vec(),
            C::Float16 => f16::from_f64(value).to_le_bytes().to_vec(),
            C::Uint32 => (value as u32).to_le_bytes().to_vec(),
            C::Sint32 => (value as i32).to_le_bytes().to_vec(),
            C::Float32 => (value as f32).to_le_bytes().to_vec(),
        }
    }
}

/// A texel with `value` in every component.
pub fn encode(format: TextureFormat, value: f64) -> Option<Vec<u8>> {
    let (component, count) = components(format)?;
    Some(component.encode(value).repeat(count))
}

fn srgb_to_linear(x: f32) -> f32 {
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}
