//! Ties one binding of a kernel to what it is bound to, and checks that the two fit.

use super::facts;
use super::uniform::{Filler, is_engine_uniform};
use super::{Bound, Resource, Shape, Touch, Usage, resource};
use crate::document::{Geometry, Sampler};
use crate::expr::Value;
use crate::kernel::{Binding, BindingKind, Entry, Reflected};
use crate::plan::{Named, Plan, PlannedStage, Reference, ResourceId, ResourceKind, ScopeId};
use crate::problem::{Place, Problem};
use std::collections::{BTreeMap, BTreeSet};
use wgpu_types::{TextureAspect, TextureFormat, TextureSampleType, TextureViewDimension};

/// A binding and how the stage's entry points use it.
pub struct Use<'a> {
    pub binding: &'a Binding,
    pub read: bool,
    pub write: bool,
    /// Names of the samplers it is sampled with.
    pub samplers: Vec<&'a str>,
}

/// The bindings that `entries` use, each once.
pub fn used<'a>(reflected: &'a Reflected, entries: &[&'a Entry]) -> Vec<Use<'a>> {
    let mut uses: BTreeMap<usize, Use<'a>> = BTreeMap::new();
    for entry in entries {
        for use_ in &entry.uses {
            let Some(binding) = reflected.bindings.get(use_.binding) else { continue };
            let found = uses.entry(use_.binding).or_insert(Use {
                binding,
                read: false,
                write: false,
                samplers: Vec::new(),
            });
            found.read |= use_.read;
            found.write |= use_.write;
        }
        for (texture, sampler) in &entry.sampled {
            if let (Some(found), Some(sampler)) = (uses.get_mut(texture), reflected.bindings.get(*sampler)) {
                found.samplers.push(&sampler.name);
            }
        }
    }
    uses.into_values().collect()
}

/// Binds the bindings of one stage, collecting what it touches and depends on.
pub struct Binder<'a> {
    pub plan: &'a Plan,
    pub stage: &'a PlannedStage,
    pub features: &'a BTreeMap<String, Value>,
    pub resources: &'a mut Vec<Resource>,
    pub first_use: &'a mut BTreeMap<ResourceId, Place>,
    pub depends: &'a mut BTreeSet<u32>,
    pub touches: Vec<Touch>,
    /// Formats that the stage's storage textures take from their resources.
    pub formats: BTreeMap<String, TextureFormat>,
    pub problems: Vec<Problem>,
    /// Names in the stage's `bind` that were of use.
    pub used: BTreeSet<String>,
}

