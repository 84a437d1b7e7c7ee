//! glTF 2.0, `.gltf` and `.glb`.
//!
//! Read are: meshes of triangles, strips and fans with positions, normals, tangents, a set of colours and two sets of
//! texture coordinates (plain, quantized or sparse accessors); node transforms; metallic-roughness materials with their
//! images and texture transforms; alpha masks; punctual lights; cameras; animations of nodes. The rest that a file has is
//! counted in [`Scene::lacks`].
//!
//! A file is never trusted: lengths, indices and numbers are checked where they are used, URIs stay in the file's
//! own folder, and what a small file can blow up to has a limit. All faults that are found are reported, each with
//! the JSON pointer of its place.

mod accessor;
mod animation;
mod budget;
mod census;
mod container;
mod corners;
mod file;
mod lookup;
mod material;
mod mesh;
mod nodes;
mod notes;
pub(super) mod outline;
mod picture;
mod punctual;
mod tangents;
mod texture;
pub(super) mod uri;
mod vertices;

use super::layout::{Instance, Triangle, UNLIT};
use super::motion::{self, Carried};
use super::{Lack, Scene};
use crate::problem::{Problem, Problems, Result};
use file::File;
pub(super) use file::read;
use gltf::json::Root;
use gltf::json::mesh::{Mesh, Primitive, Semantic};
use gltf::json::validation::Checked;
use lookup::Needs;
use mesh::Meshes;
use nodes::{Movers, Placed};
use notes::{Fault, Notes};
use std::path::Path;
use texture::Textures;

/// Most triangles of a scene, each instance counted: 32 million, 512 MiB.
const MOST_TRIANGLES: usize = 1 << 25;

/// Extensions that a file may require: those that are read, and those without which only the looks of surfaces
/// differ, which are counted as lacks.
fn understood(extension: &str) -> bool {
    const NAMES: [&str; 7] = [
        "KHR_lights_punctual",
        "KHR_mesh_quantization",
        "KHR_texture_transform",
        "KHR_texture_basisu",
        "EXT_texture_webp",
        "EXT_texture_avif",
        "MSFT_texture_dds",
    ];
    NAMES.contains(&extension) || extension.starts_with("KHR_materials_")
}

/// The scene in the file at `path`, with the motion that a setting adds; still without views.
pub(super) fn load(path: &Path, added: &[motion::Request]) -> Result<Scene> {
    let mut notes = Notes::new(&path.display().to_string());
    let mut file = File::open(path, &mut notes)?;
    let required = file.root.extensions_required.iter().enumerate();
    for (i, name) in required.filter(|(_, name)| !understood(name)) {
        let fault = Fault::new("gltf-extension", format!("the file requires {name}, which is not read"))
            .help("export it without that extension, or convert it to plain accessors");
        notes.fault(format_args!("/extensionsRequired/{i}"), fault);
    }
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut builder = Builder::new(&file, name, &mut notes);
    let movers = Movers { tracks: animation::tracks(&file, builder.notes), added };
    let (nodes, motion) = nodes::placed(&file.root, movers, builder.notes);
    builder.scene.motion = motion;
    nodes.iter().for_each(|placed| builder.place(placed));
    named(&file.root, &nodes, added)?;
    let Builder { mut scene, used, meshes, .. } = builder;
    (scene.vertices, scene.vertex_extras) = meshes.finish();
    scene.sort_moving();
    let mut textures = Textures::default();
    let materials = std::mem::take(&mut file.root.materials);
    for (i, (json, material)) in materials.iter().zip(&mut scene.materials).enumerate() {
        if used[i] {
            let pointer = format!("/materials/{i}");
            material::finish(material, json, &pointer, &mut file, &mut textures, &mut notes);
        }
    }
    (scene.images, scene.texels) = textures.decode(&file, &mut notes);
    scene.files = file.read;
    match scene.bounds_over_time() {
        Some(bounds) => scene.bounds = bounds,
        None => notes.fault("/nodes", Fault::new("gltf-value", "the scene reaches farther than 10¹⁸ m")),
    }
    scene.lacks = notes.finish()?;
    for name in file.root.extensions_used.iter().filter(|name| !understood(name)) {
        if !scene.lacks.iter().any(|lack| lack.what.contains(name)) {
            let what = format!("extension {name}");
            scene.lacks.push(Lack { what, count: 1, instead: "not read".to_owned() });
        }
    }
    Ok(scene)
}

/// Every node that a setting moves must be one of the scene.
fn named(root: &Root, nodes: &[Placed], added: &[motion::Request]) -> Result<()> {
    let known = || nodes.iter().filter_map(|placed| root.nodes[placed.index].name.as_deref());
    let missing = added.iter().filter(|request| !known().any(|name| name == request.node));
    let twice =
        added.iter().enumerate().filter(|(i, r)| added[..*i].iter().any(|other| other.node == r.node));
    let twice = twice.map(|(_, request)| {
        Problem::input("setting-node", format!("the node {:?} is moved twice", request.node))
            .at(&request.place, "again here")
            .help("put all keys into one motion")
    });
    let problem = |request: &motion::Request| {
        Problem::input("setting-node", format!("the scene has no node {:?}", request.node))
            .at(&request.place, "moved here")
            .suggest(&request.node, known())
    };
    Problems::check(missing.map(problem).chain(twice).collect()).map(|_| ())
}

