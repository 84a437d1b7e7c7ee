//! The pipeline `cones` in the Cornell box, against an integrator that knows neither voxels nor cones.
//!
//! The program has one sample in each pixel, at its centre; so has the oracle. Measured at 64³ if nothing else is said, two
//! scatterings if nothing else is said; mean: sum over the expected sum; median and squared: of the pixels' relative
//! errors ([`Comparison`]).
//!
//! | scene | cones | direct: mean, median, squared | indirect: mean, median, squared |
//! |---|---|---|---|
//! | point light near the ceiling | 6, 32³ | 1.000, 0.000, 0.000 | 0.896, 0.213, 0.197 |
//! | | 6 | 1.000, 0.000, 0.000 | 0.887, 0.226, 0.229 |
//! | | 6, five scatterings | | 0.990, 0.090, 0.105 |
//! | | 32 | | 1.009, 0.187, 0.077 |
//! | | 128 fine | | 0.943, 0.081, 0.016 |
//! | lamp | 6, 32³ | 0.720, 0.437, 0.897 | 0.781, 0.337, 0.176 |
//! | | 6 | 0.673, 0.531, 0.773 | 0.674, 0.317, 0.156 |
//! | | 6, five scatterings | | 0.821, 0.200, 0.087 |
//! | | 32 | 0.865, 0.314, 0.334 | 0.954, 0.216, 0.125 |
//! | | 128 fine | 0.880, 0.151, 0.096 | 0.836, 0.128, 0.034 |
//! | light in front | 6, 32³ | 1.000, 0.000, 0.000 | 1.192, 0.239, 0.141 |
//! | | 6 | | 1.166, 0.236, 0.115 |
//! | | 6, five scatterings | | 1.335, 0.310, 0.163 |
//! | | 32 | | 1.169, 0.219, 0.074 |
//! | | 128 fine | | 0.997, 0.048, 0.009 |
//! | a wall glows | 6 | 0.977, 0.315, 0.232 | 0.921, 0.304, 0.278 |
//! | | 32 | 0.949, 0.252, 0.113 | 0.905, 0.201, 0.132 |
//! | | 128 fine | 0.881, 0.129, 0.028 | 0.901, 0.102, 0.074 |
//!
//! Why they differ:
//! * Light that comes without cones (direct, of a point light) has no error but the G-buffer's half floats.
//! * Six cones sample six directions: a lamp of 13 cm, or the patch of ceiling above the point light, fills less than a
//!   cone. Pixels whose cone hits it get several times the light (the back wall at \[44, 36\], the left at \[4, 36\]),
//!   the floor in front (row 60) next to none. Finer voxels don't help, more cones do.
//! * A sample as wide as its cone smears walls and blocks over what lies before and beside them; light that would leave
//!   through the open front meets them again. That is the excess of a sixth with the light in front, whatever the number
//!   of cones, and it grows with each scattering. With samples a quarter as wide it is gone.
//! * A wall of one voxel is not quite opaque to fine cones either: the lamp and the glowing wall lose a tenth, and
//!   some 6 % more with `cone_density` at 1 in place of 1.5. The worst
//!   of them is the shady side of the tall block (\[20, 28\], \[20, 36\]), which sees the lamp at a slant.

use super::integrator::{Flaw, Integrator};
use super::program::{SIZE, color, pixels, render, shipped};
use super::scenes::Studio;
use super::world::{Hit, World};
use glam::DVec3;
use std::ops::Range;
use std::path::Path;
use voxgi::picture::Picture;

/// A pixel, and what is seen in its centre.
type Place = ([u32; 2], Hit);

/// All pixels with a surface.
fn all(world: &World) -> impl Iterator<Item = Place> {
    let hit = |[x, y]: [u32; 2]| world.seen(f64::from(x) + 0.5, f64::from(y) + 0.5, SIZE);
    pixels().filter_map(move |pixel| Some((pixel, hit(pixel)?)))
}

/// Those whose surface does not emit.
fn seen(world: &World) -> impl Iterator<Item = Place> {
    all(world).filter(|(_, hit)| world.facets[hit.facet].emission == DVec3::ZERO)
}

