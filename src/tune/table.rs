//! What was measured, on any state of the machine and over several scenes, as one function.
//!
//! Times of one batch are measured in turns, so that what else the machine does meets all alike. Between batches it
//! may have become slower or faster for good. So the least number so far runs along in each later batch as its
//! **yardstick**: a sample counts by its ratio to the yardstick's of the same round, times what the yardstick was
//! known to take. The interval then holds the noise of both.

use super::estimate::Estimate;
use super::search::{Known, Objective};
use crate::problem::Result;
use crate::record::quantile;

/// Something that can be measured at numbers, on the scene of a number from 0.
pub trait Quantity {
    /// One for each number; `yardstick` is measured beside them.
    fn samples(&mut self, scene: usize, numbers: &[f64], yardstick: Option<f64>) -> Result<Vec<Series>>;

    /// Whether it would be the same again.
    fn is_exact(&self) -> bool;
}

/// Samples of one number.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// One for each round.
    pub samples: Vec<f64>,
    /// What was the yardstick, and its samples in the same rounds.
    pub yardstick: Option<(f64, Vec<f64>)>,
}

/// A quantity, and all that was measured of it.
pub struct Measuring<'a> {
    quantity: &'a mut dyn Quantity,
    scenes: usize,
    pub table: Table,
}

impl<'a> Measuring<'a> {
    pub fn new(quantity: &'a mut dyn Quantity, scenes: usize) -> Self {
        Self { quantity, scenes, table: Table::default() }
    }

    /// Of each number, the series by scene.
    fn series(&mut self, numbers: &[f64], yardstick: Option<f64>) -> Result<Vec<(f64, Vec<Series>)>> {
        let mut rows: Vec<(f64, Vec<Series>)> = numbers.iter().map(|number| (*number, Vec::new())).collect();
        for scene in 0..self.scenes {
            let series = self.quantity.samples(scene, numbers, yardstick)?;
            rows.iter_mut().zip(series).for_each(|((_, row), series)| row.push(series));
        }
        Ok(rows)
    }
}

impl Objective for Measuring<'_> {
    fn measure(&mut self, numbers: &[f64]) -> Result<()> {
        let rows = self.series(numbers, self.table.least())?;
        rows.into_iter().for_each(|(number, row)| self.table.put(number, row));
        Ok(())
    }

    fn again(&mut self, numbers: &[f64]) -> Result<()> {
        if self.quantity.is_exact() {
            return Ok(());
        }
        let rows = self.series(numbers, None)?;
        self.table.put_anew(rows);
        Ok(())
    }

    fn known(&self) -> Vec<Known> {
        self.table.known()
    }
}

/// Samples of a quantity that is to be small, by number and scene.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// By rising number.
    rows: Vec<Row>,
}

#[derive(Clone, Debug)]
struct Row {
    number: f64,
    /// By scene.
    cells: Vec<Cell>,
}

/// A number on a scene.
#[derive(Clone, Debug)]
pub struct Cell {
    /// As measured.
    pub series: Series,
    /// As on the machine in the state of the first batch.
    pub samples: Vec<f64>,
}

impl Table {
    /// Puts series in, one for each scene. Their yardsticks must be in already.
    pub fn put(&mut self, number: f64, series: Vec<Series>) {
        let cell = |(scene, series): (usize, Series)| {
            let yardstick = series.yardstick.as_ref();
            let known = yardstick.and_then(|(number, samples)| Some((self.median(*number, scene)?, samples)));
            let samples = match known {
                Some((median, yardstick)) => {
                    let scaled = |(sample, by): (&f64, &f64)| match *by > 0.0 {
                        true => sample / by * median,
                        // Shorter than the clock's tick: it says nothing.
                        false => *sample,
                    };
                    series.samples.iter().zip(yardstick).map(scaled).collect()
                }
                None => series.samples.clone(),
            };
            Cell { series, samples }
        };
        let cells = series.into_iter().enumerate().map(cell).collect();
        let row = Row { number, cells };
        match self.rows.binary_search_by(|row| row.number.total_cmp(&number)) {
            Ok(index) => self.rows[index] = row,
            Err(index) => self.rows.insert(index, row),
        }
    }

    /// Puts series of one batch in the place of what was known of these numbers, the least among them. They are
    /// compared with each other alone, so that all are scaled by what the least was known to take.
    fn put_anew(&mut self, rows: Vec<(f64, Vec<Series>)>) {
        let Some(least) = self.least() else { return };
        let scenes = rows.first().map_or(0, |(_, row)| row.len());
        let before: Vec<Option<f64>> = (0..scenes).map(|scene| self.median(least, scene)).collect();
        let numbers: Vec<f64> = rows.iter().map(|(number, _)| *number).collect();
        rows.into_iter().for_each(|(number, row)| self.put(number, row));
        let now = (0..scenes).map(|scene| self.median(least, scene));
        let factor = |(before, now): (Option<f64>, Option<f64>)| {
            before.zip(now).filter(|(_, now)| *now > 0.0).map_or(1.0, |(before, now)| before / now)
        };
        let factors: Vec<f64> = before.into_iter().zip(now).map(factor).collect();
        for row in self.rows.iter_mut().filter(|row| numbers.contains(&row.number)) {
            for (cell, factor) in row.cells.iter_mut().zip(&factors) {
                cell.samples.iter_mut().for_each(|sample| *sample *= factor);
            }
        }
    }

