//! How much work a stage has: threads, vertices, what it draws to.

use super::walk::{Around, Walk};
use super::{Condition, DepthUse, Draw, Reference, ScopeId, Threads, Work};
use crate::document::{self, Compute, Depth, ExprText, Extent, Geometry, Raster, Spanned};
use crate::expr::Value;
use crate::problem::Place;
use std::collections::BTreeMap;

/// The first triangle of the geometry, and how many it has; `None` if not known without a scene. The moving ones
/// follow on the still ones.
pub fn triangles(features: &BTreeMap<String, Value>, geometry: Geometry) -> Option<(u64, u64)> {
    let number = |name| match features.get(name)? {
        Value::Number(number) => Some(*number as u64),
        _ => None,
    };
    let (all, still) = (number("scene.triangles")?, || number("scene.still_triangles"));
    Some(match geometry {
        Geometry::All => (0, all),
        Geometry::Still => (0, still()?),
        Geometry::Moving => (still()?, all.saturating_sub(still()?)),
    })
}

impl Walk<'_, '_> {
    pub fn threads(
        &mut self,
        compute: &Compute,
        scope: ScopeId,
        bind: &BTreeMap<String, (Reference, Place)>,
        around: &mut Around,
    ) -> Option<Work> {
        Some(Work::Compute(match &compute.over.value {
            Extent::Texels(text) => match bind.get(&text.value) {
                Some((reference, _)) => Threads::Texels(*reference, text.place.clone()),
                None => Threads::Texels(self.reference(text, scope, around)?, text.place.clone()),
            },
            Extent::Count(counts) => {
                let mut threads = Some([1; 3]);
                for (axis, text) in counts.iter().enumerate() {
                    let count = self.count(text, scope, around);
                    threads = threads.zip(count).map(|(mut threads, count)| {
                        threads[axis] = count;
                        threads
                    });
                }
                Threads::Count(threads)
            }
            Extent::Triangles => {
                Threads::Count(self.triangles(compute.call.geometry, around).map(|count| [count, 1, 1]))
            }
            Extent::Indirect { buffer, offset } => {
                let (reference, offset) = self.indirect(buffer, offset.as_ref(), scope, around)?;
                Threads::Indirect(reference, offset, buffer.place.clone())
            }
        }))
    }

    pub fn draw(&mut self, raster: &Raster, scope: ScopeId, around: &mut Around) -> Option<Draw> {
        Some(match &raster.draw.value {
            document::Draw::Scene => {
                self.triangles(raster.call.geometry, around);
                Draw::Scene
            }
            document::Draw::Screen => Draw::Screen,
            document::Draw::Points(count) => Draw::Points(self.count(count, scope, around)),
            document::Draw::Vertices(count) => Draw::Vertices(self.count(count, scope, around)),
            document::Draw::Indirect { buffer, offset } => {
                let (reference, offset) = self.indirect(buffer, offset.as_ref(), scope, around)?;
                Draw::Indirect(reference, offset, buffer.place.clone())
            }
        })
    }

    /// How many triangles the geometry has; with none of them, the stage's condition fails.
    fn triangles(&self, geometry: Geometry, around: &mut Around) -> Option<u64> {
        let (_, count) = triangles(&self.world.features, geometry)?;
        if count == 0 {
            let which = match geometry {
                Geometry::All => "triangles",
                Geometry::Still => "still triangles",
                Geometry::Moving => "moving triangles",
            };
            let none = Condition::Fails(format!("the scene has no {which}"));
            around.condition = around.condition.and(none);
        }
        (count > 0).then_some(count)
    }

    /// How many threads, points or vertices; with none of them, the stage's condition fails.
    fn count(&self, text: &ExprText, scope: ScopeId, around: &mut Around) -> Option<u64> {
        let count = self.world.whole(text, scope, 0, around.live());
        if count == Some(0) {
            let none = Condition::Fails(format!("count {} is 0", text.value.trim()));
            around.condition = around.condition.and(none);
        }
        count.filter(|count| *count > 0)
    }

    fn indirect(
        &mut self,
        buffer: &Spanned<String>,
        offset: Option<&ExprText>,
        scope: ScopeId,
        around: &Around,
    ) -> Option<(Reference, u64)> {
        let offset = offset.map_or(Some(0), |offset| self.world.whole(offset, scope, 0, around.live()));
        Some((self.reference(buffer, scope, around)?, offset.unwrap_or(0)))
    }

    pub fn depth(&mut self, depth: &Depth, scope: ScopeId, around: &Around) -> Option<DepthUse> {
        Some(DepthUse {
            target: self.reference(&depth.target, scope, around)?,
            place: depth.target.place.clone(),
            compare: depth.compare,
            write: depth.write,
        })
    }
}
