//! Names that kernels want from the module behind a role, and that the part in that role does not bring while others
//! of the library do. That is no mistake in the kernel, where the name is unknown: it is the choice of a part.

use crate::kernel::{Composed, declares, undefined};
use crate::library::Library;
use crate::plan::{Module, Plan, with_module};
use crate::problem::{Place, Problem, Problems};
use std::collections::BTreeMap;

/// A name behind `role/`, and the parts whose modules there have what is wanted.
type Bringers = (String, Vec<String>);

/// What is wanted and where, by who would bring it.
#[derive(Debug, Default)]
pub struct Missing(BTreeMap<Bringers, Vec<(String, Place)>>);

impl Missing {
    /// Takes what is missing out of the problems of a stage's kernel; the others are handed back.
    pub fn sort(
        &mut self,
        found: &Problems,
        composed: &Composed,
        plan: &Plan,
        library: &Library,
    ) -> Vec<Problem> {
        let imported = |behind: &str| composed.segments.iter().any(|s| s.role.as_deref() == Some(behind));
        let mut others = Vec::new();
        for problem in found.iter() {
            let brought = undefined(problem).and_then(|(name, place)| {
                let mut modules = plan.modules.iter().filter(|(behind, _)| imported(behind));
                let key = modules.find_map(|(behind, module)| {
                    let parts = bringing(library, behind, module, name);
                    (!parts.is_empty()).then(|| (behind.clone(), parts))
                })?;
                Some((key, (name.to_owned(), place.clone())))
            });
            match brought {
                Some((key, wanted)) => {
                    let all = self.0.entry(key).or_default();
                    // Elements of a loop share a kernel.
                    if !all.contains(&wanted) {
                        all.push(wanted);
                    }
                }
                None => others.push(problem.clone()),
            }
        }
        others
    }

    /// A problem for all that the same parts have.
    pub fn problems(self, plan: &Plan) -> impl Iterator<Item = Problem> {
        self.0.into_iter().filter_map(|((behind, parts), wanted)| {
            Some(problem(&behind, plan.modules.get(&behind)?, &parts, &wanted))
        })
    }
}

/// The other parts of the role whose modules have the name. None if the module itself has it under a condition: then
/// it is that condition which takes it away.
fn bringing(library: &Library, behind: &str, module: &Module, name: &str) -> Vec<String> {
    if declares(library, &module.kernel, name) {
        return Vec::new();
    }
    let parts = with_module(library, &module.role, behind).into_iter();
    parts.filter(|(_, kernel)| declares(library, kernel, name)).map(|(part, _)| part).collect()
}

fn problem(behind: &str, module: &Module, parts: &[String], wanted: &[(String, Place)]) -> Problem {
    let mut names: Vec<&str> = wanted.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let Module { role, part, about, .. } = module;
    let message = format!("the part `{part}` does not bring {} behind `role/{behind}`", quoted(names));
    let problem = wanted.iter().fold(Problem::input("part-lacks", message), |problem, (name, place)| {
        problem.at(place, format!("`{name}` is needed here"))
    });
    let choice = match parts {
        [only] => format!("the part `{only}` does: choose it with `--part {role}={only}`"),
        _ => format!("these parts do: {}; choose one with `--part {role}=…`", quoted(parts)),
    };
    problem.at(&module.place, "its module").help(format!("{choice}\n`{part}` is this: {about}"))
}

fn quoted<T: std::fmt::Display>(names: impl IntoIterator<Item = T>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