impl Binder<'_> {
    /// Where the names of this binding are looked up: a role's module sees its part's scope.
    fn scope(&self, binding: &Binding) -> ScopeId {
        let role = binding.role.as_ref();
        role.and_then(|role| self.plan.module_scope(self.stage, role)).unwrap_or(self.stage.scope)
    }

    pub fn bind(&mut self, use_: &Use<'_>, vertex: bool) -> Option<Bound> {
        let binding = use_.binding;
        match &binding.kind {
            BindingKind::Uniform(layout) if is_engine_uniform(&binding.name) => {
                let filler = Filler { plan: self.plan, stage: self.stage, features: self.features };
                match filler.fill(binding, layout, self.scope(binding), self.depends) {
                    Ok(block) => Some(Bound::Uniform(block)),
                    Err(problems) => {
                        self.problems.extend(problems);
                        None
                    }
                }
            }
            BindingKind::Uniform(_) => {
                self.problems.push(
                    Problem::input(
                        "unknown-uniform",
                        format!("the engine fills no uniform `{}`", binding.name),
                    )
                    .at(&binding.place, "declared here")
                    .suggest(&binding.name, super::uniform::UNIFORMS.into_iter().chain(["scene"])),
                );
                None
            }
            BindingKind::Sampler { comparison } => self.sampler(binding, *comparison).map(Bound::Sampler),
            BindingKind::Storage(layout) if binding.name == "counters" => {
                let fields = layout.element.as_ref().map(|e| &e.fields);
                Some(Bound::Counters(fields.into_iter().flatten().map(|f| f.name.clone()).collect()))
            }
            _ => {
                let reference = self.find(binding)?;
                self.resource(use_, reference, vertex)
            }
        }
    }

    /// The resource behind a binding: the stage's `bind`, then the name itself.
    fn find(&mut self, binding: &Binding) -> Option<Reference> {
        if binding.role.is_none()
            && let Some((reference, _)) = self.stage.bind.get(&binding.name)
        {
            self.used.insert(binding.name.clone());
            return Some(*reference);
        }
        let scope = self.scope(binding);
        let name = self.name(binding);
        if let Some(Named::Resource(reference)) = self.plan.lookup(scope, name) {
            return Some(*reference);
        }
        let at = (&binding.place, "the kernel binds this".to_owned());
        self.problems.push(missing(self.plan, self.stage, scope, name, at));
        None
    }

    /// What a binding is called in its scope: a role's module can have others in stages over what moves.
    fn name<'b>(&'b self, binding: &'b Binding) -> &'b str {
        let module = binding.role.as_ref().and_then(|role| self.plan.modules.get(role));
        let moving = module.filter(|_| self.stage.geometry == Geometry::Moving);
        moving.and_then(|module| module.moving.get(&binding.name)).unwrap_or(&binding.name)
    }

    fn resource(&mut self, use_: &Use<'_>, reference: Reference, vertex: bool) -> Option<Bound> {
        let binding = use_.binding;
        let path = &self.plan.resources.get(reference.resource)?.path;
        if let ResourceKind::Scene = self.plan.resources[reference.resource].kind {
            self.depends.extend(facts::of_scene(path, self.stage.geometry, self.features));
            if let Some(problem) = resource::check_scene_layout(path, &binding.kind, &binding.place) {
                self.problems.push(problem);
                return None;
            }
        }
        let is_texture = matches!(self.resources[reference.resource].shape, Shape::Texture(_));
        let wants_texture = !matches!(binding.kind, BindingKind::Storage(_));
        if is_texture != wants_texture {
            let (is, wants) = if is_texture { ("a texture", "a buffer") } else { ("a buffer", "a texture") };
            self.problems.push(
                Problem::input(
                    "binding-kind",
                    format!("`{path}` is {is}, but `{}` binds {wants}", binding.name),
                )
                .at(&binding.place, "the kernel's declaration")
                .at(&self.plan.resources[reference.resource].place, "the resource")
                .help("declare the two alike, or bind another resource"),
            );
            return None;
        }
        let mut touch = |how| {
            self.touches.push(Touch {
                reference,
                read: use_.read,
                write: use_.write,
                how,
                binding: binding.name.clone(),
            });
        };
        match &binding.kind {
            BindingKind::Storage(layout) => {
                touch(Usage::StorageBuffer);
                let at = (&binding.place, vertex);
                let id = reference.resource;
                match resource::use_buffer(self.plan, self.resources, self.first_use, id, layout, at) {
                    Ok(()) => Some(Bound::Buffer { resource: id, previous: reference.previous }),
                    Err(problem) => {
                        self.problems.push(problem);
                        None
                    }
                }
            }
            BindingKind::Texture { dimension, sample, .. } => {
                touch(Usage::Sampled);
                let filterable = use_.samplers.iter().any(|name| self.filters(binding, name));
                self.fits(binding, reference, *dimension)?;
                self.samples(binding, reference, *sample, filterable)?;
                Some(Bound::Texture { reference, dimension: *dimension, filterable })
            }
            BindingKind::StorageTexture { dimension, access, .. } => {
                touch(Usage::StorageTexture);
                self.fits(binding, reference, *dimension)?;
                if let Shape::Texture(texture) = &self.resources[reference.resource].shape {
                    self.formats.insert(binding.name.clone(), texture.format);
                }
                let one_mip = if reference.mip.is_none() && self.resources[reference.resource].mips > 1 {
                    Reference { mip: Some(0), ..reference }
                } else {
                    reference
                };
                if let Some(last) = self.touches.last_mut() {
                    last.reference = one_mip;
                }
                Some(Bound::StorageTexture { reference: one_mip, dimension: *dimension, access: *access })
            }
            BindingKind::Uniform(_) | BindingKind::Sampler { .. } => None,
        }
    }

    /// The declared dimension must be that of the resource, less the layer that the reference chooses.
    fn fits(&mut self, binding: &Binding, reference: Reference, wants: TextureViewDimension) -> Option<()> {
        let Shape::Texture(texture) = &self.resources[reference.resource].shape else { return None };
        use wgpu_types::TextureDimension as D;
        let is = match (texture.dimension, texture.array && reference.layer.is_none()) {
            (D::D1, _) => TextureViewDimension::D1,
            (D::D2, false) => TextureViewDimension::D2,
            (D::D2, true) => TextureViewDimension::D2Array,
            (D::D3, _) => TextureViewDimension::D3,
        };
        let cube = wants == TextureViewDimension::CubeArray || wants == TextureViewDimension::Cube;
        if is == wants || (cube && is == TextureViewDimension::D2Array) {
            return Some(());
        }
        let planned = &self.plan.resources[reference.resource];
        self.problems.push(
            Problem::input(
                "dimension",
                format!(
                    "`{}` is {}, but the kernel declares `{}` as {}",
                    planned.path,
                    dimension_name(is),
                    binding.name,
                    dimension_name(wants)
                ),
            )
            .at(&binding.place, "the kernel's declaration")
            .at(&planned.place, "the resource")
            .help("the number of sizes gives 1D, 2D or 3D, `layers` an array, `@layer(n)` one layer of it"),
        );
        None
    }

    fn samples(
        &mut self,
        binding: &Binding,
        reference: Reference,
        wants: TextureSampleType,
        filterable: bool,
    ) -> Option<()> {
        let Shape::Texture(texture) = &self.resources[reference.resource].shape else { return None };
        let aspect = texture.format.has_depth_aspect().then_some(TextureAspect::DepthOnly);
        let is = texture.format.sample_type(aspect, Some(wgpu_types::Features::FLOAT32_FILTERABLE));
        use TextureSampleType as T;
        let fits = matches!(
            (is, wants),
            (Some(T::Float { .. }), T::Float { .. })
                | (Some(T::Depth), T::Depth | T::Float { .. })
                | (Some(T::Uint), T::Uint)
                | (Some(T::Sint), T::Sint)
        ) && !(filterable && is == Some(T::Depth) && matches!(wants, T::Float { .. }));
        if fits {
            return Some(());
        }
        let planned = &self.plan.resources[reference.resource];
        let name = format_name(texture.format);
        self.problems.push(
            Problem::input(
                "format",
                format!(
                    "`{}` has the format {name}, which `{}` of kernel `{}` can't read as {}",
                    planned.path,
                    binding.name,
                    self.stage.kernel,
                    match wants {
                        T::Float { .. } => "floats",
                        T::Depth => "depth",
                        T::Sint => "signed integers",
                        T::Uint => "unsigned integers",
                    }
                ),
            )
            .at(&binding.place, "the kernel's declaration")
            .at(&planned.place, "the resource")
            .help(
                "give the resource a format of that kind, or declare another kind of texture in the kernel",
            ),
        );
        None
    }

    fn filters(&self, binding: &Binding, sampler: &str) -> bool {
        use crate::document::Filter;
        match self.plan.lookup(self.scope(binding), sampler) {
            Some(Named::Sampler(s)) => s.filter == Filter::Linear || s.mip_filter == Filter::Linear,
            _ => false,
        }
    }

    fn sampler(&mut self, binding: &Binding, comparison: bool) -> Option<Sampler> {
        let scope = self.scope(binding);
        let Some(Named::Sampler(sampler)) = self.plan.lookup(scope, &binding.name) else {
            let samplers: Vec<&str> = self
                .plan
                .visible(scope)
                .into_iter()
                .filter(|n| matches!(self.plan.lookup(scope, n), Some(Named::Sampler(_))))
                .collect();
            self.problems.push(
                Problem::input(
                    "missing-binding",
                    format!("stage `{}`: no sampler is called `{}`", self.stage.path, binding.name),
                )
                .at(&binding.place, "the kernel binds this")
                .at(&self.stage.kernel_place, "for this stage")
                .help(format!("declare it: `samplers: {{\"{}\": (filter: Linear)}}`", binding.name))
                .suggest(&binding.name, samplers),
            );
            return None;
        };
        if sampler.compare.is_some() != comparison {
            self.problems.push(
                Problem::input(
                    "sampler-kind",
                    format!(
                        "`{}` is declared {} a comparison sampler, but has {}",
                        binding.name,
                        if comparison { "as" } else { "not as" },
                        if comparison { "no `compare`" } else { "a `compare`" }
                    ),
                )
                .at(&binding.place, "the kernel's declaration")
                .help(if comparison {
                    "give the sampler a `compare: Greater`, or declare it as `sampler` in the kernel"
                } else {
                    "take `compare` from the sampler, or declare it as `sampler_comparison` in the kernel"
                }),
            );
            return None;
        }
        Some(sampler.clone())
    }
}

