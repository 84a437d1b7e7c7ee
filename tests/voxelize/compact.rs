//! The payload that keeps the sums of filled voxels only, against the one that keeps those of all: the same words.

use crate::lattice::Lattice;
use crate::model::{Model, Part};
use crate::oracle::{Rule, Triangle, VOXEL, differences};
use crate::random::{Region, hardened};
use crate::voxelizer::{COUNT, METHODS, Way, counted, gpu};
use fastrand::Rng;
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use serde_json::json;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use voxgi::frame::{Changes, Clock, Frame};
use voxgi::library::Library;
use voxgi::play::Play;
use voxgi::scene::atlas::Atlas;
use voxgi::scene::{self, Scene};
use voxgi::session::{Request, prepare};

/// A part of the role `voxelize`, and its knobs: such that there are small triangles and large ones.
type Voxelizer = (&'static str, &'static [(&'static str, &'static str)]);

const VOXELIZERS: [Voxelizer; 7] = [
    ("voxelize/triangles", &[]),
    ("voxelize/triangles", &[("separability", "26")]),
    ("voxelize/fragments", &[]),
    ("voxelize/hybrid", &[("cutoff", "8")]),
    ("voxelize/classified", &[("cutoff", "8")]),
    ("voxelize/queue", &[("cutoff", "8")]),
    ("voxelize/atlas", &[]),
];

const SUMS: &str = "payload/sums";
const COMPACT: &str = "payload/compact";

fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

pub fn request(pipeline: &str, payload: &str, (voxelize, knobs): Voxelizer) -> Request {
    let parts = [("payload", payload), ("voxelize", voxelize)];
    Request {
        pipeline: pipeline.to_owned(),
        size: [32, 32],
        sets: knobs.iter().map(|(knob, value)| ((*knob).to_owned(), (*value).to_owned())).collect(),
        parts: parts.map(|(role, part)| (role.to_owned(), part.to_owned())).to_vec(),
        ..Request::default()
    }
}

pub fn set(mut request: Request, knob: &str, value: impl ToString) -> Request {
    request.sets.push((knob.to_owned(), value.to_string()));
    request
}

pub fn start(request: &Request, scene: &Scene) -> Frame {
    let library = Library::new(vec![root("tests/library-voxelize")]).expect("the tests' library");
    let clock = Clock::Wall("for the test".to_owned());
    let prepared = prepare(request, &library, Some(scene));
    prepared
        .and_then(|prepared| prepared.realise(gpu(), scene, clock, None))
        .unwrap_or_else(|problems| panic!("{request:?}: {:?}", problems.iter().collect::<Vec<_>>()))
}

pub fn words_of(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]])).collect()
}

/// What all stages together counted in the last frame.
pub fn counter(frame: &Frame, name: &str) -> u64 {
    let counters = frame.counters(gpu()).expect("counters");
    let counts =
        counters.iter().filter(|(path, _)| path.rsplit_once('.').is_some_and(|(_, own)| own == name));
    counts.map(|(_, count)| u64::from(*count)).sum()
}

/// What a payload holds after a frame.
struct Held {
    /// Of all voxels, as `role/voxels` reads them: still and moving ones together.
    words: Vec<u32>,
    /// The bits of what is still, and of what moves where something does, below their summaries.
    filled: [Vec<u32>; 2],
    without_room: u64,
}

impl Held {
    fn by(frame: &mut Frame) -> Self {
        frame.run(gpu(), &Changes::All).expect("a frame");
        let plan = &frame.graph.plan;
        let image = frame.read(gpu(), &plan.resource("words").expect("a picture")).expect("the picture");
        let buffer = |name| {
            let resource = plan.resource(name).expect("a buffer").resource;
            frame.read_buffer(gpu(), resource).map_or(Vec::new(), |bytes| words_of(&bytes))
        };
        Self {
            words: words_of(&image.bytes),
            filled: ["filled", "moving_filled"].map(buffer),
            without_room: counter(frame, "fragments_without_room"),
        }
    }

    fn of(request: &Request, scene: &Scene) -> Self {
        Self::by(&mut start(request, scene))
    }

    /// How many voxels still triangles fill, and moving ones.
    fn filled(&self) -> [u32; 2] {
        self.filled.each_ref().map(|words| words[words.len() / 33..].iter().map(|w| w.count_ones()).sum())
    }
}

/// Random texels, the half of them holes.
fn image(rng: &mut Rng) -> Vec<u8> {
    const SIDE: u32 = 16;
    let texels: Vec<u8> = (0..SIDE * SIDE)
        .flat_map(|_| [rng.u8(..), rng.u8(..), rng.u8(..), if rng.bool() { 255 } else { 0 }])
        .collect();
    let mut file = Vec::new();
    PngEncoder::new(&mut file).write_image(&texels, SIDE, SIDE, ExtendedColorType::Rgba8).expect("a picture");
    file
}

