//! Motion: nodes that are somewhere else at another time, with what they carry.
//!
//! A node moves if the file animates it, a setting moves it, or its parent moves. What glTF animates is the node's own
//! translation, rotation and scale; what a setting adds comes after that, in the world's axes. Times are in seconds;
//! beyond its last key a motion starts again.

use super::layout::{Instance, Light};
use super::{Camera, is_near, views};
use super::{Scene, bounds::Bounds};
use crate::problem::Place;
use glam::{DMat4, DQuat, DVec3, DVec4};

/// All that moves in a scene. Parents come before their children.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    pub nodes: Vec<MovingNode>,
}

#[derive(Clone, Debug)]
pub struct MovingNode {
    pub parent: Parent,
    /// At rest, apart from the parent.
    pub rest: Pose,
    pub tracks: Vec<Track>,
    pub added: Option<Added>,
    pub carries: Vec<Carried>,
}

#[derive(Clone, Debug)]
pub enum Parent {
    /// Something still: its transform to the world.
    Still(DMat4),
    /// Index of a moving node.
    Moving(usize),
}

/// What a node takes with it, by its index in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    Instance(usize),
    Light(usize),
    Camera(usize),
}

/// A node's own transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pose {
    /// Scale, then rotation, then translation.
    Parts {
        translation: DVec3,
        rotation: DQuat,
        scale: DVec3,
    },
    Matrix(DMat4),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Property {
    Translation,
    Rotation,
    Scale,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
pub enum Interpolation {
    Step,
    #[default]
    Linear,
    /// Cubic Hermite splines with tangents given beside each key: in-tangent, value, out-tangent.
    Spline,
}

/// One property of one node over time.
#[derive(Clone, Debug)]
pub struct Track {
    pub property: Property,
    pub keys: Keys,
    /// Seconds after which it starts again.
    pub duration: f64,
}

/// Values at times that never fall; at least one.
#[derive(Clone, Debug)]
pub struct Keys {
    pub interpolation: Interpolation,
    pub times: Vec<f64>,
    /// One for each time, or three for a spline.
    pub values: Vec<DVec4>,
}

/// Motion that a setting adds: a turn about an axis through `pivot`, then an offset.
#[derive(Clone, Debug)]
pub struct Added {
    /// Unit length.
    pub axis: DVec3,
    pub pivot: DVec3,
    /// (offset, degrees).
    pub keys: Keys,
}

/// Motion that a setting asks for.
#[derive(Clone, Debug)]
pub struct Request {
    /// The node's name in the file.
    pub node: String,
    pub axis: DVec3,
    /// Absent: the node's origin at rest.
    pub pivot: Option<DVec3>,
    pub keys: Keys,
    /// Where the setting names the node.
    pub place: Place,
}

impl Request {
    /// As motion of what stands at `origin`.
    pub fn about(&self, origin: DVec3) -> Added {
        Added { axis: self.axis, pivot: self.pivot.unwrap_or(origin), keys: self.keys.clone() }
    }
}

/// What [`Scene::pose`] changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moved {
    pub geometry: bool,
    pub lights: bool,
    pub cameras: bool,
}

impl Keys {
    /// Seconds from 0 to the last key.
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// The value at `time`, that of the nearest key before the first and after the last. `turn`: values are unit
    /// quaternions.
    fn at(&self, time: f64, turn: bool) -> DVec4 {
        let spline = self.interpolation == Interpolation::Spline;
        let value = |key: usize, part: usize| {
            let index = if spline { 3 * key + part } else { key };
            self.values.get(index).copied().unwrap_or_default()
        };
        let next = self.times.partition_point(|t| *t <= time);
        if next == 0 || next == self.times.len() {
            return value(next.saturating_sub(1), 1);
        }
        let (a, b) = (next - 1, next);
        let length = self.times[b] - self.times[a];
        let s = (time - self.times[a]) / length;
        match self.interpolation {
            Interpolation::Step => value(a, 0),
            Interpolation::Linear if turn => {
                let [from, to] = [value(a, 0), value(b, 0)].map(|v| DQuat::from_vec4(v).normalize());
                DVec4::from(from.slerp(to, s))
            }
            Interpolation::Linear => value(a, 0).lerp(value(b, 0), s),
            Interpolation::Spline => {
                let (s2, s3) = (s * s, s * s * s);
                value(a, 1) * (2.0 * s3 - 3.0 * s2 + 1.0)
                    + value(a, 2) * (length * (s3 - 2.0 * s2 + s))
                    + value(b, 1) * (3.0 * s2 - 2.0 * s3)
                    + value(b, 0) * (length * (s3 - s2))
            }
        }
    }
}

