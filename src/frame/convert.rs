//! A pipeline file's words as wgpu's.

use crate::device::Gpu;
use crate::document::{Blend, Compare, Filter, Sampler, Wrap};
use crate::graph::Bound;
use crate::kernel::BindingKind;
use wgpu::{BindingType, BufferBindingType, SamplerBindingType, TextureSampleType};

/// What a bind group layout says of a binding.
pub fn binding_type(bound: &Bound, kind: &BindingKind) -> BindingType {
    let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    match kind {
        BindingKind::Uniform(_) => buffer(BufferBindingType::Uniform),
        BindingKind::Storage(layout) => buffer(BufferBindingType::Storage { read_only: !layout.writable }),
        BindingKind::Texture { dimension, sample, multisampled } => {
            let filterable = matches!(bound, Bound::Texture { filterable: true, .. });
            BindingType::Texture {
                sample_type: match sample {
                    TextureSampleType::Float { .. } => TextureSampleType::Float { filterable },
                    other => *other,
                },
                view_dimension: *dimension,
                multisampled: *multisampled,
            }
        }
        BindingKind::StorageTexture { dimension, format, access } => {
            BindingType::StorageTexture { access: *access, format: *format, view_dimension: *dimension }
        }
        BindingKind::Sampler { comparison: true } => BindingType::Sampler(SamplerBindingType::Comparison),
        BindingKind::Sampler { comparison: false } => BindingType::Sampler(match bound {
            Bound::Sampler(s) if s.filter == Filter::Nearest && s.mip_filter == Filter::Nearest => {
                SamplerBindingType::NonFiltering
            }
            _ => SamplerBindingType::Filtering,
        }),
    }
}

pub fn compare_function(compare: Compare) -> wgpu::CompareFunction {
    match compare {
        Compare::Less => wgpu::CompareFunction::Less,
        Compare::LessEqual => wgpu::CompareFunction::LessEqual,
        Compare::Greater => wgpu::CompareFunction::Greater,
        Compare::GreaterEqual => wgpu::CompareFunction::GreaterEqual,
        Compare::Equal => wgpu::CompareFunction::Equal,
        Compare::Always => wgpu::CompareFunction::Always,
    }
}

pub fn blend_state(blend: Blend) -> wgpu::BlendState {
    use wgpu::{BlendComponent, BlendFactor as F, BlendOperation as O};
    let both = |src_factor, dst_factor, operation| {
        let component = BlendComponent { src_factor, dst_factor, operation };
        wgpu::BlendState { color: component, alpha: component }
    };
    match blend {
        Blend::Add => both(F::One, F::One, O::Add),
        Blend::Max => both(F::One, F::One, O::Max),
        Blend::Alpha => both(F::SrcAlpha, F::OneMinusSrcAlpha, O::Add),
    }
}

pub fn make_sampler(gpu: &Gpu, sampler: &Sampler) -> wgpu::Sampler {
    let address = match sampler.wrap {
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
    };
    let filter = match sampler.filter {
        Filter::Nearest => wgpu::FilterMode::Nearest,
        Filter::Linear => wgpu::FilterMode::Linear,
    };
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: None,
        address_mode_u: address,
        address_mode_v: address,
        address_mode_w: address,
        mag_filter: filter,
        min_filter: filter,
        mipmap_filter: match sampler.mip_filter {
            Filter::Nearest => wgpu::MipmapFilterMode::Nearest,
            Filter::Linear => wgpu::MipmapFilterMode::Linear,
        },
        compare: sampler.compare.map(compare_function),
        ..Default::default()
    })
}
