//! What a composed kernel binds, and what its entry points do with it.

use super::compose::Composed;
use super::globals::{self, Globals};
use super::{Binding, Entry, Override, Stage, Target, Use, diagnose, overrides};
use crate::problem::{Problem, Problems, Result};
use naga::valid::{Capabilities, FunctionInfo, GlobalUse, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, BuiltIn, GlobalVariable, Handle, Module, ResourceBinding, ShaderStage, TypeInner};
use std::collections::{BTreeMap, BTreeSet};

/// A kernel with its overrides put in.
#[derive(Clone, Debug)]
pub struct Reflected {
    pub composed: Composed,
    /// What some entry point uses, in the order of the composed text.
    pub bindings: Vec<Binding>,
    pub entries: Vec<Entry>,
    /// All overrides that the kernel declares.
    pub overrides: Vec<Override>,
    /// The values that overrides were given, as bits.
    pub(super) values: BTreeMap<String, u64>,
    /// Valid. Its resources carry provisional binding numbers.
    pub(super) module: Module,
}

/// Parses `composed`, puts in the values of `overrides` (by name; others are left out), and says what it binds.
///
/// # Errors
/// What is not valid WGSL, at the author's place; override values that are missing or do not fit; bindings, stages and
/// interfaces that no pipeline of the engine can provide.
pub fn reflect(composed: &Composed, overrides: &BTreeMap<String, f64>) -> Result<Reflected> {
    reflect_with(composed, overrides, None)
}

/// As [`reflect`], but overrides without any value become `missing`.
pub(super) fn reflect_with(
    composed: &Composed,
    given: &BTreeMap<String, f64>,
    missing: Option<f64>,
) -> Result<Reflected> {
    let (module, info) = parse(composed)?;
    let declared = overrides::declared(composed, &module);
    let (module, info, values) = overrides::put_in(composed, module, info, given, missing)?;
    let reader = Reader::new(composed, &module, &info, false)?;
    let (bindings, entries) = (reader.bindings()?, reader.entries()?);
    Ok(Reflected { composed: composed.clone(), bindings, entries, overrides: declared, values, module })
}

/// The bindings that a module without entry points declares.
pub(super) fn declared_bindings(composed: &Composed) -> Result<Vec<Binding>> {
    let (module, info) = parse(composed)?;
    Reader::new(composed, &module, &info, true)?.bindings()
}

/// The valid module of a text, with provisional binding numbers: naga validates no module without.
fn parse(composed: &Composed) -> Result<(Module, ModuleInfo)> {
    let mut module = naga::front::wgsl::parse_str(&composed.text)
        .map_err(|error| diagnose::parse_error(composed, &error))?;
    for (i, (_, variable)) in (0..).zip(module.global_variables.iter_mut()) {
        if is_resource(variable) {
            variable.binding = Some(ResourceBinding { group: 0, binding: i });
        }
    }
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|error| diagnose::invalid(composed, &error))?;
    Ok((module, info))
}

/// Whether something must be bound to a variable (immediates are none of the engine's sorts, and refused as such).
pub(super) fn is_resource(variable: &GlobalVariable) -> bool {
    matches!(variable.space, AddressSpace::Uniform | AddressSpace::Storage { .. } | AddressSpace::Handle)
}

/// Reads one module. Bindings are indexed by their order in the composed text.
struct Reader<'a> {
    composed: &'a Composed,
    module: &'a Module,
    info: &'a ModuleInfo,
    globals: Globals<'a>,
    /// The variables that are listed.
    listed: Vec<Handle<GlobalVariable>>,
}

impl<'a> Reader<'a> {
    fn new(
        composed: &'a Composed,
        module: &'a Module,
        info: &'a ModuleInfo,
        unused: bool,
    ) -> Result<Self, Problem> {
        let own = |space| matches!(space, AddressSpace::Private | AddressSpace::WorkGroup);
        let used = |handle: Handle<GlobalVariable>| {
            (0..module.entry_points.len()).any(|i| !info.get_entry_point(i)[handle].is_empty())
        };
        let mut listed: Vec<_> = module
            .global_variables
            .iter()
            .filter(|(handle, variable)| !own(variable.space) && (unused || used(*handle)))
            .map(|(handle, _)| handle)
            .collect();
        listed.sort_by_key(|handle| {
            module.global_variables.get_span(*handle).to_range().map(|range| range.start)
        });
        Ok(Self { composed, module, info, globals: Globals::new(composed, module)?, listed })
    }

    fn bindings(&self) -> Result<Vec<Binding>> {
        let filtered: BTreeSet<_> = (0..self.module.entry_points.len())
            .flat_map(|i| &self.info.get_entry_point(i).sampling_set)
            .map(|pair| pair.image)
            .collect();
        let mut problems = Vec::new();
        let mut bindings = Vec::new();
        for handle in &self.listed {
            match self.globals.binding(&self.module.global_variables[*handle], filtered.contains(handle)) {
                Ok(binding) => bindings.push(binding),
                Err(problem) => problems.push(problem),
            }
        }
        Problems::check(problems)?;
        Ok(bindings)
    }