/// The time within a motion that starts again after `duration`. Its very end is still its end.
fn wrapped(time: f64, duration: f64) -> f64 {
    if duration > 0.0 && time > duration { time.rem_euclid(duration) } else { time }
}

impl MovingNode {
    /// The node's own transform at `time`.
    fn local(&self, time: f64) -> DMat4 {
        let (mut translation, mut rotation, mut scale) = match self.rest {
            Pose::Matrix(matrix) => return matrix,
            Pose::Parts { translation, rotation, scale } => (translation, rotation, scale),
        };
        for track in &self.tracks {
            let value = track.keys.at(wrapped(time, track.duration), track.property == Property::Rotation);
            match track.property {
                Property::Translation => translation = value.truncate(),
                Property::Scale => scale = value.truncate(),
                // A spline between opposite quaternions passes through none at all.
                Property::Rotation if value.length() < 1e-9 => {}
                Property::Rotation => rotation = DQuat::from_vec4(value).normalize(),
            }
        }
        DMat4::from_scale_rotation_translation(scale, rotation, translation)
    }
}

impl Added {
    fn matrix(&self, time: f64) -> DMat4 {
        let value = self.keys.at(wrapped(time, self.keys.end()), false);
        let turn = DQuat::from_axis_angle(self.axis, value.w.to_radians());
        DMat4::from_translation(value.truncate() + self.pivot)
            * DMat4::from_quat(turn)
            * DMat4::from_translation(-self.pivot)
    }
}

impl Motion {
    /// The transforms of all moving nodes to the world at `time`.
    pub fn to_world(&self, time: f64) -> Vec<DMat4> {
        let mut all: Vec<DMat4> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let parent = match node.parent {
                Parent::Still(matrix) => matrix,
                Parent::Moving(index) => all.get(index).copied().unwrap_or(DMat4::IDENTITY),
            };
            let to_world = parent * node.local(time);
            all.push(node.added.as_ref().map_or(to_world, |added| added.matrix(time) * to_world));
        }
        all
    }

    /// Seconds until the longest motion starts again; 0 if nothing moves.
    pub fn duration(&self) -> f64 {
        let ends = self.nodes.iter().flat_map(|node| {
            let tracks = node.tracks.iter().map(|track| track.duration);
            tracks.chain(node.added.as_ref().map(|added| added.keys.end()))
        });
        ends.fold(0.0, f64::max)
    }

    /// Whether something of this sort is carried by a node that moves.
    pub fn carries(&self, sort: impl Fn(&Carried) -> bool) -> bool {
        self.nodes.iter().flat_map(|node| &node.carries).any(sort)
    }

    /// Makes room before the scene's lights and cameras for as many others.
    pub fn shift(&mut self, lights: usize, cameras: usize) {
        for carried in self.nodes.iter_mut().flat_map(|node| &mut node.carries) {
            match carried {
                Carried::Light(index) => *index += lights,
                Carried::Camera(index) => *index += cameras,
                Carried::Instance(_) => {}
            }
        }
    }
}

