//! Settings: RON files that name a glTF file and add lights, cameras, motion and an environment to it.
//!
//! ```ron
//! Setting(
//!     gltf: "hall.glb",
//!     about: "The hall at noon.",
//!     licence: "CC BY 4.0, by its author",
//!     get: "npm pack hall",
//!     cameras: [(name: "nave", eye: (-15, -10, 0), look_at: (5, -8, 0), fov_degrees: 65)],
//!     lights: [
//!         Point(position: (0, 2, 0), intensity: (10, 10, 10)),
//!         Spot(position: (0, 2, 0), direction: (0, -1, 0), intensity: (10, 10, 10), inner_degrees: 20, outer_degrees: 30),
//!         Directional(direction: (0.3, -1, 0.2), irradiance: (10, 10, 10)),
//!         Point(position: (1, 2, 0), intensity: (10, 10, 10), motion: (keys: [(time: 0), (time: 4, offset: (0, 0, 2))])),
//!     ],
//!     environment: Picture(file: "noon.hdr", strength: 2, turn_degrees: 90),
//!     motion: [(node: "door", axis: (0, 1, 0), pivot: (1, 0, 0), keys: [(time: 0), (time: 2, degrees: 90)])],
//! )
//! ```
//!
//! The file is looked for beside the setting and below, then likewise in the folder that the environment variable
//! `VOXGI_SCENES` names. `fov_degrees` is the full vertical angle, the degrees of a spot are half angles of its
//! light, a direction is the one in which light travels. Motion is a turn of `degrees` about the `axis` through the
//! `pivot`, then an `offset`, after the file's own motion and in the world's axes; the pivot is the node's origin, or the
//! light's position, unless given. Keys are joined by straight lines, or with `interpolation: Step` hold until the next;
//! after the last the motion starts again. The setting's lights and cameras come before the file's.
//! An environment is `Constant(radiance: (1, 1, 1))`, or a picture of all directions (.hdr, .exr) looked for like the
//! glTF file; [`super::environment`] says what lies where in it.
//! `about`, `licence` and `get` are for people: what the model is, whose, and how one comes by it.

use super::camera::{Camera, Lens};
use super::course::{self, Course, Key, Steps};
use super::environment::Environment;
use super::gltf;
use super::layout::Light;
use super::motion::Request;
use super::{Scene, lights};
use crate::problem::ron::RonFile;
use crate::problem::{Place, Problem, Problems, Result, Source};
use glam::{DVec3, Vec3};
use ron::value::RawValue;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The environment variable that names the folder of scenes kept elsewhere.
pub const SCENES: &str = "VOXGI_SCENES";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Setting<'a> {
    #[serde(borrow)]
    gltf: &'a RawValue,
    #[serde(borrow, default)]
    cameras: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    lights: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    motion: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    environment: Option<&'a RawValue>,
    #[serde(default)]
    about: String,
    #[serde(default)]
    licence: String,
    #[serde(default)]
    get: String,
}

/// What a setting says for people, and what it names. Texts may be empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct About {
    pub about: String,
    pub licence: String,
    /// How one comes by the model.
    pub get: String,
    /// The model as the setting names it.
    pub gltf: String,
    /// The model's file; `None` if it is not there.
    pub model: Option<PathBuf>,
    /// How many lights and cameras the setting adds.
    pub lights: usize,
    pub cameras: usize,
}