    fn entries(&self) -> Result<Vec<Entry>> {
        let mut problems = Vec::new();
        let mut entries = Vec::new();
        for (i, entry) in self.module.entry_points.iter().enumerate() {
            let place = self.composed.place_of(&entry.name);
            let stage = match entry.stage {
                ShaderStage::Vertex => Stage::Vertex,
                ShaderStage::Fragment => Stage::Fragment,
                ShaderStage::Compute => Stage::Compute,
                _ => {
                    let message = format!("`{}` is of a stage that no pipeline here has", entry.name);
                    let problem = Problem::input("unsupported-stage", message);
                    problems.push(problem.at(&place, "not a vertex, fragment or compute entry point"));
                    continue;
                }
            };
            let outputs = Outputs::read(self.module, entry);
            if stage == Stage::Vertex {
                problems.extend(self.vertex_inputs(entry, &place));
            }
            if stage == Stage::Fragment && outputs.unnamed {
                problems.push(
                    Problem::input("unnamed-target", format!("`{}` writes a colour that has no name", entry.name))
                        .at(&place, "returns a bare `@location`, or one that holds no 32-bit numbers")
                        .help("return a struct: its members name the targets, as in `struct Out { @location(0) color: vec4f }`"),
                );
            }
            let compute = stage == Stage::Compute;
            let info = self.info.get_entry_point(i);
            entries.push(Entry {
                name: entry.name.clone(),
                stage,
                workgroup_size: if compute { entry.workgroup_size } else { [1; 3] },
                uses: self.uses(info),
                sampled: self.sampled(info),
                targets: if stage == Stage::Fragment { outputs.targets } else { Vec::new() },
                depth: outputs.depth,
                place,
            });
        }
        Problems::check(problems)?;
        Ok(entries)
    }

    fn uses(&self, info: &FunctionInfo) -> Vec<Use> {
        let used = self.listed.iter().enumerate().filter(|(_, handle)| !info[**handle].is_empty());
        used.map(|(binding, handle)| {
            let how = info[*handle];
            let atomic = how.contains(GlobalUse::ATOMIC);
            Use {
                binding,
                read: atomic || how.contains(GlobalUse::READ),
                write: atomic || how.contains(GlobalUse::WRITE),
            }
        })
        .collect()
    }

    fn sampled(&self, info: &FunctionInfo) -> Vec<(usize, usize)> {
        let index = |handle| self.listed.iter().position(|listed| *listed == handle);
        let pairs =
            info.sampling_set.iter().filter_map(|pair| Some((index(pair.image)?, index(pair.sampler)?)));
        pairs.collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// Vertices are read from buffers, so that a kernel says what they are; there are no vertex attributes to bind.
    fn vertex_inputs(&self, entry: &naga::EntryPoint, place: &crate::problem::Place) -> Option<Problem> {
        let is_location =
            |binding: &Option<naga::Binding>| matches!(binding, Some(naga::Binding::Location { .. }));
        let has_location = entry.function.arguments.iter().any(|argument| {
            is_location(&argument.binding)
                || matches!(&self.module.types[argument.ty].inner, TypeInner::Struct { members, .. }
                    if members.iter().any(|member| is_location(&member.binding)))
        });
        has_location.then(|| {
            Problem::input("vertex-input", format!("`{}` takes vertex attributes", entry.name))
                .at(place, "an argument has a `@location`")
                .help("take `@builtin(vertex_index)` and read the vertex from a storage buffer")
        })
    }
}

/// What an entry point returns.
#[derive(Default)]
struct Outputs {
    targets: Vec<Target>,
    depth: bool,
    /// Some location is not a named member of 32-bit numbers.
    unnamed: bool,
}

impl Outputs {
    fn read(module: &Module, entry: &naga::EntryPoint) -> Self {
        let mut outputs = Self::default();
        if let Some(result) = &entry.function.result {
            match &module.types[result.ty].inner {
                TypeInner::Struct { members, .. } => {
                    for member in members {
                        outputs.add(module, member.name.as_deref(), member.ty, member.binding.as_ref());
                    }
                }
                _ => outputs.add(module, None, result.ty, result.binding.as_ref()),
            }
        }
        outputs.targets.sort_by_key(|target| target.location);
        outputs
    }

    fn add(
        &mut self,
        module: &Module,
        name: Option<&str>,
        ty: Handle<naga::Type>,
        at: Option<&naga::Binding>,
    ) {
        match at {
            Some(naga::Binding::BuiltIn(BuiltIn::FragDepth)) => self.depth = true,
            Some(naga::Binding::Location { location, .. }) => {
                let shape = match module.types[ty].inner {
                    TypeInner::Scalar(scalar) => globals::scalar(scalar).map(|scalar| (1, scalar)),
                    TypeInner::Vector { size, scalar } => {
                        globals::scalar(scalar).map(|scalar| (globals::count(size), scalar))
                    }
                    _ => None,
                };
                match (name, shape) {
                    (Some(name), Some((components, scalar))) => {
                        let name = name.to_owned();
                        self.targets.push(Target { name, location: *location, scalar, components });
                    }
                    _ => self.unnamed = true,
                }
            }
            _ => {}
        }
    }
}
