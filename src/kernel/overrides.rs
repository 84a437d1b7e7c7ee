//! `override` constants: which there are, whether the values given fit them, and the module with them put in.

use super::compose::Composed;
use super::{Override, diagnose};
use crate::problem::{Problem, Problems, Result};
use naga::back::pipeline_constants::{PipelineConstantError, process_overrides};
use naga::valid::ModuleInfo;
use naga::{Expression, Literal, Module, Scalar, ScalarKind, TypeInner};
use std::collections::BTreeMap;

/// The overrides that `module` declares.
pub fn declared(composed: &Composed, module: &Module) -> Vec<Override> {
    let declared = module.overrides.iter().filter_map(|(_, constant)| {
        let name = constant.name.clone()?;
        let default = match constant.init.map(|init| &module.global_expressions[init]) {
            Some(Expression::Literal(literal)) => number(*literal),
            _ => None,
        };
        let about = composed.declarations.get(&name).map(|d| d.declaration.about.clone()).unwrap_or_default();
        Some(Override { place: composed.place_of(&name), name, default, about })
    });
    declared.collect()
}

/// `module` with its overrides as constants. Of `given`, names that the module does not declare are left out; what
/// was taken comes back, so that it can be part of a key. Overrides without any value become `missing`, or else are
/// problems.
pub fn put_in(
    composed: &Composed,
    module: Module,
    info: ModuleInfo,
    given: &BTreeMap<String, f64>,
    missing: Option<f64>,
) -> Result<(Module, ModuleInfo, BTreeMap<String, u64>)> {
    let mut taken = BTreeMap::new();
    let mut constants = naga::back::PipelineConstants::default();
    let mut problems = Vec::new();
    for (_, constant) in module.overrides.iter() {
        let Some(name) = &constant.name else { continue };
        let missing = if constant.init.is_none() { missing } else { None };
        let Some(&value) = given.get(name).or(missing.as_ref()) else {
            if constant.init.is_none() {
                problems.push(
                    Problem::input("override-value", format!("the override `{name}` has no value"))
                        .at(&composed.place_of(name), "it has no default either")
                        .help(format!("give it a default, or declare a knob `{name}`")),
                );
            }
            continue;
        };
        if let TypeInner::Scalar(scalar) = module.types[constant.ty].inner
            && let Some(range) = misfit(value, scalar)
        {
            problems.push(
                Problem::input("override-value", format!("the override `{name}` can't be {value}"))
                    .at(&composed.place_of(name), format!("it holds {range}")),
            );
        }
        taken.insert(name.clone(), value.to_bits());
        constants.insert(constant.id.map_or_else(|| name.clone(), |id| id.to_string()), value);
    }
    Problems::check(problems)?;
    let (module, info) = match process_overrides(&module, &info, None, &constants) {
        Ok((module, info)) => (module.into_owned(), info.into_owned()),
        Err(PipelineConstantError::ValidationError(error)) => {
            return Err(diagnose::invalid(composed, &error).into());
        }
        Err(PipelineConstantError::NegativeWorkgroupSize) => {
            return Err(Problem::input("workgroup-size", "a workgroup size is not above zero")
                .at(&composed.start(), "in an entry point of this kernel")
                .help("it is computed from overrides, that is, from knobs")
                .into());
        }
        Err(error) => {
            return Err(Problem::input("override-value", error.to_string())
                .at(&composed.start(), "when the overrides of this kernel are put in")
                .into());
        }
    };
    Ok((module, info, taken))
}

fn number(literal: Literal) -> Option<f64> {
    match literal {
        Literal::F64(v) | Literal::AbstractFloat(v) => Some(v),
        Literal::F32(v) => Some(f64::from(v)),
        Literal::U32(v) => Some(f64::from(v)),
        Literal::I32(v) => Some(f64::from(v)),
        Literal::Bool(v) => Some(f64::from(u8::from(v))),
        _ => None,
    }
}

/// What a scalar holds, if `value` is nothing of it.
fn misfit(value: f64, scalar: Scalar) -> Option<&'static str> {
    let whole = |low: f64, high: f64| value.fract() == 0.0 && (low..=high).contains(&value);
    let (fits, range) = match (scalar.kind, scalar.width) {
        (ScalarKind::Uint, 4) => (whole(0.0, f64::from(u32::MAX)), "whole numbers from 0 to 4294967295"),
        (ScalarKind::Sint, 4) => {
            (whole(f64::from(i32::MIN), f64::from(i32::MAX)), "whole numbers from -2147483648 to 2147483647")
        }
        (ScalarKind::Bool, _) => (whole(0.0, 1.0), "0 or 1"),
        _ => (value.is_finite() && value.abs() <= f64::from(f32::MAX), "finite numbers"),
    };
    (!fits).then_some(range)
}
