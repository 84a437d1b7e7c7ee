//! The scene's lists as the bytes of storage buffers.

use super::Scene;
use bytemuck::{NoUninit, Zeroable};
use std::borrow::Cow;

/// Names of the built-in storage resources. [`super::layout::layout`] tells their elements.
pub const NAMES: [&str; 12] = [
    "vertices",
    "vertex_extras",
    "triangles",
    "instances",
    "materials",
    "texels",
    "lights",
    "views",
    "environment",
    "emitters",
    "bvh",
    "atlas",
];

impl Scene {
    /// The content of the built-in storage resource `name`. An empty list is one zeroed element, since a binding
    /// can't be empty; kernels take lengths from the scene's numbers, not from the buffer.
    pub fn bytes(&self, name: &str) -> Option<Cow<'_, [u8]>> {
        Some(match name {
            "vertices" => list(&self.vertices),
            "vertex_extras" => list(&self.vertex_extras),
            "triangles" => list(&self.triangles),
            "instances" => list(&self.instances),
            "materials" => list(&self.materials),
            "texels" => list(&self.texels),
            "lights" => list(&self.lights),
            "views" => list(&self.views),
            "environment" => list(self.environment.as_ref().map_or(&[][..], |e| &e.texels)),
            "emitters" => owned(&super::emitters::emitters(self)),
            "bvh" => owned(&super::bvh::words(self)),
            "atlas" => owned(&self.atlas().pairs()),
            _ => return None,
        })
    }
}

fn owned<T: NoUninit + Zeroable>(items: &[T]) -> Cow<'static, [u8]> {
    Cow::Owned(list(items).into_owned())
}

fn list<T: NoUninit + Zeroable>(items: &[T]) -> Cow<'_, [u8]> {
    if items.is_empty() {
        Cow::Owned(bytemuck::bytes_of(&T::zeroed()).to_vec())
    } else {
        Cow::Borrowed(bytemuck::cast_slice(items))
    }
}
