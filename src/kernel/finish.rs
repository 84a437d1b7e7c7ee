//! From what a kernel is to a module that a device can take: some of its entry points, bindings numbered, storage
//! textures in the formats of the resources bound to them, validated against what the device can do.

use super::reflect::{Reflected, is_resource};
use super::{Binding, BindingKind, Composed, Entry, Segment, Stage, Use, diagnose};
use crate::problem::{Problem, Problems, Result};
use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{AddressSpace, ImageClass, Module, ResourceBinding, StorageAccess, Type, TypeInner};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use wgpu_naga_bridge::map_storage_format_to_naga;
use wgpu_types::{ShaderStages, TextureFormat};

/// What the engine decides about a kernel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Binding → format of the resource bound to it. Only storage textures follow it.
    pub formats: BTreeMap<String, TextureFormat>,
    /// Storage buffers to be declared `read_write` though the kernel only reads them: their memory is shared with
    /// something that is written by the same entry point.
    pub writable: BTreeSet<String>,
    /// What the device can do.
    pub capabilities: Capabilities,
}

/// Everything as the kernel declares it, on a device that can do all.
impl Default for Choice {
    fn default() -> Self {
        Self { formats: BTreeMap::new(), writable: BTreeSet::new(), capabilities: Capabilities::all() }
    }
}

/// A module for a device.
#[derive(Clone, Debug)]
pub struct Program {
    /// Validated, with unused declarations taken out.
    pub module: Module,
    /// By number: `bindings[i]` is `@group(0) @binding(i)`.
    pub bindings: Vec<Bound>,
    /// The chosen entry points, in the order chosen; their indices are binding numbers.
    pub entries: Vec<Entry>,
    pub key: VariantKey,
}

/// A numbered binding.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// As in the module: with the format and access that were chosen.
    pub binding: Binding,
    /// The stages of the chosen entry points that use it.
    pub visibility: ShaderStages,
    pub read: bool,
    pub write: bool,
}

/// All that a [`Program`] depends on. Choices about bindings that the chosen entry points do not use are no part of it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct VariantKey {
    text: Arc<str>,
    segments: Arc<[Segment]>,
    entries: Vec<String>,
    overrides: BTreeMap<String, u64>,
    formats: BTreeMap<String, TextureFormat>,
    writable: BTreeSet<String>,
    capabilities: u64,
}

/// The entry points called `names` of a kernel, as a program.
///
/// # Errors
/// An entry point that is not there, a format that a storage texture can't have, and what `choice.capabilities` lack.
pub fn finish(reflected: &Reflected, names: &[&str], choice: &Choice) -> Result<Program> {
    let selection = Selection::new(reflected, names)?;
    let mut module = reflected.module.clone();
    module.entry_points.retain(|entry| names.contains(&entry.name.as_str()));
    compact(&mut module, KeepUnused::No);
    let key = selection.key(choice);
    let bindings = selection.apply(&mut module, &key)?;
    Validator::new(ValidationFlags::all(), choice.capabilities)
        .validate(&module)
        .map_err(|error| diagnose::invalid(&reflected.composed, &error))?;
    Ok(Program { module, bindings, entries: selection.entries(), key })
}

/// Some entry points of a kernel, and the bindings that they use.
pub struct Selection<'a> {
    reflected: &'a Reflected,
    chosen: Vec<&'a Entry>,
    /// Number → index into the bindings of the kernel.
    numbers: Vec<usize>,
}

impl<'a> Selection<'a> {
    pub fn new(reflected: &'a Reflected, names: &[&str]) -> Result<Self> {
        let (mut chosen, mut problems) = (Vec::new(), Vec::new());
        for name in names {
            match reflected.entries.iter().find(|entry| entry.name == *name) {
                Some(entry) => chosen.push(entry),
                None => problems.push(unknown_entry(&reflected.composed, &reflected.entries, name)),
            }
        }
        Problems::check(problems)?;
        let numbers: BTreeSet<usize> =
            chosen.iter().flat_map(|entry| &entry.uses).map(|used| used.binding).collect();
        Ok(Self { reflected, chosen, numbers: numbers.into_iter().collect() })
    }

    pub fn key(&self, choice: &Choice) -> VariantKey {
        let bindings = || self.numbers.iter().map(|index| &self.reflected.bindings[*index]);
        let formats = bindings().filter_map(|binding| match binding.kind {
            BindingKind::StorageTexture { format: declared, .. } => {
                let format = *choice.formats.get(&binding.name)?;
                (format != declared).then(|| (binding.name.clone(), format))
            }
            _ => None,
        });
        let writable = bindings().filter(|binding| match &binding.kind {
            BindingKind::Storage(layout) => !layout.writable && choice.writable.contains(&binding.name),
            _ => false,
        });
        VariantKey {
            text: self.reflected.composed.text.clone(),
            segments: self.reflected.composed.segments.clone(),
            entries: self.chosen.iter().map(|entry| entry.name.clone()).collect(),
            overrides: self.reflected.values.clone(),
            formats: formats.collect(),
            writable: writable.map(|binding| binding.name.clone()).collect(),
            capabilities: choice.capabilities.bits(),
        }
    }