/// Some 60 pixels in rows and columns over the whole picture, on every surface, without the lamps' own.
fn places(world: &World) -> Vec<Place> {
    let places: Vec<Place> = seen(world).filter(|([x, y], _)| x % 8 == 4 && y % 8 == 4).collect();
    let seen = |object: usize| places.iter().any(|(_, hit)| world.facets[hit.facet].object == object);
    let emits = |object: usize| world.facets.iter().any(|f| f.object == object && f.emission != DVec3::ZERO);
    // Number 2 is the lamp's rectangle, which few pixels show.
    assert!((0..OBJECTS).all(|object| object == 2 || seen(object) || emits(object)), "every surface is seen");
    places
}

/// How a picture compares with the oracle at some places. Colours are summed over their channels. Errors of single
/// pixels are relative to the expected light plus a tenth of its mean, so that dark pixels count with what is visible.
struct Comparison {
    /// Sum over all places, over the expected sum.
    mean: f64,
    /// Median of the pixels' relative errors.
    median: f64,
    /// Mean of their squares.
    squared: f64,
    /// Each pixel's error, largest first.
    worst: Vec<([u32; 2], f64)>,
}

impl Comparison {
    fn new(places: &[Place], picture: &Picture, expected: &[DVec3]) -> Self {
        let light: Vec<f64> = expected.iter().map(|color| color.element_sum()).collect();
        let seen: Vec<f64> = places.iter().map(|(pixel, _)| color(picture, *pixel).element_sum()).collect();
        let count = places.len() as f64;
        let little = 0.1 * light.iter().sum::<f64>() / count;
        let errors = seen.iter().zip(&light).map(|(seen, light)| (seen - light) / (light + little));
        let mut worst: Vec<_> = places.iter().map(|(pixel, _)| *pixel).zip(errors).collect();
        worst.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        Self {
            mean: seen.iter().sum::<f64>() / light.iter().sum::<f64>(),
            median: worst[worst.len() / 2].1.abs(),
            squared: worst.iter().map(|(_, error)| error * error).sum::<f64>() / count,
            worst,
        }
    }

    fn line(&self) -> String {
        let worst: Vec<_> =
            self.worst.iter().take(3).map(|(pixel, error)| format!("{pixel:?} {error:+.2}")).collect();
        let Self { mean, median, squared, .. } = self;
        format!("{mean:6.3}  {median:6.3}  {squared:7.4}  {}", worst.join(", "))
    }
}

/// How near a picture must come.
struct Bounds {
    mean: Range<f64>,
    median: f64,
    squared: f64,
}

impl Bounds {
    fn hold(&self, found: &Comparison) -> bool {
        self.mean.contains(&found.mean) && found.median < self.median && found.squared < self.squared
    }
}

/// How a scene is rendered, and how near `direct` and `indirect` must come.
struct Case {
    options: &'static str,
    /// Scatterings in the voxels: `indirect` is light scattered 2 to `bounces + 1` times.
    bounces: u32,
    direct: Bounds,
    indirect: Bounds,
}

const COARSE: &str = "--set resolution=32";
const DEFAULT: &str = "";
/// 32 cones, as wide as they share the hemisphere.
const SPIRAL: &str = "--part hemisphere=hemisphere/spiral";
/// Many cones that are sampled much finer than they are wide: what is left then is the voxels' error.
const FINE: &str = "--part hemisphere=hemisphere/spiral --set cone_count=128 --set cone_footprint=0.25";

/// Of lights without extent: the G-buffer's half floats are what is left.
const EXACT: Bounds = within(0.999..1.001, 0.001, 1e-4);

const fn within(mean: Range<f64>, median: f64, squared: f64) -> Bounds {
    Bounds { mean, median, squared }
}