/// Small and large triangles, some of them hard.
fn crowd(lattice: &Lattice, rng: &mut Rng) -> Vec<Triangle> {
    // Off the scene's bounds, so that what moves stays in the grid.
    let [low, high] = [lattice.low.map(|x| x + 6 * VOXEL), lattice.high.map(|x| x - 6 * VOXEL)];
    let region = Region { low, high };
    let mut some = |number, voxels: i64, step| region.triangles(rng, number, voxels * VOXEL, step);
    [some(600, 2, 1), some(30, 12, 2), hardened(some(200, 4, 512), 512)].concat()
}

/// One part is plain.
fn plain(lattice: &Lattice) -> Model {
    let triangles = crowd(lattice, &mut Rng::with_seed(31));
    Model { parts: vec![lattice.part(&lattice.fixed(&triangles))], ..Model::default() }
}

/// Parts that emit, that have an image and holes, and that have that and move.
fn motley(lattice: &Lattice) -> Model {
    let mut rng = Rng::with_seed(32);
    let mut parts = vec![lattice.part(&lattice.fixed(&[]))];
    for (color, emission) in
        [([0.9, 0.2, 0.1], [1.0, 0.5, 0.25]), ([1.0; 3], [0.0; 3]), ([0.2, 0.9, 0.8], [0.1; 3])]
    {
        let part = lattice.part(&crowd(lattice, &mut rng));
        parts.push(Part { color, emission, ..part });
    }
    for part in &mut parts[2..] {
        part.masked = true;
        part.uvs = part.corners.iter().map(|_| [rng.f32(), rng.f32()]).collect();
    }
    let keys = "(time: 0), (time: 1, offset: (0.15, 0.1, 0)), (time: 2)";
    Model {
        parts,
        image: Some((image(&mut rng), json!({}))),
        motion: Some(format!("(node: \"part3\", keys: [{keys}])")),
    }
}

/// Unwrapped here rather than in the user's cache.
fn loaded(model: &Model) -> Scene {
    let scene = model.load();
    let atlas = Atlas::of(&scene, None);
    scene.atlas.set(Arc::new(atlas)).expect("it is not made yet");
    scene
}

/// No bit of any sum differs, and none of which voxels are filled, whoever voxelizes.
fn check(model: &Model, resolution: i64) {
    let scene = loaded(model);
    let mut seen = BTreeSet::new();
    for voxelizer in VOXELIZERS {
        let [sums, compact] = [SUMS, COMPACT].map(|payload| {
            Held::of(&set(request("words", payload, voxelizer), "resolution", resolution), &scene)
        });
        let found = differences(&compact.words, &sums.words);
        assert_eq!((found, compact.without_room), (0, 0), "{voxelizer:?}");
        assert!(compact.filled == sums.filled, "{voxelizer:?}: other voxels are filled");
        assert!(sums.filled()[0] > 1000 && (model.motion.is_none() || sums.filled()[1] > 100));
        seen.insert(sums.words);
    }
    assert_eq!(seen.len(), 3, "thin voxels, conservative ones, and those of the atlas");
}

#[test]
fn sums_of_loose_triangles_are_the_same() {
    check(&plain(&Lattice::cube(64)), 64);
}

#[test]
fn sums_of_all_that_a_scene_can_have_are_the_same() {
    let model = motley(&Lattice::cube(37));
    check(&model, 37);
    // The control: without holes more is filled.
    let mut whole = model.clone();
    whole.parts.iter_mut().for_each(|part| part.masked = false);
    let filled = |model: &Model| {
        Held::of(&set(request("words", SUMS, VOXELIZERS[0]), "resolution", 37), &model.load()).filled()
    };
    let (some, all) = (filled(&model), filled(&whole));
    assert!(some[0] + 200 < all[0] && some[1] + 200 < all[1], "{some:?}, {all:?}");
}

/// What finds no room is counted and stays filled; what finds it is whole.
#[test]
fn what_does_not_fit_is_said() {
    const CAPACITY: usize = 300;
    let scene = loaded(&motley(&Lattice::cube(40)));
    for voxelizer in [VOXELIZERS[0], VOXELIZERS[5]] {
        let of = |payload| set(request("words", payload, voxelizer), "resolution", 40);
        let sums = Held::of(&of(SUMS), &scene);
        let few = Held::of(&set(of(COMPACT), "capacity", CAPACITY), &scene);
        assert!(few.filled == sums.filled, "{voxelizer:?}: other voxels are filled");
        let (mut held, mut lost) = (0, 0);
        let still_only = |number: usize| {
            let moving = &sums.filled[1];
            moving[moving.len() / 33 + number / 32] >> (number % 32) & 1 == 0
        };
        for (number, (few, all)) in few.words.chunks_exact(13).zip(sums.words.chunks_exact(13)).enumerate() {
            assert!(few[0] <= all[0], "{voxelizer:?}, voxel {number}");
            lost += u64::from(all[0] - few[0]);
            // Where both meet, one of them may have found room.
            if still_only(number) && few[0] > 0 {
                assert_eq!(few, all, "{voxelizer:?}, voxel {number}");
                held += 1;
            }
        }
        // No weight is below 256 or above 92682.
        assert!(lost > 256_000, "{voxelizer:?}");
        assert!((lost / 92_682..=lost / 256).contains(&few.without_room), "{voxelizer:?}");
        let slots = CAPACITY * 5 / 4;
        assert!((slots / 2..=slots).contains(&held), "{voxelizer:?}: {held}");
        // The control: with room for all of them, nothing is missing.
        let all = sums.filled().into_iter().max().expect("two");
        let enough = Held::of(&set(of(COMPACT), "capacity", all), &scene);
        assert_eq!((differences(&enough.words, &sums.words), enough.without_room), (0, 0), "{voxelizer:?}");
    }
}