    /// Numbers the bindings in `module`, and changes formats and access as `key` says.
    fn apply(&self, module: &mut Module, key: &VariantKey) -> Result<Vec<Bound>> {
        let mut bindings: Vec<Bound> = self.numbers.iter().map(|index| self.bound(*index)).collect();
        let mut problems = Vec::new();
        for (_, variable) in module.global_variables.iter_mut() {
            let name = variable.name.as_deref().unwrap_or_default();
            let found = (0..).zip(&mut bindings).find(|(_, bound)| bound.binding.name == name);
            let (Some((number, bound)), true) = (found, is_resource(variable)) else { continue };
            variable.binding = Some(ResourceBinding { group: 0, binding: number });
            if let Some(format) = key.formats.get(name) {
                let span = module.types.get_span(variable.ty);
                match reformatted(&module.types[variable.ty], *format, &bound.binding) {
                    Ok(ty) => variable.ty = module.types.insert(ty, span),
                    Err(problem) => problems.push(problem),
                }
                if let BindingKind::StorageTexture { format: declared, .. } = &mut bound.binding.kind {
                    *declared = *format;
                }
            }
            if key.writable.contains(name) {
                variable.space = AddressSpace::Storage { access: StorageAccess::LOAD | StorageAccess::STORE };
                if let BindingKind::Storage(layout) = &mut bound.binding.kind {
                    layout.writable = true;
                }
            }
        }
        Problems::check(problems)?;
        Ok(bindings)
    }

    /// The binding `index` of the kernel as used by the chosen entry points.
    fn bound(&self, index: usize) -> Bound {
        let binding = self.reflected.bindings[index].clone();
        let mut bound = Bound { binding, visibility: ShaderStages::NONE, read: false, write: false };
        for entry in &self.chosen {
            for used in entry.uses.iter().filter(|used| used.binding == index) {
                bound.visibility |= match entry.stage {
                    Stage::Vertex => ShaderStages::VERTEX,
                    Stage::Fragment => ShaderStages::FRAGMENT,
                    Stage::Compute => ShaderStages::COMPUTE,
                };
                bound.read |= used.read;
                bound.write |= used.write;
            }
        }
        bound
    }

    /// The chosen entry points, with binding numbers for indices.
    fn entries(&self) -> Vec<Entry> {
        let number = |index: &usize| self.numbers.binary_search(index).unwrap_or_else(|place| place);
        let renumbered = |entry: &&Entry| Entry {
            uses: entry.uses.iter().map(|used| Use { binding: number(&used.binding), ..*used }).collect(),
            sampled: entry.sampled.iter().map(|(image, sampler)| (number(image), number(sampler))).collect(),
            ..Entry::clone(entry)
        };
        self.chosen.iter().map(renumbered).collect()
    }
}

fn unknown_entry(composed: &Composed, entries: &[Entry], name: &str) -> Problem {
    Problem::input("unknown-entry", format!("the kernel `{}` has no entry point `{name}`", composed.kernel))
        .at(&composed.start(), "in this kernel")
        .suggest(name, entries.iter().map(|entry| entry.name.as_str()))
}

/// The type of a storage texture, in another format of the same class.
fn reformatted(declared: &Type, format: TextureFormat, binding: &Binding) -> Result<Type, Problem> {
    let TypeInner::Image { dim, arrayed, class: ImageClass::Storage { format: before, access } } =
        declared.inner
    else {
        return Ok(declared.clone());
    };
    let name = &binding.name;
    let refuse = |message: String| Problem::input("storage-format", message);
    let declared_name = format_name(wgpu_naga_bridge::map_storage_format_from_naga(before));
    let format_name = format_name(format);
    let Some(storage) = map_storage_format_to_naga(format) else {
        return Err(refuse(format!(
            "`{name}` can't be written in {format_name}: no kernel stores to that format"
        ))
        .at(&binding.place, format!("a storage texture, declared as {declared_name}")));
    };
    let kind = |format| naga::Scalar::from(format).kind;
    if kind(before) != kind(storage) {
        let holds = |format| match kind(format) {
            naga::ScalarKind::Uint => "unsigned integers",
            naga::ScalarKind::Sint => "signed integers",
            _ => "floats",
        };
        return Err(refuse(format!(
            "`{name}` can't be {format_name}: the kernel stores {} to it",
            holds(before)
        ))
        .at(&binding.place, format!("declared as {declared_name}"))
        .help(format!(
            "{format_name} holds {}: give the resource a format like {declared_name}",
            holds(storage)
        )));
    }
    if access.contains(StorageAccess::ATOMIC) {
        return Err(refuse(format!("`{name}` can't be {format_name}: the kernel uses atomics on it"))
            .at(&binding.place, format!("atomics need what is declared: {declared_name}")));
    }
    Ok(Type {
        name: None,
        inner: TypeInner::Image { dim, arrayed, class: ImageClass::Storage { format: storage, access } },
    })
}

/// The name that WebGPU has for a format.
fn format_name(format: TextureFormat) -> String {
    format!("{format:?}").to_lowercase().replace("srgb", "-srgb")
}