/// Renders all cases, and sees that they lie within their bounds, and that with each flaw in the oracle one does not.
fn check(scene: &Path, cases: &[Case]) {
    let world = World::load(scene);
    let places = places(&world);
    let oracle = |flaw, bounces| {
        let integrator = Integrator { world: &world, flaw };
        let direct: Vec<DVec3> = places.iter().map(|(_, hit)| integrator.direct(hit)).collect();
        let indirect: Vec<DVec3> = places.iter().map(|(_, hit)| integrator.indirect(hit, bounces)).collect();
        [direct, indirect]
    };
    println!("{}: output, options; mean, median, squared, worst", scene.display());
    let mut pictures = Vec::new();
    let mut outside = Vec::new();
    for Case { options, bounces, direct, indirect } in cases {
        let options = format!("{options} --set bounces={bounces}");
        let rendered = render(scene, "cones", &options, ["direct", "indirect"]);
        let honest = oracle(Flaw::None, *bounces);
        for (i, (output, bounds)) in [("direct", direct), ("indirect", indirect)].into_iter().enumerate() {
            let found = Comparison::new(&places, &rendered[i], &honest[i]);
            let line = format!("{output:8} {:>60}  {}", options, found.line());
            println!("{line}");
            if !bounds.hold(&found) {
                outside.push(line);
            }
        }
        pictures.push(rendered);
    }
    for flaw in Flaw::ALL {
        let flawed = oracle(flaw, 1);
        let noticed =
            cases.iter().zip(&pictures).filter(|(case, _)| case.bounces == 1).any(|(case, pictures)| {
                let found = [0, 1].map(|i| Comparison::new(&places, &pictures[i], &flawed[i]));
                !(case.direct.hold(&found[0]) && case.indirect.hold(&found[1]))
            });
        assert!(noticed, "{flaw:?} passes in {}", scene.display());
    }
    assert!(outside.is_empty(), "outside of the bounds:\n{}", outside.join("\n"));
}

/// The brightest thing is a patch of the ceiling some centimetres wide: six cones find it or miss it.
#[test]
fn a_point_light_near_the_ceiling() {
    let case = |options, bounces, indirect| Case { options, bounces, direct: EXACT, indirect };
    let cases = [
        case(COARSE, 1, within(0.82..0.97, 0.27, 0.25)),
        case(DEFAULT, 1, within(0.82..0.97, 0.27, 0.27)),
        case(DEFAULT, 4, within(0.92..1.06, 0.13, 0.14)),
        case(SPIRAL, 1, within(0.94..1.08, 0.23, 0.1)),
        case(FINE, 1, within(0.9..1.0, 0.1, 0.02)),
    ];
    check(&shipped("scenes/cornell-point.glb"), &cases);
}

/// A small lamp, which voxels gather by cones as pixels do.
#[test]
fn the_lamp() {
    let case = |options, bounces, direct, indirect| Case { options, bounces, direct, indirect };
    let cases = [
        case(COARSE, 1, within(0.65..0.8, 0.5, 1.0), within(0.7..0.86, 0.38, 0.22)),
        case(DEFAULT, 1, within(0.6..0.75, 0.6, 0.9), within(0.6..0.75, 0.37, 0.2)),
        case(DEFAULT, 4, within(0.6..0.75, 0.6, 0.9), within(0.75..0.9, 0.25, 0.11)),
        case(SPIRAL, 1, within(0.8..0.94, 0.36, 0.4), within(0.88..1.03, 0.26, 0.16)),
        case(FINE, 1, within(0.82..0.94, 0.19, 0.12), within(0.77..0.9, 0.16, 0.05)),
    ];
    check(&shipped("scenes/cornell-box.glb"), &cases);
}

/// Everything that the camera sees is lit, and evenly: no bright patch for cones to miss. Only `FINE` notices light without
/// shadows, for what lies in them is not seen.
#[test]
fn a_light_in_front() {
    let studio = Studio::new();
    let scene = studio.cornell_under("front", FRONT);
    let case = |options, bounces, indirect| Case { options, bounces, direct: EXACT, indirect };
    let cases = [
        case(COARSE, 1, within(1.1..1.28, 0.28, 0.17)),
        case(DEFAULT, 1, within(1.08..1.25, 0.27, 0.14)),
        case(DEFAULT, 4, within(1.23..1.42, 0.36, 0.19)),
        case(SPIRAL, 1, within(1.08..1.25, 0.26, 0.1)),
        case(FINE, 1, within(0.95..1.05, 0.06, 0.011)),
    ];
    check(&scene, &cases);
}

/// The green wall glows, in place of the lamp: light from a large surface.
#[test]
fn a_wall_that_glows() {
    let studio = Studio::new();
    let scene = studio.edited("cornell-box", "wall", |document| {
        document["materials"][LAMP]["emissiveFactor"] = [0, 0, 0].into();
        document["materials"][GREEN]["emissiveFactor"] = [1, 1, 1].into();
    });
    let case = |options, bounces, direct, indirect| Case { options, bounces, direct, indirect };
    let cases = [
        case(DEFAULT, 1, within(0.9..1.06, 0.36, 0.28), within(0.84..1.0, 0.36, 0.34)),
        case(SPIRAL, 1, within(0.87..1.02, 0.3, 0.15), within(0.83..0.98, 0.25, 0.17)),
        case(FINE, 1, within(0.82..0.94, 0.17, 0.04), within(0.83..0.97, 0.14, 0.1)),
    ];
    check(&scene, &cases);
}