/// There is no resource behind the binding or target `name`; `at` is where the kernel asks for it, and how.
pub fn missing(
    plan: &Plan,
    stage: &PlannedStage,
    scope: ScopeId,
    name: &str,
    at: (&Place, String),
) -> Problem {
    let is_resource = |name: &&str| matches!(plan.lookup(scope, name), Some(Named::Resource(_)));
    let message = format!("stage `{}`: no resource is called `{name}`", stage.path);
    let mut problem = Problem::input("missing-binding", message)
        .at(at.0, at.1)
        .at(&stage.kernel_place, "for this stage")
        .suggest(name, plan.visible(scope).into_iter().filter(is_resource));
    let advice = format!("declare a resource `{name}`, or say `bind: {{\"{name}\": \"…\"}}`");
    problem.help = Some(match problem.help {
        Some(help) => format!("{advice}; {help}"),
        None => advice,
    });
    problem
}

fn dimension_name(dimension: TextureViewDimension) -> &'static str {
    match dimension {
        TextureViewDimension::D1 => "1D",
        TextureViewDimension::D2 => "2D",
        TextureViewDimension::D2Array => "a 2D array",
        TextureViewDimension::Cube => "a cube",
        TextureViewDimension::CubeArray => "a cube array",
        TextureViewDimension::D3 => "3D",
    }
}

/// A format as pipelines write it.
pub fn format_name(format: TextureFormat) -> String {
    serde_json::to_value(format).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
}
