//! What was measured: a row for each scene, resolution and separability, a cell for each method.

use serde::Serialize;
use std::collections::BTreeMap;
use voxgi::tune::estimate::Estimate;

/// Names of the methods are those of parts, `voxelize/NAME`. These two are what the others put together.
pub const PARENTS: [&str; 2] = ["triangles", "fragments"];

#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub scene: String,
    pub triangles: usize,
    pub resolution: u32,
    pub separability: u32,
    /// Voxels that the first method fills.
    pub filled: u64,
    /// Methods that fill others.
    pub differ: Vec<String>,
    pub cells: Vec<Cell>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    pub method: String,
    /// Its knob of that name, if it has one, in voxels².
    pub cutoff: Option<f64>,
    /// On the CPU's clock, of a frame in which drivers may compile, in ms.
    pub first_use_ms: f64,
    /// Of each round, in ms: what clears, and what voxelizes.
    pub samples_ms: Vec<f64>,
    /// Of those, each stage: by its path, and all fills before stages in one.
    pub stages_ms: BTreeMap<String, Vec<f64>>,
}

impl Cell {
    pub fn estimate(&self) -> Option<Estimate> {
        Estimate::of(&self.samples_ms)
    }

    pub fn median(&self) -> Option<f64> {
        self.estimate().map(|estimate| estimate.median)
    }

    /// Share of the second pass, which takes large triangles, in all that the two passes take; `None` for a method of
    /// one pass.
    pub fn second_pass(&self) -> Option<f64> {
        let of = |prefix: &str| {
            let stages = self
                .stages_ms
                .iter()
                .filter(|(path, _)| path.rsplit('/').next().is_some_and(|name| name.starts_with(prefix)));
            let medians: Vec<f64> =
                stages.filter_map(|(_, samples)| Some(Estimate::of(samples)?.median)).collect();
            (!medians.is_empty()).then(|| medians.iter().sum::<f64>())
        };
        let (small, large) = (of("small")?, of("large")?);
        Some(large / (small + large))
    }
}

impl Row {
    pub fn cell(&self, method: &str) -> Option<&Cell> {
        self.cells.iter().find(|cell| cell.method == method)
    }

    /// The cell with the least median.
    pub fn fastest(&self) -> Option<&Cell> {
        least(self.cells.iter())
    }

    /// How much longer `method` takes than the better of its parents: of each round, the one's time over the other's.
    pub fn over_parent(&self, method: &str) -> Option<Estimate> {
        let parent = least(PARENTS.iter().filter_map(|parent| self.cell(parent)))?;
        let pairs = self.cell(method)?.samples_ms.iter().zip(&parent.samples_ms);
        Estimate::of(&pairs.map(|(own, parents)| own / parents).collect::<Vec<f64>>())
    }
}

fn least<'a>(cells: impl Iterator<Item = &'a Cell>) -> Option<&'a Cell> {
    let known = cells.filter_map(|cell| Some((cell, cell.median()?)));
    known.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(cell, _)| cell)
}
