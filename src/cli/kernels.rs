//! `voxgi kernels`: what there is, with bindings and documentation.

use super::{print, print_json};
use crate::document::{self, Root};
use crate::kernel::{BindingKind, Description, describe};
use crate::library::{Library, Shelf};
use crate::problem::{Problems, Result};
use clap::Args;
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(Args)]
pub struct KernelsArgs {
    /// Only kernels whose name contains this.
    name: Option<String>,
    /// Say which module stands behind a role that kernels import; may be repeated. Default: that of the first part in
    /// the role, by name.
    #[arg(long = "role", value_name = "ROLE=KERNEL", value_parser = super::pair)]
    roles: Vec<(String, String)>,
    /// A folder with `kernels/` in it that is searched before the built-in library; may be repeated.
    #[arg(long = "library", value_name = "DIR")]
    libraries: Vec<PathBuf>,
    /// Print one JSON object.
    #[arg(long)]
    pub json: bool,
}

pub fn run(args: &KernelsArgs) -> Result<()> {
    let library = Library::new(args.libraries.clone())?;
    let mut roles = modules(&library);
    roles.extend(args.roles.iter().cloned());
    let wanted = |name: &String| args.name.as_ref().is_none_or(|part| name.contains(part.as_str()));
    let (mut kernels, mut problems) = (Vec::new(), Vec::new());
    for name in library.list(Shelf::Kernels).iter().filter(|n| wanted(n)) {
        match describe(&library, name, &roles) {
            Ok(description) => kernels.push(description),
            // One broken kernel does not hide the others.
            Err(found) => problems.extend(found.iter().cloned()),
        }
    }
    if args.json {
        let list: Vec<_> = kernels.iter().map(json).collect();
        print_json(&serde_json::json!({ "schema": crate::record::SCHEMA, "kernels": list }));
    } else {
        kernels.iter().for_each(|k| print(&text(k)));
    }
    Problems::check(problems).map(|_| ())
}

/// For each role the module of the first part, by name, that can play it: some choice is needed to list bindings.
fn modules(library: &Library) -> BTreeMap<String, String> {
    let mut modules = BTreeMap::new();
    for part in library.list(Shelf::Parts) {
        // A part that can't be read has no module to offer; `check` says what is wrong with it.
        let document =
            library.find(Shelf::Parts, &part).ok().and_then(|source| document::parse(&source).ok());
        if let Some(Root::Part { role, module: Some(module), .. }) = document.map(|d| d.root) {
            modules.entry(role.value).or_insert(module.value);
        }
    }
    modules
}

/// A binding's kind as WGSL would declare it, roughly.
fn kind(kind: &BindingKind) -> String {
    match kind {
        BindingKind::Uniform(layout) => {
            let fields: Vec<_> = layout.fields.iter().map(|f| f.name.as_str()).collect();
            format!("uniform of {}", fields.join(", "))
        }
        BindingKind::Storage(layout) => {
            let access = if layout.writable { "read and write" } else { "read" };
            match layout.stride {
                Some(stride) => format!("buffer, {access}, elements of {stride} bytes"),
                None => format!("buffer, {access}, {} bytes", layout.head),
            }
        }
        BindingKind::Texture { dimension, sample, .. } => format!("texture {dimension:?}, {sample:?}"),
        BindingKind::StorageTexture { dimension, format, access } => {
            format!("storage texture {dimension:?}, {}, {access:?}", crate::graph::format_name(*format))
        }
        BindingKind::Sampler { comparison: true } => "comparison sampler".to_owned(),
        BindingKind::Sampler { comparison: false } => "sampler".to_owned(),
    }
}

fn text(kernel: &Description) -> String {
    let mut text = format!("{}\n", kernel.name);
    for line in kernel.about.lines() {
        text += &format!("    {line}\n");
    }
    for entry in &kernel.entries {
        let size = entry.workgroup_size.map(|n| n.to_string()).join("x");
        let threads = if entry.stage == crate::kernel::Stage::Compute {
            format!(", {size} threads")
        } else {
            String::new()
        };
        text += &format!("  {:?} `{}`{threads}\n", entry.stage, entry.name);
        for target in &entry.targets {
            text += &format!("    {:<20} target {}\n", target.name, target.location);
        }
    }
    for binding in &kernel.bindings {
        let of = binding.role.as_ref().map_or(String::new(), |role| format!(", of the role {role}"));
        text += &format!("    {:<20} {}{of}\n", binding.name, kind(&binding.kind));
    }
    if !kernel.imports.is_empty() {
        text += &format!("    imports {}\n", kernel.imports.join(", "));
    }
    if !kernel.needs.is_empty() {
        let roles: Vec<_> = kernel.needs.iter().map(|role| format!("--role {role}=KERNEL")).collect();
        text += &format!("    its bindings depend on roles: {}\n", roles.join(" "));
    }
    text.push('\n');
    text
}

fn json(kernel: &Description) -> serde_json::Value {
    let bindings: Vec<_> = kernel
        .bindings
        .iter()
        .map(|b| serde_json::json!({ "name": b.name, "role": b.role, "kind": kind(&b.kind), "about": b.about }))
        .collect();
    let entries: Vec<_> = kernel
        .entries
        .iter()
        .map(|e| {
            let targets: Vec<_> = e.targets.iter().map(|t| &t.name).collect();
            serde_json::json!({
                "name": e.name, "stage": format!("{:?}", e.stage).to_lowercase(),
                "workgroup_size": e.workgroup_size, "targets": targets,
            })
        })
        .collect();
    serde_json::json!({
        "name": kernel.name, "about": kernel.about, "imports": kernel.imports, "roles_needed": kernel.needs,
        "bindings": bindings, "entries": entries,
        "overrides": kernel.overrides.iter().map(|o| &o.name).collect::<Vec<_>>(),
    })
}