/// Moments at which to look where something gets to: all keys, and points between them.
fn moments(keys: &Keys) -> Vec<f64> {
    /// Points for each key: a turn by less than 180° between two keys stays within 3° of one.
    const BETWEEN: usize = 32;
    /// Of a long recording, the keys are enough.
    const MOST: usize = 1024;
    let parts = (MOST / keys.times.len().max(1)).clamp(1, BETWEEN);
    let between = |pair: &[f64]| {
        let (a, b) = (pair[0], pair[1]);
        (0..parts).map(move |i| a + (b - a) * i as f64 / parts as f64).collect::<Vec<_>>()
    };
    keys.times.windows(2).flat_map(between).chain(keys.times.last().copied()).collect()
}

/// The box around what `matrices` make of a box.
fn swept(bounds: &Cuboid, matrices: impl Iterator<Item = DMat4>) -> Option<Cuboid> {
    let corners = matrices.flat_map(|matrix| bounds.corners().map(|corner| matrix.transform_point3(corner)));
    corners.map(|corner| Cuboid { min: corner, max: corner }).reduce(|a, b| a.union(&b))
}

/// As [`Bounds`], in the precision of transforms.
#[derive(Clone, Copy)]
struct Cuboid {
    min: DVec3,
    max: DVec3,
}

impl Cuboid {
    fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f64, hi: f64| if i >> bit & 1 == 0 { lo } else { hi };
            let (min, max) = (self.min, self.max);
            DVec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
        })
    }
}

impl MovingNode {
    /// Where a box in the node's own space gets to in its parent's, at any time.
    fn lift(&self, bounds: &Cuboid) -> Option<Cuboid> {
        let moments = self.tracks.iter().flat_map(|track| moments(&track.keys)).chain([0.0]);
        swept(bounds, moments.map(|time| self.local(time)))
    }
}

impl Motion {
    /// The box around what moves, at any times of all its motions: `boxes` are those of the nodes, in their own spaces.
    /// A node's box goes up to its parent as the box around all places that its own motion takes it to.
    fn reach(&self, mut boxes: Vec<Option<Cuboid>>) -> Option<Cuboid> {
        let join = |a: &mut Option<Cuboid>, b: Option<Cuboid>| {
            *a = [*a, b].into_iter().flatten().reduce(|a, b| a.union(&b));
        };
        let mut world = None;
        for index in (0..self.nodes.len()).rev() {
            let Some(bounds) = boxes[index] else { continue };
            let node = &self.nodes[index];
            match (&node.parent, &node.added) {
                (Parent::Moving(parent), None) => join(&mut boxes[*parent], node.lift(&bounds)),
                _ => join(&mut world, self.to_world_box(index, bounds)),
            }
        }
        world
    }

    /// A node's box up to the world. What a setting adds is in the world's axes, so its way can't end at the parent.
    fn to_world_box(&self, index: usize, bounds: Cuboid) -> Option<Cuboid> {
        let mut at = Some(index);
        let mut bounds = bounds;
        let mut adds = Vec::new();
        while let Some(node) = at.and_then(|index| self.nodes.get(index)) {
            bounds = node.lift(&bounds)?;
            adds.extend(&node.added);
            at = match &node.parent {
                Parent::Moving(parent) => Some(*parent),
                Parent::Still(matrix) => {
                    bounds = swept(&bounds, std::iter::once(*matrix))?;
                    None
                }
            };
        }
        // What moves a parent comes before what moves its child.
        for added in adds.iter().rev() {
            bounds = swept(&bounds, moments(&added.keys).into_iter().map(|time| added.matrix(time)))?;
        }
        Some(bounds)
    }
}

impl Scene {
    /// Brings still triangles before moving ones.
    pub(super) fn sort_moving(&mut self) {
        let mut moves = vec![false; self.instances.len()];
        for carried in self.motion.nodes.iter().flat_map(|node| &node.carries) {
            if let Carried::Instance(index) = *carried {
                moves[index] = true;
            }
        }
        self.triangles.sort_by_key(|triangle| moves[triangle.instance as usize]);
        self.still_triangles = self.triangles.partition_point(|t| !moves[t.instance as usize]);
    }

