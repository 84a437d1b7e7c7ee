//! One mesh laid out flat: cut into charts, and these flattened and packed, by the crate uvunwrap.
//!
//! Charts are small, so that they are flattened fast and hardly distorted. Corners are in units of the mesh's largest
//! side. Where the crate gives up, each triangle is a chart of its own, which always works, takes about twice the room,
//! and cuts along every edge.

use super::mesh::Mesh;
use super::shelves::{self, Shelves};
use glam::{DVec2, Vec2};
use uvunwrap::{Density, MeshInput, Options, Packing, Progress};

/// What made it, for [`super::kept`].
pub const UNWRAPPER: &str = "uvunwrap 0.3.0";

/// Triangles of a chart, if all were of the same size; flat regions may have more.
const OF_CHART: f64 = 128.0;
/// How much a triangle's share of the area may differ from that on the surface, as a ratio.
const DISTORTION: f32 = 2.0;
/// Charts are packed with this many texels to the root of the area, and a texel apart at least.
const TEXELS: f64 = 1024.0;
/// The least root of an area, in units, that charts are packed for: what is thin but long needs texels too.
const LEAST: f64 = 1.0 / 8.0;

/// A mesh laid out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Unwrapped {
    /// By triangle; counter-clockwise where it has a place, in one point where it has none.
    pub corners: Vec<[Vec2; 3]>,
    /// Of the rectangle from (0, 0) that holds them all.
    pub size: Vec2,
}

impl Unwrapped {
    /// Moved to (0, 0); what has no place is put there.
    pub fn new(mut corners: Vec<[Vec2; 3]>) -> Self {
        let placed = || corners.iter().filter(|corners| has_area(corners)).flatten();
        let low = placed().copied().reduce(Vec2::min).unwrap_or_default();
        let high = placed().copied().reduce(Vec2::max).unwrap_or_default();
        for triangle in &mut corners {
            *triangle = if has_area(triangle) { triangle.map(|p| p - low) } else { [Vec2::ZERO; 3] };
        }
        Self { corners, size: high - low }
    }

    /// How many triangles have no place.
    pub fn lost(&self) -> usize {
        self.corners.iter().filter(|corners| !has_area(corners)).count()
    }
}

/// Twice the area, positive where the corners run counter-clockwise.
fn doubled_area([a, b, c]: &[Vec2; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| p.as_dvec2());
    (b - a).perp_dot(c - a)
}

fn has_area(corners: &[Vec2; 3]) -> bool {
    doubled_area(corners) > 0.0
}

/// How a mesh of this area and so many triangles is unwrapped.
pub fn options(area: f64, triangles: usize) -> Options {
    let of_chart = area * (OF_CHART / triangles.max(1) as f64);
    Options {
        max_area_distortion: DISTORTION,
        max_chart_area: of_chart as f32,
        density: Density::Fixed {
            texels_per_unit: (TEXELS / area.sqrt().max(LEAST)) as f32,
            page_size: None,
        },
        padding: 1,
        packing: Packing::Fast,
        ..Options::default()
    }
}

/// Lays a mesh out; `watch` is called now and then, with how far it is, from 0 to 1.
pub fn unwrap(mesh: &Mesh, watch: impl Fn(f64) + Sync) -> Unwrapped {
    in_charts(mesh, watch).unwrap_or_else(|| one_by_one(mesh))
}

fn in_charts(mesh: &Mesh, watch: impl Fn(f64) + Sync) -> Option<Unwrapped> {
    let indices = mesh.triangles.as_flattened();
    let input = MeshInput::new(&mesh.positions, indices);
    let step = |step: Progress| {
        if let (uvunwrap::Stage::Parameterizing, Some(total)) = (step.stage, step.total) {
            watch(step.done as f64 / total.max(1) as f64);
        }
        true
    };
    let options = options(mesh.area(), mesh.triangles.len());
    let atlas = uvunwrap::generate_with_progress(&[input], &options, step).ok()?;
    let made = atlas.meshes.first()?;
    let page = DVec2::new(atlas.width.into(), atlas.height.into()) / f64::from(atlas.texels_per_unit);
    let corner = |index: &u32| {
        let place = DVec2::from(made.vertices.get(*index as usize)?.uv.map(f64::from)) * page;
        place.is_finite().then(|| place.as_vec2())
    };
    let corners =
        made.indices.chunks_exact(3).map(|t| Some([corner(&t[0])?, corner(&t[1])?, corner(&t[2])?]));
    let corners: Vec<[Vec2; 3]> = corners.collect::<Option<_>>()?;
    (corners.len() == mesh.triangles.len() && atlas.page_count <= 1).then(|| Unwrapped::new(corners))
}

/// Each triangle on its longest edge, in a rectangle of its own.
pub fn one_by_one(mesh: &Mesh) -> Unwrapped {
    let flat = mesh.triangles.iter().map(|triangle| {
        let corners = mesh.corners(*triangle);
        let length = |from: usize| corners[from].distance(corners[(from + 1) % 3]);
        let from = (0..3).max_by(|a, b| length(*a).total_cmp(&length(*b))).unwrap_or(0);
        let [a, b, c] = [0, 1, 2].map(|i| corners[(from + i) % 3]);
        let Some(along) = (b - a).try_normalize() else { return [DVec2::ZERO; 3] };
        let x = (c - a).dot(along);
        let mut placed = [DVec2::ZERO; 3];
        placed[(from + 1) % 3].x = b.distance(a);
        placed[(from + 2) % 3] = DVec2::new(x, (c - a - along * x).length());
        placed
    });
    let flat: Vec<[DVec2; 3]> = flat.collect();
    let sizes: Vec<DVec2> = flat.iter().map(|t| t[0].max(t[1]).max(t[2])).collect();
    let gap = mesh.area().sqrt() / TEXELS;
    let Shelves { places, .. } = shelves::pack(&sizes, gap);
    let corners = flat.iter().zip(places).map(|(triangle, place)| triangle.map(|p| (p + place).as_vec2()));
    Unwrapped::new(corners.collect())
}
