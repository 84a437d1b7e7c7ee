//! Parts: which plays which role, and what names its file declares.

use super::setup::Setup;
use super::world::{LazyResource, Live, World};
use super::{Module, Named, Reference, ResourceId, ScopeId};
use crate::document::{self, Document, Resource, Root, Spanned};
use crate::library::{Library, Shelf};
use crate::problem::{Place, Problem, Problems, Result, Source};
use std::cell::OnceCell;
use std::collections::BTreeMap;

/// What every scene gives, by the names that kernels call it.
pub const SCENE_RESOURCES: [&str; 12] = crate::scene::buffers::NAMES;

/// The modules of all parts, by the names behind `role/`. Two of one name are reported.
pub(super) fn modules(players: &[(&Player, ScopeId)], world: &mut World<'_>) -> BTreeMap<String, Module> {
    let mut modules: BTreeMap<String, Module> = BTreeMap::new();
    for (player, scope) in players {
        for (name, module) in player.modules() {
            let mut found = Module {
                kernel: module.value.clone(),
                role: player.role.clone(),
                part: player.part.clone(),
                about: player.document.about.value.clone(),
                scope: *scope,
                place: module.place.clone(),
                moving: BTreeMap::new(),
                order_dependent: None,
            };
            // What is said of the part's module holds for that of its own role.
            if let Root::Part { moving, order_dependent, .. } = &player.document.root
                && name == player.role
            {
                for (from, to) in moving {
                    world.is_resource(from, *scope);
                    world.is_resource(to, *scope);
                    found.moving.insert(from.value.clone(), to.value.clone());
                }
                found.order_dependent = order_dependent.as_ref().map(|reason| reason.value.clone());
            }
            if let Some(first) = modules.get(name) {
                let problem =
                    Problem::input("duplicate-module", format!("two modules stand behind `role/{name}`"))
                        .at(&module.place, "another here")
                        .at(&first.place, "one here");
                world.report(problem.help("give one of the parts another name for its module"));
                continue;
            }
            modules.insert(name.to_owned(), found);
        }
    }
    modules
}

/// The part that plays a role.
pub(super) struct Player {
    pub role: String,
    /// Its name in the library.
    pub part: String,
    pub document: Document,
}

impl Player {
    pub fn exports(&self) -> &[Spanned<String>] {
        match &self.document.root {
            Root::Part { exports, .. } => exports,
            Root::Pipeline { .. } => &[],
        }
    }

    /// `role/NAME` and the module behind it.
    pub fn modules(&self) -> impl Iterator<Item = (&str, &Spanned<String>)> {
        let (own, further) = match &self.document.root {
            Root::Part { module, modules, .. } => (module.as_ref(), modules.as_slice()),
            Root::Pipeline { .. } => (None, &[][..]),
        };
        let further = further.iter().map(|(name, module)| (name.value.as_str(), module));
        own.map(|module| (self.role.as_str(), module)).into_iter().chain(further)
    }

    pub fn exports_named(&self, name: &str) -> bool {
        self.exports().iter().any(|export| export.value == name)
    }
}

/// Reads the part of each role, in the order of the pipeline.
pub(super) fn players(pipeline: &Document, library: &Library, setup: &Setup) -> Result<Vec<Player>> {
    let Root::Pipeline { parts, .. } = &pipeline.root else {
        let whole = pipeline.source.at(0..pipeline.source.text().len());
        return Err(Problem::input("not-a-pipeline", "this is a part, and only pipelines can be run")
            .at(&whole, "begins with `Part(`")
            .help("put it into a pipeline, under its role in `parts`")
            .into());
    };
    let mut problems = Vec::new();
    let mut named: Vec<(&str, &str, Place)> = parts
        .iter()
        .map(|(role, part)| (role.value.as_str(), part.value.as_str(), part.place.clone()))
        .collect();
    for (role, part) in &setup.parts {
        let source = Source::new("--part", format!("{role}={part}"));
        match named.iter_mut().find(|(known, ..)| known == role) {
            Some(entry) => *entry = (role, part, source.at(role.len() + 1..source.text().len())),
            None => problems.push(
                Problem::input("unknown-role", format!("the pipeline has no role `{role}`"))
                    .at(&source.at(0..role.len()), "put in here")
                    .suggest(role, parts.iter().map(|(role, _)| role.value.as_str())),
            ),
        }
    }
    let mut players = Vec::new();
    for (role, part, place) in named {
        match player(role, part, &place, library) {
            Ok(player) => players.push(player),
            Err(found) => problems.extend(found.iter().cloned()),
        }
    }
    Problems::check(problems)?;
    Ok(players)
}

/// The parts of the library that play `role` and bring a module behind `role/BEHIND`: their names and the module's
/// kernel. What can't be read is passed over.
pub fn with_module(library: &Library, role: &str, behind: &str) -> Vec<(String, String)> {
    let nowhere = Source::new("", "").at(0..0);
    let players = library.list(Shelf::Parts).into_iter();
    let players = players.filter_map(|part| player(role, &part, &nowhere, library).ok());
    let module = |player: Player| {
        let kernel = player.modules().find(|(name, _)| *name == behind)?.1.value.clone();
        Some((player.part, kernel))
    };
    players.filter_map(module).collect()
}