const FRONT: &str = "Point(position: (0.278, 0.273, -0.5), intensity: (1, 1, 1))";
/// Numbers of materials in the shipped scenes.
const GREEN: usize = 1;
const LAMP: usize = 3;
/// Numbers of objects there.
const FLOOR: usize = 0;
const OBJECTS: usize = 8;

/// A lamp is seen with the radiance that it has; its own voxels, spread over the plane in which it lies, add half a
/// percent in single pixels.
#[test]
fn the_lamp_is_seen_as_bright_as_it_is() {
    let path = shipped("scenes/cornell-box.glb");
    let world = World::load(&path);
    let [direct] = render(&path, "cones", "--set resolution=32 --set bounces=1", ["direct"]);
    let lamp = |place: &Place| world.emission(&place.1) != DVec3::ZERO;
    let errors: Vec<f64> = all(&world)
        .filter(lamp)
        .map(|(pixel, hit)| (color(&direct, pixel) / world.emission(&hit) - 1.0).abs().max_element())
        .collect();
    let worst = errors.iter().copied().fold(0.0, f64::max);
    println!("the lamp, in {} pixels, is off by up to {worst:.5}", errors.len());
    assert!(errors.len() > 20 && worst < 0.01);
}

/// Where the oracle sees nothing of the lamp, the floor is darker than where it does.
#[test]
fn blocks_shade_the_floor_from_the_lamp() {
    let path = shipped("scenes/cornell-box.glb");
    let world = World::load(&path);
    let [direct] = render(&path, "cones", SPIRAL, ["direct"]);
    let integrator = Integrator { world: &world, flaw: Flaw::None };
    let floor = seen(&world).filter(|(_, hit)| world.facets[hit.facet].object == FLOOR);
    let light =
        |(pixel, hit): Place| [color(&direct, pixel), integrator.direct(&hit)].map(DVec3::element_sum);
    let (dark, lit): (Vec<_>, Vec<_>) = floor.map(light).partition(|[_, expected]| *expected == 0.0);
    let mean = |places: &[[f64; 2]], i: usize| places.iter().map(|p| p[i]).sum::<f64>() / places.len() as f64;
    let share = mean(&dark, 0) / mean(&lit, 0);
    println!("umbra: {} pixels, {share:.3} of the {} lit ones", dark.len(), lit.len());
    assert!(dark.len() > 20 && share < 0.5);
}

/// Red over green of a picture's light, and of the oracle's, on the floor where x lies in a range.
fn tint(world: &World, indirect: &Picture, x: &Range<f64>) -> [f64; 2] {
    let integrator = Integrator { world, flaw: Flaw::None };
    let floor = |hit: &Hit| world.facets[hit.facet].object == FLOOR && x.contains(&hit.point.x);
    let places = seen(world).filter(|(_, hit)| floor(hit)).step_by(3);
    let pairs = places.map(|(pixel, hit)| [color(indirect, pixel), integrator.indirect(&hit, 1)]);
    let sums = pairs.reduce(|[a, b], [c, d]| [a + c, b + d]).expect("pixels in the range");
    sums.map(|sum| sum.x / sum.y)
}

/// The floor is redder beside the red wall, on the left, than beside the green one.
#[test]
fn walls_tint_the_floor() {
    let studio = Studio::new();
    let front = studio.cornell_under("front", FRONT);
    let world = World::load(&front);
    for options in [DEFAULT, SPIRAL] {
        let [indirect] = render(&front, "cones", &format!("{options} --set bounces=1"), ["indirect"]);
        let [left, right] = [0.42..1.0, 0.0..0.13].map(|x| tint(&world, &indirect, &x));
        println!("red over green, seen and expected: left {left:?}, right {right:?}, {options}");
        let near = |[seen, expected]: [f64; 2]| (seen / expected - 1.0).abs() < 0.3;
        assert!(near(left) && near(right));
        // Not if the walls were exchanged.
        assert!(!near([left[0], right[1]]) && !near([right[0], left[1]]));
    }
}
