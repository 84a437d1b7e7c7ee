//! Finds where a function of one number is least, from as few measurements as it takes.
//!
//! The function is thought to fall and then to rise, each part of it perhaps in stairs or not at all: times of a
//! cutoff are alike over a wide range. What is measured is noisy ([`Estimate`]).
//!
//! 1. **Scan**: nine numbers at equal distances on the range's scale, both ends among them (of a few whole numbers,
//!    all), and those that the caller names. What lies between the least and the first on each side that surely
//!    exceeds it holds the minimum.
//! 2. **Bracket**: numbers beside each other that don't surely exceed the least one are its flat. The gaps at both its
//!    edges are halved until no finer number is between, or they are an eighth of the flat; so is the widest gap in it,
//!    while that is more than a quarter of it. It ends at once where not even the range's ends exceed the least. Each
//!    number is measured once. A part that is better can be missed if it is narrower than that within a flat one.
//! 3. **Again**: the numbers of the flat are measured anew, side by side. The least so far was so by luck too.
//! 4. **Choice**: of the flat as it is now, cut to what is within [`ALIKE`] of its least, the number nearest to its
//!    middle on the scale. In a flat any number does as well, and one in the middle still does where a scene or a
//!    machine differs a little.

use super::estimate::Estimate;
use super::range::Range;
use crate::problem::{Problem, Result};
use std::ops::RangeInclusive;

/// What is to be least.
pub trait Objective {
    /// Measures at numbers that were not measured before.
    fn measure(&mut self, numbers: &[f64]) -> Result<()>;
    /// Measures anew at numbers that were, which takes the place of what was measured before.
    fn again(&mut self, numbers: &[f64]) -> Result<()>;
    /// All that was measured, by rising number.
    fn known(&self) -> Vec<Known>;
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    pub number: f64,
    pub estimate: Estimate,
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    pub number: f64,
    /// From the least to the most number that is as good.
    pub flat: [f64; 2],
}

/// What is chosen takes at most so many times what the least does, even if that is not sure.
pub const ALIKE: f64 = 1.05;
/// Most numbers that are measured; no range of 32-bit numbers takes as many without noise.
pub const MOST: usize = 128;

/// Searches `range`; of the numbers `named` those that are in it are scanned too.
pub fn search(range: &Range, named: &[f64], objective: &mut impl Objective) -> Result<Found> {
    let mut next = range.scan();
    next.extend(named.iter().filter(|number| range.contains(**number)));
    next.sort_by(f64::total_cmp);
    next.dedup();
    while !next.is_empty() {
        objective.measure(&next)?;
        next = halves(range, &objective.known());
    }
    choose(objective, |number| range.place(number))
}

/// The numbers that halve the gaps on both sides of the flat, and its widest one; none at the end of the search.
fn halves(range: &Range, known: &[Known]) -> Vec<f64> {
    let Some(flat) = around_least(known, |estimate, least| !estimate.exceeds(least)) else {
        return Vec::new();
    };
    let (first, last) = flat.into_inner();
    let place = |index: usize| range.place(known[index].number);
    let length = |(low, high): &(usize, usize)| place(*high) - place(*low);
    let width = length(&(first, last));
    let before = first.checked_sub(1).map(|low| (low, first));
    let after = Some((last, last + 1)).filter(|(_, high)| *high < known.len());
    let [before, after] = [before, after].map(|gap| gap.filter(|gap| length(gap) > width / 8.0));
    let inside = (first..last).map(|low| (low, low + 1)).max_by(|a, b| length(a).total_cmp(&length(b)));
    let inside = inside.filter(|gap| length(gap) > width / 4.0);
    let gaps = [before, inside, after].into_iter().flatten();
    let halves: Vec<f64> =
        gaps.filter_map(|(low, high)| range.between(known[low].number, known[high].number)).collect();
    if known.len() + halves.len() > MOST { Vec::new() } else { halves }
}

/// The third and fourth step alone: all that is to be measured has been; `place` is a number's on the scale.
pub fn choose(objective: &mut impl Objective, place: impl Fn(f64) -> f64) -> Result<Found> {
    let known = objective.known();
    let flat = around_least(&known, |estimate, least| !estimate.exceeds(least));
    let known = once_more(objective, &known[flat.ok_or_else(nothing)?])?;
    let alike = |estimate: &Estimate, least: &Estimate| {
        !estimate.exceeds(least) && estimate.median <= ALIKE * least.median
    };
    let flat = &known[around_least(&known, alike).ok_or_else(nothing)?];
    let ends = [flat[0].number, flat[flat.len() - 1].number];
    let middle = f64::midpoint(place(ends[0]), place(ends[1]));
    let away = |known: &&Known| (place(known.number) - middle).abs();
    let nearest = flat.iter().min_by(|a, b| away(a).total_cmp(&away(b))).ok_or_else(nothing)?;
    Ok(Found { number: nearest.number, flat: ends })
}

/// The least of what stands in no order, such as names by their index: those that don't surely exceed the least are
/// measured again, and the least then is it.
pub fn choose_unordered(objective: &mut impl Objective) -> Result<Found> {
    let known = objective.known();
    let least = least(&known).ok_or_else(nothing)?;
    let near: Vec<Known> =
        known.iter().filter(|other| !other.estimate.exceeds(&least.estimate)).copied().collect();
    let number = self::least(&once_more(objective, &near)?).ok_or_else(nothing)?.number;
    Ok(Found { number, flat: [number; 2] })
}

/// What is known of these after they were measured again; one alone needs no more.
fn once_more(objective: &mut impl Objective, these: &[Known]) -> Result<Vec<Known>> {
    let numbers: Vec<f64> = these.iter().map(|known| known.number).collect();
    if numbers.len() > 1 {
        objective.again(&numbers)?;
    }
    let mut known = objective.known();
    known.retain(|known| numbers.contains(&known.number));
    Ok(known)
}

fn least(known: &[Known]) -> Option<&Known> {
    known.iter().min_by(|a, b| a.estimate.median.total_cmp(&b.estimate.median))
}

/// Indices of the least one and of those beside it that are `like` it, up to the first on each side that is not.
fn around_least(
    known: &[Known],
    like: impl Fn(&Estimate, &Estimate) -> bool,
) -> Option<RangeInclusive<usize>> {
    let least = least(known)?;
    let at = known.iter().position(|other| other.number == least.number)?;
    let like = |other: &&Known| like(&other.estimate, &least.estimate);
    let before = known[..at].iter().rev().take_while(like).count();
    let after = known[at + 1..].iter().take_while(like).count();
    Some(at - before..=at + after)
}

fn nothing() -> Problem {
    Problem::failure("nothing-measured", "nothing was measured")
}
