//! Light that a surface scatters, by brute force: paths and shadow rays through the triangles, no voxels.
//!
//! All surfaces are Lambert and scatter on both sides. Sampling is stratified and deterministic: the same call gives
//! the same number. The `flaw` makes the oracle wrong on purpose, to show that a comparison would notice.

use super::world::{Hit, Light, World};
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

/// A mistake that renderers make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flaw {
    None,
    /// ρ in place of ρ/π.
    NoPi,
    /// The last surface is taken to be white.
    NoAlbedo,
    /// Light falls off with the distance, not with its square.
    LinearFalloff,
    NoShadows,
    NoCosine,
}

impl Flaw {
    pub const ALL: [Self; 5] =
        [Self::NoPi, Self::NoAlbedo, Self::LinearFalloff, Self::NoShadows, Self::NoCosine];
}

pub struct Integrator<'a> {
    pub world: &'a World,
    pub flaw: Flaw,
}

/// Paths a pixel: strata in each of two dimensions.
const STRATA: u32 = 64;
/// Samples of an emitting triangle: strata in each of two dimensions.
const LAMP_STRATA: u32 = 24;

impl Integrator<'_> {
    /// Visible emission and light that was scattered once.
    pub fn direct(&self, hit: &Hit) -> DVec3 {
        self.world.emission(hit) + self.reflectance(hit) * self.irradiance(hit, LAMP_STRATA, 0)
    }

    /// Light that was scattered 2 to `bounces + 1` times.
    pub fn indirect(&self, hit: &Hit, bounces: u32) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for path in 0..STRATA * STRATA {
            let mut throughput = self.reflectance(hit) * PI;
            let mut at = *hit;
            for bounce in 0..bounces {
                let strata = if bounce == 0 { STRATA } else { 1 };
                let sample = stratum(path, strata, 2 * bounce + 1);
                let Some(next) = self.world.nearest(at.point, cosine_direction(at.normal, sample)) else {
                    break;
                };
                let honest = self.world.albedo(&next) / PI;
                sum += throughput * honest * self.irradiance(&next, 1, path ^ (bounce << 20));
                throughput *= self.world.albedo(&next);
                at = next;
            }
        }
        sum / f64::from(STRATA * STRATA)
    }

    /// Radiance over irradiance.
    fn reflectance(&self, hit: &Hit) -> DVec3 {
        let albedo = if self.flaw == Flaw::NoAlbedo { DVec3::ONE } else { self.world.albedo(hit) };
        if self.flaw == Flaw::NoPi { albedo } else { albedo / PI }
    }

    fn irradiance(&self, hit: &Hit, lamp_strata: u32, seed: u32) -> DVec3 {
        let lights = self.world.lights.iter().map(|light| self.of_light(hit, light));
        lights.sum::<DVec3>() + self.of_lamps(hit, lamp_strata, seed)
    }

    fn of_light(&self, hit: &Hit, light: &Light) -> DVec3 {
        let (to_light, distance, facing) = match light {
            Light::Point { position, intensity } => self.falloff(*position - hit.point, *intensity),
            Light::Spot { position, direction, intensity, cos_inner, cos_outer } => {
                let d = *position - hit.point;
                let cosine = -d.normalize().dot(*direction);
                // KHR_lights_punctual.
                let share = ((cosine - cos_outer) / (cos_inner - cos_outer)).clamp(0.0, 1.0);
                self.falloff(d, *intensity * share * share)
            }
            Light::Directional { direction, irradiance } => (-*direction, 1e3, *irradiance),
        };
        let cosine = self.cosine(hit.normal.dot(to_light));
        if cosine > 0.0 && self.visible(hit.point, to_light, distance) {
            facing * cosine
        } else {
            DVec3::ZERO
        }
    }

    /// From surfaces that emit: the mean over points of each triangle.
    fn of_lamps(&self, hit: &Hit, strata: u32, seed: u32) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for lamp in self.world.facets.iter().filter(|f| f.emission != DVec3::ZERO) {
            let mut of_lamp = DVec3::ZERO;
            for i in 0..strata * strata {
                let [u, v] = stratum(i ^ (seed << 8), strata, 100);
                let [a, b, c] = lamp.corners;
                let s = u.sqrt();
                let point = a * (1.0 - s) + b * (s * (1.0 - v)) + c * (s * v);
                let (to_lamp, distance, facing) = self.falloff(point - hit.point, lamp.emission);
                let cosines = self.cosine(hit.normal.dot(to_lamp)) * (-lamp.normal.dot(to_lamp)).max(0.0);
                if cosines > 0.0 && self.visible(hit.point, to_lamp, distance) {
                    of_lamp += facing * cosines;
                }
            }
            sum += of_lamp * lamp.area / f64::from(strata * strata);
        }
        sum
    }

    /// Direction, distance, and irradiance facing it, of something with `intensity` that lies at `d` from here.
    fn falloff(&self, d: DVec3, intensity: DVec3) -> (DVec3, f64, DVec3) {
        let distance = d.length();
        let power = if self.flaw == Flaw::LinearFalloff { 1 } else { 2 };
        (d / distance, distance, intensity / distance.powi(power))
    }

    fn cosine(&self, cosine: f64) -> f64 {
        if self.flaw == Flaw::NoCosine { f64::from(u8::from(cosine > 0.0)) } else { cosine.max(0.0) }
    }

    fn visible(&self, from: DVec3, direction: DVec3, distance: f64) -> bool {
        self.flaw == Flaw::NoShadows || self.world.open(from, direction, distance)
    }
}

/// Point number `i` of the unit square cut into `strata`² cells.
fn stratum(i: u32, strata: u32, dimension: u32) -> [f64; 2] {
    let cell = i % (strata * strata);
    let place = |cell: u32, dimension: u32| {
        let jitter = noise(u64::from(i) << 32 | u64::from(dimension));
        (f64::from(cell) + jitter) / f64::from(strata)
    };
    [place(cell % strata, dimension), place(cell / strata, dimension + 1)]
}

/// A number in [0, 1) for each number (SplitMix64's finalizer).
pub fn noise(n: u64) -> f64 {
    let mut z = n.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Cosine-weighted around `normal`.
fn cosine_direction(normal: DVec3, [u, v]: [f64; 2]) -> DVec3 {
    let across = normal.any_orthonormal_vector();
    let frame = DMat3::from_cols(across, normal.cross(across), normal);
    let (sin, cos) = (TAU * u).sin_cos();
    frame * DVec3::new(v.sqrt() * cos, v.sqrt() * sin, (1.0 - v).sqrt())
}
