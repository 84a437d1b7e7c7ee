//! Playing a scene: before each frame, what moved is brought to the GPU, and what changed is told to the frame, so that
//! only stages that depend on it run again.

use crate::device::Gpu;
use crate::document::Cause;
use crate::expr::Value;
use crate::frame::Frame;
use crate::graph::facts::{bit, value_bit};
use crate::problem::Result;
use crate::scene::motion::Carried;
use crate::scene::{Camera, Scene};
use std::collections::{BTreeMap, BTreeSet};

/// A scene over time, seen through a camera.
pub struct Play {
    pub scene: Scene,
    camera: Camera,
    /// The scene's camera that is looked through, if it is one of them.
    through: Option<usize>,
    /// Width of the picture over its height.
    aspect: f64,
    values: Vec<Value>,
}

/// What the scene's motion can change: bits as in [`crate::graph::facts`].
pub fn varies(scene: &Scene, camera: usize) -> BTreeSet<u32> {
    let motion = &scene.motion;
    let causes = [
        (Cause::Moving, motion.carries(|c| matches!(c, Carried::Instance(_)))),
        (Cause::Lights, motion.carries(|c| matches!(c, Carried::Light(_)))),
        (Cause::Camera, motion.carries(|c| *c == Carried::Camera(camera))),
    ];
    causes.iter().filter(|(_, varies)| *varies).map(|(cause, _)| bit(*cause)).collect()
}

impl Play {
    /// `frame` was realised with this scene as it is now, seen through its camera of this index.
    pub fn new(scene: Scene, through: usize, size: [u32; 2], frame: &Frame) -> Self {
        let camera = scene.cameras.get(through).cloned().unwrap_or_else(|| Camera::framing(&scene.bounds));
        let values = frame.graph.plan.values.iter().map(|value| value.value.clone()).collect();
        Self {
            scene,
            camera,
            through: Some(through),
            aspect: f64::from(size[0]) / f64::from(size[1]),
            values,
        }
    }

    /// Brings the scene to `time`, in seconds; says which bits changed. A camera of the scene that is looked through
    /// moves with it.
    pub fn go_to(&mut self, frame: &mut Frame, gpu: &Gpu, time: f64) -> Result<BTreeSet<u32>> {
        let moved = self.scene.pose(time);
        let mut changed = BTreeSet::new();
        if moved.geometry {
            frame.update_scene(gpu, &self.scene, "instances");
            frame.update_scene(gpu, &self.scene, "bvh");
            changed.insert(bit(Cause::Moving));
        }
        if moved.lights {
            frame.update_scene(gpu, &self.scene, "lights");
            frame.update_scene(gpu, &self.scene, "views");
            frame.facts().put_views(&self.scene.views);
            changed.insert(bit(Cause::Lights));
        }
        if moved.geometry || moved.lights {
            frame.update_scene(gpu, &self.scene, "emitters");
        }
        if moved.cameras
            && let Some(camera) = self.through.and_then(|index| self.scene.cameras.get(index)).cloned()
        {
            changed.extend(self.see(frame, &camera)?);
        }
        Ok(changed)
    }

    /// Looks through `camera` from now on, which is not the scene's; says which bits changed.
    pub fn look(&mut self, frame: &mut Frame, camera: &Camera) -> Result<BTreeSet<u32>> {
        self.through = None;
        self.see(frame, camera)
    }

    fn see(&mut self, frame: &mut Frame, camera: &Camera) -> Result<BTreeSet<u32>> {
        let mut changed = BTreeSet::new();
        if self.camera == *camera {
            return Ok(changed);
        }
        self.camera = camera.clone();
        frame.facts().put_camera(&camera.uniform(self.aspect));
        changed.insert(bit(Cause::Camera));
        let graph = frame.graph.clone();
        if graph.plan.values.iter().any(|value| value.causes.contains(&Cause::Camera)) {
            let values = graph.plan.values_with(&features(camera))?;
            for (index, value) in values.iter().enumerate() {
                if self.values.get(index) != Some(value) {
                    frame.facts().put_value(index, value);
                    changed.insert(value_bit(index));
                }
            }
            self.values = values;
        }
        Ok(changed)
    }
}

/// What conditions and values can ask about a camera.
pub fn features(camera: &Camera) -> BTreeMap<String, Value> {
    let vector = |v: glam::DVec3| Value::Vector(v.to_array().to_vec());
    BTreeMap::from([
        ("camera.position".to_owned(), vector(camera.position)),
        ("camera.forward".to_owned(), vector(camera.forward)),
    ])
}
