//! What the payload of sums holds, word by word.

use crate::oracle::{Point, Rule, number};
use crate::voxelizer::{Grid, Method, Way, picture};
use glam::DVec3;
use voxgi::scene::Scene;

/// Words of a voxel: weights, in 65536ths of a voxel's face, then three each of albedo, normal and position, in fixed point.
const WORDS: usize = 10;

/// All words of a grid.
#[derive(Clone, PartialEq, Eq)]
pub struct Sums {
    words: Vec<u32>,
    size: Point,
}

pub struct Means {
    pub albedo: DVec3,
    pub normal: DVec3,
    /// Position within the voxel, in voxels.
    pub within: DVec3,
}

impl Sums {
    /// Of a scene that does not emit.
    pub fn of(scene: &Scene, grid: &Grid, method: Method, rule: Rule) -> Self {
        let way = Way { method, payload: "payload/sums", rule };
        let image = picture("words", "words", scene, grid, &way);
        let words =
            image.bytes.chunks_exact(4).map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]])).collect();
        Self { words, size: grid.size }
    }

    pub fn voxel(&self, voxel: Point) -> [u32; WORDS] {
        let first = number(voxel, self.size) * WORDS;
        std::array::from_fn(|i| self.words[first + i])
    }

    /// Of a voxel with fragments that is not full.
    pub fn means(&self, voxel: Point) -> Means {
        let words = self.voxel(voxel);
        let weights = f64::from(words[0]);
        let unsigned = |at: usize| DVec3::from_array([0, 1, 2].map(|i| f64::from(words[at + i]))) / weights;
        let signed = |i: usize| 2.0 * f64::from(words[4 + i].cast_signed()) / weights;
        Means {
            albedo: unsigned(1),
            normal: DVec3::new(signed(0), signed(1), signed(2)),
            within: unsigned(7),
        }
    }

    /// All voxels with fragments.
    pub fn filled(&self) -> impl Iterator<Item = Point> {
        let [x, y, z] = self.size;
        let all = (0..z).flat_map(move |z| (0..y).flat_map(move |y| (0..x).map(move |x| [x, y, z])));
        all.filter(|voxel| self.voxel(*voxel)[0] > 0)
    }

    /// How many words differ.
    pub fn differences(&self, other: &Self) -> usize {
        crate::oracle::differences(&self.words, &other.words)
    }
}