    /// Puts all that moves to where it is at `time`, in seconds, and says what that changed. What would go beyond
    /// [`super::FARTHEST`] stays where it was.
    pub fn pose(&mut self, time: f64) -> Moved {
        let mut moved = Moved::default();
        let all = self.motion.to_world(time);
        for (node, to_world) in self.motion.nodes.iter().zip(&all) {
            if !(to_world.as_mat4().is_finite() && is_near(to_world.w_axis.truncate().as_vec3())) {
                continue;
            }
            for carried in &node.carries {
                match *carried {
                    Carried::Instance(index) => {
                        let Some(instance) = self.instances.get_mut(index) else { continue };
                        let new = Instance::placed(to_world, instance.material);
                        moved.geometry |= *instance != new;
                        *instance = new;
                    }
                    Carried::Light(index) => {
                        let Some(light) = self.lights.get_mut(index) else { continue };
                        moved.lights |= move_light(light, to_world);
                    }
                    Carried::Camera(index) => {
                        let Some(camera) = self.cameras.get_mut(index) else { continue };
                        moved.cameras |= move_camera(camera, to_world);
                    }
                }
            }
        }
        if moved.lights {
            self.views = views::fit(&mut self.lights, &self.bounds);
        }
        moved
    }

    /// The box around all triangles at all times; `None` if a corner is beyond [`super::FARTHEST`]. Of what moves, the box
    /// of its mesh is followed.
    pub(super) fn bounds_over_time(&self) -> Option<Bounds> {
        let still = self.world_bounds(0..self.still_triangles)?;
        let moving = self.motion.reach(self.moving_boxes());
        let moving = moving.map(|b| Bounds { min: b.min.as_vec3(), max: b.max.as_vec3() });
        if moving.is_some_and(|bounds| !(is_near(bounds.min) && is_near(bounds.max))) {
            return None;
        }
        let all = [(self.still_triangles > 0).then_some(still), moving];
        Some(all.into_iter().flatten().reduce(|a, b| a.union(&b)).unwrap_or_default())
    }

    /// For each moving node the box of the meshes that it carries, in its own space.
    fn moving_boxes(&self) -> Vec<Option<Cuboid>> {
        let mut of_instance: Vec<Option<Cuboid>> = vec![None; self.instances.len()];
        for triangle in &self.triangles[self.still_triangles..] {
            for corner in [triangle.a, triangle.b, triangle.c] {
                let point = self.vertices[corner as usize].position.as_dvec3();
                let slot = &mut of_instance[triangle.instance as usize];
                let point = Cuboid { min: point, max: point };
                *slot = Some(slot.map_or(point, |bounds| bounds.union(&point)));
            }
        }
        let carried = |node: &MovingNode| {
            let instances = node.carries.iter().filter_map(|carried| match *carried {
                Carried::Instance(index) => of_instance.get(index).copied().flatten(),
                Carried::Light(_) | Carried::Camera(_) => None,
            });
            instances.reduce(|a, b| a.union(&b))
        };
        self.motion.nodes.iter().map(carried).collect()
    }
}

/// Lights stand in the origin of their node and shine along its −z.
fn move_light(light: &mut Light, to_world: &DMat4) -> bool {
    let before = *light;
    if light.kind != super::layout::DIRECTIONAL {
        light.position = to_world.transform_point3(DVec3::ZERO).as_vec3();
    }
    if light.kind != super::layout::POINT
        && let Some(direction) = to_world.transform_vector3(-DVec3::Z).try_normalize()
    {
        light.direction = direction.as_vec3();
    }
    *light != before
}

/// Cameras look along their node's −z with +y up.
fn move_camera(camera: &mut Camera, to_world: &DMat4) -> bool {
    let eye = to_world.transform_point3(DVec3::ZERO);
    let [direction, up] = [-DVec3::Z, DVec3::Y].map(|axis| to_world.transform_vector3(axis));
    let Some(placed) = Camera::looking(&camera.name, eye, direction, up) else { return false };
    let new = Camera { lens: camera.lens, near: camera.near, ..placed };
    let moved = new != *camera;
    *camera = new;
    moved
}