/// Every fragment without room is counted, once.
#[test]
fn all_that_does_not_fit_is_counted() {
    let lattice = Lattice::cube(40);
    // Nothing moves, or all but what fixes the grid, far from the others: no voxel has fragments of both.
    let fixing = lattice.part(&lattice.fixed(&[]));
    let loose = lattice.part(&crowd(&lattice, &mut Rng::with_seed(33)));
    let still = Model { parts: vec![fixing, loose], ..Model::default() };
    let motion = "(node: \"part1\", keys: [(time: 0), (time: 1, offset: (0.15, 0.1, 0)), (time: 2)])";
    let moving = Model { motion: Some(motion.to_owned()), ..still.clone() };
    for (model, some_move) in [(still, false), (moving, true)] {
        let scene = loaded(&model);
        assert_eq!(scene.still_triangles < scene.triangles.len(), some_move);
        let way = Way { method: METHODS[0], payload: COUNT, rule: Rule::Thin };
        let counts = counted(&scene, &lattice.grid, &way);
        for voxelizer in [VOXELIZERS[0], VOXELIZERS[5]] {
            let few = set(request("words", COMPACT, voxelizer), "resolution", 40);
            let few = Held::of(&set(few, "capacity", 300), &scene);
            let words = few.words.chunks_exact(10).zip(&counts);
            let without = words.filter(|(words, _)| words[0] == 0);
            let lost: u64 = without.map(|(_, count)| u64::from(*count)).sum();
            assert!(lost > 1000, "{voxelizer:?}");
            assert_eq!(few.without_room, lost, "{voxelizer:?}, some move: {some_move}");
        }
    }
}

/// From frame to frame, what moved leaves its slots: there are too few for all that is filled over time.
#[test]
fn slots_are_freed() {
    let scene = motley(&Lattice::cube(40)).load();
    let of = |payload| set(request("words", payload, VOXELIZERS[0]), "resolution", 40);
    let mut sums = start(&of(SUMS), &scene);
    let capacity = Held::by(&mut sums).filled().into_iter().max().expect("two") * 11 / 10;
    let mut compact = start(&set(of(COMPACT), "capacity", capacity), &scene);
    let mut plays = [&sums, &compact].map(|frame| Play::new(scene.clone(), 0, [32, 32], frame));
    let mut filled = vec![0; 0];
    for frame in 0..8 {
        let time = f64::from(frame) / 8.0;
        plays[0].go_to(&mut sums, gpu(), time).expect("a pose");
        plays[1].go_to(&mut compact, gpu(), time).expect("a pose");
        let (sums, compact) = (Held::by(&mut sums), Held::by(&mut compact));
        let found = differences(&compact.words, &sums.words);
        assert_eq!((found, compact.without_room), (0, 0), "frame {frame}");
        filled.resize(sums.filled[1].len(), 0);
        filled.iter_mut().zip(&sums.filled[1]).for_each(|(all, now)| *all |= now);
    }
    let over_time: u32 = filled[filled.len() / 33..].iter().map(|word| word.count_ones()).sum();
    assert!(over_time > capacity * 5 / 4, "the control: {over_time} voxels, room for {capacity}");
}

/// Nor does any picture made of them.
#[test]
fn pictures_are_the_same() {
    let scene = scene::load(&root("scenes/cornell-moving.ron")).expect("a scene of this repository");
    let of = |payload, capacity| {
        let mut request = request("cones", payload, VOXELIZERS[0]);
        for (knob, value) in [("resolution", 28), ("light_map_size", 64), ("bounces", 2)] {
            request = set(request, knob, value);
        }
        let request = if capacity > 0 { set(request, "capacity", capacity) } else { request };
        let mut frame = start(&request, &scene);
        frame.run(gpu(), &Changes::All).expect("a frame");
        let outputs = frame.graph.plan.outputs.iter();
        let read = |(name, reference, _): &(String, _, _)| {
            (name.clone(), frame.read(gpu(), reference).expect("an output").bytes)
        };
        outputs.map(read).collect::<Vec<_>>()
    };
    let sums = of(SUMS, 0);
    assert!(sums.len() > 5 && sums.iter().all(|(_, bytes)| bytes.iter().any(|byte| *byte != 0)));
    assert!(of(COMPACT, 0) == sums);
    assert!(of(COMPACT, 100) != sums, "the control");
}