struct Builder<'a> {
    file: &'a File,
    notes: &'a mut Notes,
    scene: Scene,
    meshes: Meshes,
    /// For each material whether a primitive has it; the last one is the default material, which is not yet there.
    used: Vec<bool>,
    /// What each of them takes from vertices.
    needs: Vec<Needs>,
}

impl<'a> Builder<'a> {
    fn new(file: &'a File, name: String, notes: &'a mut Notes) -> Self {
        let root = &file.root;
        let read = |(i, json)| material::read(json, &format!("/materials/{i}"), notes);
        let materials: Vec<_> = root.materials.iter().enumerate().map(read).collect();
        let used = vec![false; materials.len() + 1];
        let mut needs: Vec<Needs> =
            root.materials.iter().map(|json| Needs::of(&lookup::lookups(json))).collect();
        needs.push(Needs::default());
        let scene = Scene { name, materials, ..Scene::default() };
        Self { file, notes, scene, meshes: Meshes::default(), used, needs }
    }

    /// Adds what a node carries.
    fn place(&mut self, placed: &Placed) {
        let root = &self.file.root;
        if let Some(light) = punctual::light(root, placed, self.notes) {
            self.carry(placed, Carried::Light(self.scene.lights.len()));
            self.scene.lights.push(light);
        }
        if let Some(camera) = punctual::camera(root, placed, self.notes) {
            self.carry(placed, Carried::Camera(self.scene.cameras.len()));
            self.scene.cameras.push(camera);
        }
        let Some(index) = placed.node.mesh.map(|mesh| mesh.value()) else { return };
        let Some(mesh) = root.meshes.get(index) else {
            let pointer = format!("/nodes/{}/mesh", placed.index);
            return self.notes.fault(pointer, Fault::beyond("mesh", index, root.meshes.len()));
        };
        if !placed.to_world.as_mat4().is_finite() {
            let fault =
                Fault::new("gltf-value", "with its parents, the transform is beyond what a float can hold");
            return self.notes.fault(format_args!("/nodes/{}", placed.index), fault);
        }
        if placed.node.skin.is_some() {
            self.notes.lack("skinned mesh", "drawn at rest");
        }
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            if self.notes.is_full() {
                return;
            }
            if let Err(fault) = self.place_primitive(placed, mesh, (index, i), primitive) {
                self.notes.fault(format_args!("/meshes/{index}/primitives/{i}"), fault);
            }
        }
    }

    fn carry(&mut self, placed: &Placed, carried: Carried) {
        if let Some(node) = placed.moving.and_then(|index| self.scene.motion.nodes.get_mut(index)) {
            node.carries.push(carried);
        }
    }

    /// `at`: indices of the mesh and of the primitive in it.
    fn place_primitive(
        &mut self,
        placed: &Placed,
        mesh: &Mesh,
        at: (usize, usize),
        primitive: &Primitive,
    ) -> Result<(), Fault> {
        self.file.budget.hold(size_of::<Instance>() as u64)?;
        let materials = self.file.root.materials.len();
        let material = primitive.material.map_or(materials, |material| material.value());
        let needs = match self.needs.get(material) {
            Some(needs) if primitive.material.is_none() || material < materials => needs,
            _ => return Err(Fault::beyond("material", material, materials)),
        };
        let before = self.meshes.bytes();
        let Some(corners) = self.meshes.part(self.file, mesh, at, needs, self.notes) else { return Ok(()) };
        let new = self.meshes.bytes() - before + corners.len() * size_of::<Triangle>();
        self.file.budget.hold(new as u64)?;
        if self.scene.triangles.len() + corners.len() > MOST_TRIANGLES {
            return Err(Fault::new(
                "gltf-size",
                format!("the scene has more than {MOST_TRIANGLES} triangles"),
            ));
        }
        if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
            self.notes.lack("morphed primitive", "drawn at rest");
        }
        let colors = primitive.attributes.contains_key(&Checked::Valid(Semantic::Colors(0)));
        let unlit = self.scene.materials.get(material).is_some_and(|m| m.flags & UNLIT != 0);
        if colors && unlit {
            self.notes.lack("set of vertex colours of an unlit surface", "left out");
        }
        self.used[material] = true;
        if material == self.scene.materials.len() {
            self.scene.materials.push(material::default());
        }
        let instance = self.scene.instances.len() as u32;
        self.carry(placed, Carried::Instance(instance as usize));
        self.scene.instances.push(Instance::placed(&placed.to_world, material as u32));
        self.scene.triangles.extend(corners.iter().map(|[a, b, c]| Triangle {
            a: *a,
            b: *b,
            c: *c,
            instance,
        }));
        Ok(())
    }
}
