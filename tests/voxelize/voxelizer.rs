//! The voxelizers, run in-process, with payloads of the program and one that counts.

use crate::lattice::Lattice;
use crate::oracle::{self, Rule, Ties, Triangle};
use std::fmt;
use std::path::Path;
use std::sync::OnceLock;
use voxgi::device::{Gpu, LimitSet};
use voxgi::frame::{Changes, Clock, Image};
use voxgi::library::Library;
use voxgi::problem::Problems;
use voxgi::scene::Scene;
use voxgi::session::{Request, prepare};

/// A part of the role `voxelize`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Method {
    part: &'static str,
    /// The knob that says which triangles are small: low enough that scenes here have both sorts.
    cutoff: Option<&'static str>,
}

impl Method {
    const fn new(part: &'static str) -> Self {
        Self { part, cutoff: None }
    }

    const fn with_cutoff(part: &'static str) -> Self {
        Self { part, cutoff: Some("8") }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.part)
    }
}

/// All that fill the same voxels.
pub const METHODS: [Method; 5] = [
    Method::new("voxelize/triangles"),
    Method::new("voxelize/fragments"),
    Method::with_cutoff("voxelize/hybrid"),
    Method::with_cutoff("voxelize/classified"),
    Method::with_cutoff("voxelize/queue"),
];

pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| {
        Gpu::open(None, &LimitSet::Adapter)
            .expect("a Vulkan device: `sh scripts/setup.sh` installs a software one")
    })
}

/// The payload of these tests that counts the fragments of each voxel.
pub const COUNT: &str = "payload/count";

/// A grid, as the program is told of it.
#[derive(Clone, Debug)]
pub struct Grid {
    pub part: &'static str,
    pub knobs: Vec<(&'static str, String)>,
    /// Voxels along each axis that must come out.
    pub size: [i64; 3],
}

impl Grid {
    pub fn cube(resolution: i64) -> Self {
        Self { part: "grid/cube", knobs: vec![("resolution", resolution.to_string())], size: [resolution; 3] }
    }
}

/// Who voxelizes, and how.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    pub method: Method,
    pub payload: &'static str,
    pub rule: Rule,
}

/// The picture `shown` of a pipeline of these tests.
pub fn picture(pipeline: &str, shown: &str, scene: &Scene, grid: &Grid, way: &Way) -> Image {
    let mut sets = vec![("separability".to_owned(), way.rule.separability().to_owned())];
    sets.extend(grid.knobs.iter().map(|(knob, value)| ((*knob).to_owned(), value.clone())));
    sets.extend(way.method.cutoff.map(|cutoff| ("cutoff".to_owned(), cutoff.to_owned())));
    let parts = [("grid", grid.part), ("payload", way.payload), ("voxelize", way.method.part)];
    let parts = parts.map(|(role, part)| (role.to_owned(), part.to_owned())).to_vec();
    let request = Request { pipeline: pipeline.to_owned(), size: [8, 8], sets, parts, ..Request::default() };
    run(&request, shown, scene)
        .unwrap_or_else(|problems| panic!("{way:?}, {grid:?}: {:?}", problems.iter().collect::<Vec<_>>()))
}

/// With the pipelines of `tests/library-voxelize`.
pub fn library() -> Library {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/library-voxelize");
    Library::new(vec![folder]).expect("the library")
}

/// One frame of a pipeline.
pub fn run(request: &Request, shown: &str, scene: &Scene) -> Result<Image, Problems> {
    let library = library();
    let clock = Clock::Wall("for the test".to_owned());
    let mut frame = prepare(request, &library, Some(scene))?.realise(gpu(), scene, clock, None)?;
    frame.run(gpu(), &Changes::All)?;
    let reference = frame.graph.plan.resource(shown)?;
    Ok(frame.read(gpu(), &reference)?)
}

/// How often the voxelizer gave each voxel to [`COUNT`]; of other payloads whether it is filled.
pub fn counted(scene: &Scene, grid: &Grid, way: &Way) -> Vec<u32> {
    let pipeline = if way.payload == COUNT { "counted" } else { "occupancy" };
    let image = picture(pipeline, "occupancy", scene, grid, way);
    let [x, y, z] = grid.size;
    assert_eq!([i64::from(image.width), i64::from(image.height)], [x, y * z], "{grid:?}");
    image.data.into_iter().map(|count| count as u32).collect()
}

/// A scene, and the triangles that it must be voxelized as: in units, not snapped yet.
pub struct Case<'a> {
    pub name: &'a str,
    pub scene: &'a Scene,
    pub grid: &'a Grid,
    pub triangles: &'a [Triangle],
    /// In how many voxels the two rules differ at least: a voxelizer with the wrong one would show.
    pub control: usize,
}

impl Case<'_> {
    /// By all methods and both rules not a voxel more and none less; one of them with the payload of bits too.
    pub fn check(&self) {
        let triangles = oracle::snapped(self.triangles);
        let count = |rule| oracle::count(&triangles, self.grid.size, rule, Ties::Count);
        let exact = Rule::BOTH.map(count);
        for (i, rule) in Rule::BOTH.into_iter().enumerate() {
            let (exact, other) = (&exact[i], &exact[1 - i]);
            assert!(oracle::filled(exact) > 0, "{}: nothing is filled", self.name);
            let bits: Vec<u32> = exact.iter().map(|count| u32::from(*count > 0)).collect();
            for method in METHODS {
                // Bits are written in rows, so that methods go other ways through them.
                for (payload, exact) in [(COUNT, exact), ("payload/bits", &bits)] {
                    let way = Way { method, payload, rule };
                    let counted = counted(self.scene, self.grid, &way);
                    self.agree(&counted, exact, &triangles, &way);
                }
                let control = oracle::differences(exact, other);
                assert!(control >= self.control, "{}: the rules differ in {control} voxels", self.name);
            }
        }
    }

    /// Panics with the first voxel that differs, and the triangles that could be why.
    fn agree(&self, counted: &[u32], exact: &[u32], triangles: &[Triangle], way: &Way) {
        let wrong = oracle::differences(counted, exact);
        let Some(first) = counted.iter().zip(exact).position(|(a, b)| a != b) else { return };
        let [x, y, _] = self.grid.size.map(|n| n as usize);
        let voxel = [first % x, first / x % y, first / (x * y)].map(|i| i as i64);
        let near = triangles.iter().filter(|t| oracle::voxels_around(t, self.grid.size).any(|v| v == voxel));
        let near: Vec<_> = near.take(8).collect();
        panic!(
            "{}, {way:?}, {:?}: {wrong} voxels of {} differ, first {voxel:?}: {} counted, {} exact; near: {near:?}",
            self.name,
            self.grid,
            oracle::filled(exact),
            counted[first],
            exact[first],
        );
    }
}

/// Loose triangles on a lattice, voxelized by all methods.
pub fn check(name: &str, lattice: &Lattice, triangles: &[Triangle], control: usize) {
    let triangles = lattice.fixed(triangles);
    let scene = lattice.scene(&triangles);
    Case { name, scene: &scene, grid: &lattice.grid, triangles: &triangles, control }.check();
}
