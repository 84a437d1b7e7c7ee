//! `voxgi devices`: adapters, and which clock and limits each has.

use super::{print, print_json};
use crate::device;
use crate::problem::{Problem, Result};
use crate::record::Adapter;
use clap::Args;
use std::fmt::Write;
use wgpu::Features;

#[derive(Args)]
pub struct DevicesArgs {
    /// Print one JSON object.
    #[arg(long)]
    pub json: bool,
}

/// Features that pipelines can make use of, with what for.
const FEATURES: [(Features, &str); 8] = [
    (Features::TIMESTAMP_QUERY, "times of stages"),
    (Features::TIMESTAMP_QUERY_INSIDE_ENCODERS, "times of fills"),
    (Features::FLOAT32_FILTERABLE, "filtering of 32-bit floats"),
    (Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES, "more storage formats"),
    (Features::TEXTURE_ATOMIC, "atomics on textures"),
    (Features::SUBGROUP, "subgroups"),
    (Features::SHADER_F16, "16-bit floats"),
    (Features::INDIRECT_FIRST_INSTANCE, "indirect draws from any instance"),
];

pub fn run(args: &DevicesArgs) -> Result<()> {
    let adapters = device::adapters();
    if adapters.is_empty() {
        return Err(device::no_adapter().into());
    }
    if args.json {
        let list: Vec<_> = adapters.iter().map(describe).collect();
        print_json(&serde_json::json!({ "schema": crate::record::SCHEMA, "devices": list }));
        return Ok(());
    }
    let mut text = String::new();
    for adapter in &adapters {
        let info = Adapter::new(&adapter.get_info());
        let limits = adapter.limits();
        let mut line = |what: &str, is: String| {
            writeln!(text, "  {what:<22} {is}").map_err(|e| Problem::failure("print", e.to_string()))
        };
        line("adapter", format!("{} ({}, {})", info.name, info.kind, info.backend))?;
        line("driver", format!("{} {}", info.driver, info.driver_info))?;
        line("storage binding", crate::session::bytes(limits.max_storage_buffer_binding_size))?;
        line("buffer", crate::session::bytes(limits.max_buffer_size))?;
        line("3D texture", format!("{} texels a side", limits.max_texture_dimension_3d))?;
        line(
            "per stage",
            format!(
                "{} storage buffers, {} storage textures, {} sampled textures",
                limits.max_storage_buffers_per_shader_stage,
                limits.max_storage_textures_per_shader_stage,
                limits.max_sampled_textures_per_shader_stage
            ),
        )?;
        for (feature, what) in FEATURES {
            line(what, if adapter.features().contains(feature) { "yes" } else { "no" }.to_owned())?;
        }
        text.push('\n');
    }
    print(&text);
    Ok(())
}

fn describe(adapter: &wgpu::Adapter) -> serde_json::Value {
    let features: serde_json::Map<_, _> = FEATURES
        .iter()
        .map(|(feature, what)| ((*what).to_owned(), adapter.features().contains(*feature).into()))
        .collect();
    serde_json::json!({
        "adapter": Adapter::new(&adapter.get_info()),
        "limits": serde_json::to_value(adapter.limits()).unwrap_or_default(),
        "features": features,
    })
}