fn player(role: &str, part: &str, place: &Place, library: &Library) -> Result<Player> {
    let source = library.find(Shelf::Parts, part).map_err(|problem| problem.at(place, "put in here"))?;
    let document = document::parse(&source)?;
    match &document.root {
        Root::Part { role: own, .. } if own.value == role => {
            Ok(Player { role: role.to_owned(), part: part.to_owned(), document })
        }
        Root::Part { role: own, .. } => {
            let message = format!("the part `{part}` plays the role `{}`, not `{role}`", own.value);
            Err(Problem::input("wrong-role", message)
                .at(place, format!("put in as `{role}`"))
                .at(&own.place, "its role")
                .into())
        }
        Root::Pipeline { .. } => {
            Err(Problem::input("not-a-part", format!("`{part}` is a pipeline, not a part"))
                .at(place, "put in here")
                .into())
        }
    }
}

impl<'a> World<'a> {
    /// The outermost scope: what the scene gives.
    pub fn scene_scope(&mut self) -> ScopeId {
        let scope = self.add_scope(None);
        let source = Source::new("the scene", SCENE_RESOURCES.join(" "));
        let mut start = 0;
        for name in SCENE_RESOURCES {
            let place = source.at(start..start + name.len());
            start += name.len() + 1;
            let id = self.add_resource(name.to_owned(), &place, None, scope, Live::Yes);
            self.declare(scope, name, Named::Resource(id.into()), &place);
        }
        scope
    }

    /// The scope of a file's own names: all but resources that `private` says are made for each call.
    pub fn file_scope(
        &mut self,
        document: &'a Document,
        prefix: &str,
        parent: ScopeId,
        private: impl Fn(&str) -> bool,
    ) -> ScopeId {
        let scope = self.add_scope(Some(parent));
        self.add_knobs(&document.knobs, prefix, scope);
        for (name, text) in &document.values {
            let path = format!("{prefix}{}", name.value);
            let index = self.add_value(path, name.place.clone(), text, scope);
            self.declare(scope, &name.value, Named::Value(index), &name.place);
        }
        for (name, sampler) in &document.samplers {
            self.declare(scope, &name.value, Named::Sampler(sampler.value.clone()), &name.place);
        }
        for (name, resource) in document.resources.iter().filter(|(name, _)| !private(&name.value)) {
            let id =
                self.add_resource(name.value.clone(), &name.place, Some(&resource.value), scope, Live::Yes);
            self.declare(scope, &name.value, Named::Resource(id.into()), &name.place);
        }
        scope
    }

    /// Reports a name that is no resource where it stands: a module's bindings are found by such names.
    fn is_resource(&mut self, name: &Spanned<String>, scope: ScopeId) {
        if matches!(self.lookup(scope, &name.value), Some(Named::Resource(_))) {
            return;
        }
        let known = super::visible(&self.scopes, scope).into_iter();
        let known = known.filter(|(_, named)| matches!(named, Named::Resource(_))).map(|(name, _)| name);
        let message = format!("no resource `{}` is exported, so that the part's module sees it", name.value);
        let problem = Problem::input("unknown-resource", message).at(&name.place, "named here");
        let problem = problem.suggest(&name.value, known);
        self.report(problem);
    }

    /// Makes what a part exports visible in the pipeline.
    pub fn export(&mut self, player: &Player, from: ScopeId, to: ScopeId) {
        for export in player.exports() {
            match self.scopes[from].names.get(&export.value).cloned() {
                Some(named) => self.declare(to, &export.value, named, &export.place),
                None => {
                    let known = self.scopes[from].names.keys().map(String::as_str);
                    let resources = player.document.resources.iter().map(|(name, _)| name.value.as_str());
                    let message =
                        format!("the part exports `{}`, but has nothing of that name", export.value);
                    let problem =
                        Problem::input("unknown-export", message).at(&export.place, "exported here");
                    self.report(problem.suggest(&export.value, known.chain(resources)));
                }
            }
        }
    }

    pub fn add_resource(
        &mut self,
        path: String,
        place: &Place,
        declared: Option<&'a Resource>,
        scope: ScopeId,
        live: Live,
    ) -> ResourceId {
        let done = OnceCell::new();
        self.resources.push(LazyResource { path, place: place.clone(), declared, scope, live, done });
        self.resources.len() - 1
    }

    /// Gives `name` its meaning in `scope`, where it can have only one.
    pub fn declare(&mut self, scope: ScopeId, name: &str, named: Named, place: &Place) {
        let key = (scope, name.to_owned());
        if let Some(first) = self.declared.get(&key) {
            let problem = Problem::input("duplicate-name", format!("`{name}` is declared twice"))
                .at(place, "again here")
                .at(first, "first here");
            self.report(problem.help("rename one of the two"));
            return;
        }
        self.declared.insert(key, place.clone());
        self.scopes[scope].names.insert(name.to_owned(), named);
    }
}

impl From<ResourceId> for Reference {
    /// All of the resource.
    fn from(resource: ResourceId) -> Self {
        Self { resource, mip: None, layer: None, previous: false }
    }
}