/// Largest setting that is read, in bytes: 1 MiB.
const MOST_BYTES: u64 = 1 << 20;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraEntry {
    name: String,
    eye: [f64; 3],
    look_at: [f64; 3],
    fov_degrees: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum LightEntry {
    Point {
        position: [f64; 3],
        intensity: [f32; 3],
        #[serde(default)]
        motion: Option<Course>,
    },
    Spot {
        position: [f64; 3],
        direction: [f64; 3],
        intensity: [f32; 3],
        inner_degrees: f64,
        outer_degrees: f64,
        #[serde(default)]
        motion: Option<Course>,
    },
    Directional {
        direction: [f64; 3],
        irradiance: [f32; 3],
        #[serde(default)]
        motion: Option<Course>,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MotionEntry {
    node: String,
    #[serde(default = "course::up")]
    axis: [f64; 3],
    #[serde(default)]
    pivot: Option<[f64; 3]>,
    #[serde(default)]
    interpolation: Steps,
    keys: Vec<Key>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum EnvironmentEntry {
    Constant {
        radiance: [f32; 3],
    },
    Picture {
        file: String,
        #[serde(default = "one")]
        strength: f32,
        #[serde(default)]
        turn_degrees: f32,
    },
}

fn one() -> f32 {
    1.0
}

/// What the setting at `path` says about itself. It need not be right in what it adds.
pub(super) fn about(path: &Path) -> Result<About> {
    let source = read(path)?;
    let setting: Setting = source.parse()?;
    let gltf = source.value::<String>(setting.gltf)?;
    let model = candidates(&gltf, &source.place(setting.gltf), path)?.into_iter().find(|path| path.is_file());
    let (lights, cameras) = (setting.lights.len(), setting.cameras.len());
    let Setting { about, licence, get, .. } = setting;
    Ok(About { about, licence, get, gltf, model, lights, cameras })
}

/// The scene of the setting at `path`, still without views.
pub(super) fn load(path: &Path) -> Result<Scene> {
    let source = read(path)?;
    let setting: Setting = source.parse()?;
    let mut problems = Vec::new();
    let mut keep = |problem| problems.push(problem);
    let cameras: Vec<Camera> =
        setting.cameras.iter().filter_map(|raw| camera(&source, raw).map_err(&mut keep).ok()).collect();
    let lights: Vec<(Light, Option<Request>)> =
        setting.lights.iter().filter_map(|raw| light(&source, raw).map_err(&mut keep).ok()).collect();
    let motion: Vec<Request> =
        setting.motion.iter().filter_map(|raw| motion(&source, raw).map_err(&mut keep).ok()).collect();
    let environment = setting.environment.map(|raw| environment(&source, raw, path).map_err(&mut keep).ok());
    let model = model(&source, &setting, path);
    problems.extend(model.as_ref().err().cloned());
    Problems::check(problems)?;
    let mut scene = gltf::load(&model?, &motion)?;
    scene.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    scene.files.insert(0, path.to_path_buf());
    if let Some((environment, file)) = environment.flatten() {
        scene.environment = Some(environment);
        scene.files.extend(file);
    }
    let near = (scene.bounds.diagonal() * 1e-4).max(1e-6);
    scene.cameras.splice(0..0, cameras.into_iter().map(|camera| Camera { near, ..camera }));
    scene.motion.shift(lights.len(), setting.cameras.len());
    for (index, (light, request)) in lights.iter().enumerate() {
        scene.motion.nodes.extend(request.as_ref().map(|request| course::carrying(index, light, request)));
    }
    scene.lights.splice(0..0, lights.into_iter().map(|(light, _)| light));
    Ok(scene)
}

fn read(path: &Path) -> Result<RonFile> {
    let name = path.display().to_string();
    let wrong = |why: &str| Problem::input("setting", format!("`{name}` is no setting: {why}"));
    if path.metadata().is_ok_and(|metadata| metadata.len() > MOST_BYTES) {
        return Err(wrong("it is larger than 1 MiB").into());
    }
    let text = String::from_utf8(gltf::read(path)?).map_err(|_| wrong("it is not UTF-8"))?;
    Ok(RonFile { source: Source::new(name, text), code: "setting", what: "the setting" })
}

/// Where the file may be that the setting at `path` names, the best place first; `place` is where it does.
fn candidates(name: &str, place: &Place, path: &Path) -> Result<Vec<PathBuf>, Problem> {
    let Some(relative) = gltf::uri::inside(name) else {
        return Err(Problem::input(
            "setting-file",
            format!("{name:?} is not a path below the setting's folder"),
        )
        .at(place, "absolute, or leads out")
        .help(format!("name a file beside the setting, or in the folder of {SCENES}, without `..`")));
    };
    let beside = path.parent().map(|folder| folder.join(&relative));
    let elsewhere = std::env::var_os(SCENES).map(|folder| Path::new(&folder).join(&relative));
    Ok(beside.into_iter().chain(elsewhere).collect())
}

/// The glTF file that the setting at `path` names.
fn model(source: &RonFile, setting: &Setting, path: &Path) -> Result<PathBuf, Problem> {
    let place = source.place(setting.gltf);
    let name: String = source.value(setting.gltf)?;
    let found = candidates(&name, &place, path)?.into_iter().find(|path| path.is_file());
    found.ok_or_else(|| {
        let message = format!("there is no {} beside the setting, nor in {SCENES}", place.text());
        let help = match setting.get.as_str() {
            "" => format!("set {SCENES} to the folder that has it"),
            get => format!("set {SCENES} to the folder that has it; to get it: {get}"),
        };
        Problem::input("setting-file", message).at(&place, "not found").help(help)
    })
}

/// The environment, and the file that it is in.
fn environment(
    source: &RonFile,
    raw: &RawValue,
    path: &Path,
) -> Result<(Environment, Option<PathBuf>), Problem> {
    let at = source.place(raw);
    let wrong = |message: String| Problem::input("setting-value", message).at(&at, "this environment");
    match source.value(raw)? {
        EnvironmentEntry::Constant { radiance } => {
            Ok((Environment::constant(Vec3::from(radiance)).map_err(wrong)?, None))
        }
        EnvironmentEntry::Picture { file, strength, turn_degrees } => {
            if !(strength >= 0.0 && strength.is_finite() && turn_degrees.is_finite()) {
                return Err(wrong("`strength` must be 0 or more, and `turn_degrees` finite".to_owned()));
            }
            let found = candidates(&file, &at, path)?.into_iter().find(|path| path.is_file());
            let found = found.ok_or_else(|| {
                let message = format!("there is no {file:?} beside the setting, nor in {SCENES}");
                Problem::input("setting-file", message)
                    .at(&at, "not found")
                    .help(format!("set {SCENES} to the folder that has it"))
            })?;
            let read = Environment::read(&found, strength);
            let read = read.map_err(|why| wrong(format!("{file:?} gives no environment: {why}")))?;
            Ok((Environment { turn: turn_degrees.to_radians(), ..read }, Some(found)))
        }
    }
}

fn camera(source: &RonFile, raw: &RawValue) -> Result<Camera, Problem> {
    let entry: CameraEntry = source.value(raw)?;
    let wrong =
        |message: &str| Problem::input("setting-value", message).at(&source.place(raw), "this camera");
    if !(entry.fov_degrees > 0.0 && entry.fov_degrees < 180.0) {
        return Err(wrong("`fov_degrees` must be between 0 and 180"));
    }
    let (eye, look_at) = (DVec3::from(entry.eye), DVec3::from(entry.look_at));
    if !(eye.as_vec3().is_finite() && look_at.as_vec3().is_finite()) {
        return Err(wrong("`eye` and `look_at` must be finite"));
    }
    let camera = Camera::looking(&entry.name, eye, look_at - eye, DVec3::Y);
    let camera = camera.ok_or_else(|| wrong("`eye` and `look_at` are the same point"))?;
    let lens = Lens::Perspective { vertical_fov: entry.fov_degrees.to_radians() };
    let camera = Camera { lens, ..camera };
    match camera.is_usable() {
        true => Ok(camera),
        false => Err(wrong("the numbers are beyond what a float can hold")),
    }
}

fn light(source: &RonFile, raw: &RawValue) -> Result<(Light, Option<Request>), Problem> {
    let (light, course) = match source.value(raw)? {
        LightEntry::Point { position, intensity, motion } => {
            (lights::point(position.into(), Vec3::from(intensity)), motion)
        }
        LightEntry::Spot { position, direction, intensity, inner_degrees, outer_degrees, motion } => {
            let [inner, outer] = [inner_degrees, outer_degrees].map(f64::to_radians);
            let intensity = Vec3::from(intensity);
            (lights::spot(position.into(), direction.into(), intensity, inner, outer), motion)
        }
        LightEntry::Directional { direction, irradiance, motion } => {
            (lights::directional(direction.into(), Vec3::from(irradiance)), motion)
        }
    };
    let at = source.place(raw);
    let wrong = |message: String| Problem::input("setting-value", message).at(&at, "this light");
    let request = course
        .map(|course| course::request(String::new(), course, at.clone()).map_err(&wrong))
        .transpose()?;
    Ok((light.map_err(&wrong)?, request))
}

fn motion(source: &RonFile, raw: &RawValue) -> Result<Request, Problem> {
    let MotionEntry { node, axis, pivot, interpolation, keys } = source.value(raw)?;
    let at = source.place(raw);
    course::request(node, Course { axis, pivot, interpolation, keys }, at.clone())
        .map_err(|message| Problem::input("setting-value", message).at(&at, "this motion"))
}