    /// What is known of a number, by scene.
    pub fn cells(&self, number: f64) -> &[Cell] {
        self.rows.iter().find(|row| row.number == number).map_or(&[], |row| &row.cells)
    }

    fn median(&self, number: f64, scene: usize) -> Option<f64> {
        quantile(&self.cells(number).get(scene)?.samples, 0.5)
    }

    /// The number of the least median.
    fn least(&self) -> Option<f64> {
        let known = self.known();
        let least = known.iter().min_by(|a, b| a.estimate.median.total_cmp(&b.estimate.median));
        least.map(|known| known.number)
    }

    /// Of each number, the mean over scenes of the ratio to the scene's least median: 1 where it is the best in each.
    /// That is the least sum of ratios, and of one scene the least of the quantity itself.
    pub fn known(&self) -> Vec<Known> {
        let scenes = self.rows.first().map_or(0, |row| row.cells.len());
        let median = |row: &Row, scene: usize| quantile(&row.cells.get(scene)?.samples, 0.5);
        let least = |scene| self.rows.iter().filter_map(|row| median(row, scene)).min_by(f64::total_cmp);
        let least: Vec<f64> = (0..scenes).filter_map(least).collect();
        let known = |row: &Row| {
            let rounds = row.cells.iter().map(|cell| cell.samples.len()).min().unwrap_or(0);
            let mean = |round: usize| -> f64 {
                let ratios =
                    row.cells.iter().zip(&least).map(|(cell, least)| ratio(cell.samples[round], *least));
                ratios.sum::<f64>() / scenes as f64
            };
            let means: Vec<f64> = (0..rounds).map(mean).collect();
            Some(Known { number: row.number, estimate: Estimate::of(&means)? })
        };
        self.rows.iter().filter_map(known).collect()
    }
}

/// A quantity against the least of its kind. Where that is 0, all else is without bounds.
fn ratio(sample: f64, least: f64) -> f64 {
    /// So large that nothing comes near, and still one that can be added up.
    const UNBOUNDED: f64 = 1e100;
    match (least > 0.0, sample > least) {
        (true, _) => sample / least,
        (false, true) => UNBOUNDED,
        (false, false) => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn medians(table: &Table) -> Vec<(f64, f64)> {
        table.known().iter().map(|known| (known.number, known.estimate.median)).collect()
    }

    fn series(samples: &[f64]) -> Series {
        Series { samples: samples.to_vec(), yardstick: None }
    }

    fn samples(table: &Table, number: f64) -> Vec<Vec<f64>> {
        table.cells(number).iter().map(|cell| cell.samples.clone()).collect()
    }

    #[test]
    fn scenes_count_by_their_ratio_to_the_best() {
        let mut table = Table::default();
        table.put(2.0, vec![series(&[10.0]), series(&[3.0])]);
        table.put(1.0, vec![series(&[20.0]), series(&[1.0])]);
        table.put(3.0, vec![series(&[15.0]), series(&[1.0])]);
        // Ratios 2 and 1; 1 and 3; 1.5 and 1.
        assert_eq!(medians(&table), [(1.0, 1.5), (2.0, 2.0), (3.0, 1.25)]);
        table.put(3.0, vec![series(&[5.0]), series(&[4.0])]);
        assert_eq!(medians(&table), [(1.0, 2.5), (2.0, 2.5), (3.0, 2.5)]);
        assert_eq!(samples(&table, 3.0), [[5.0], [4.0]]);
        assert!(table.cells(7.0).is_empty());
    }

    #[test]
    fn rounds_make_the_interval_and_nothing_divides_by_zero() {
        let mut table = Table::default();
        table.put(1.0, vec![series(&[4.0, 2.0, 3.0])]);
        let estimate = table.known()[0].estimate;
        assert_eq!((estimate.low, estimate.median, estimate.high), (2.0 / 3.0, 1.0, 4.0 / 3.0));
        let mut table = Table::default();
        table.put(1.0, vec![series(&[0.0]), series(&[2.0])]);
        table.put(2.0, vec![series(&[1e-9]), series(&[1.0])]);
        let found = medians(&table);
        assert_eq!(found[0], (1.0, 1.5));
        assert!(found[1].1 > 1e90 && found[1].1.is_finite());
    }

    #[test]
    fn later_batches_are_scaled_by_the_yardstick() {
        let mut table = Table::default();
        table.put(1.0, vec![series(&[4.0, 5.0, 6.0])]);
        table.put(2.0, vec![series(&[6.0, 7.0, 8.0])]);
        // The machine is half as fast, in the last round a third: 3 takes 0.8 of what 1 does, in each.
        let by = Some((1.0, vec![10.0, 10.0, 15.0]));
        table.put(3.0, vec![Series { samples: vec![8.0, 8.0, 12.0], yardstick: by }]);
        assert_eq!(samples(&table, 3.0), [[4.0, 4.0, 4.0]]);
        assert_eq!(table.cells(3.0)[0].series.samples, [8.0, 8.0, 12.0], "as measured");
        assert_eq!(table.least(), Some(3.0));
        // Side by side at a tenth of the speed: the least takes what it did, the other its ratio.
        table.put_anew(vec![(1.0, vec![series(&[60.0])]), (3.0, vec![series(&[40.0])])]);
        assert_eq!((samples(&table, 3.0), samples(&table, 1.0)), (vec![vec![4.0]], vec![vec![6.0]]));
        assert_eq!(samples(&table, 2.0), [[6.0, 7.0, 8.0]]);
    }
}
