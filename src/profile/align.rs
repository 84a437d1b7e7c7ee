//! Puts the GPU's times on the CPU's clock.
//!
//! wgpu tells no moment of both clocks at once, but each frame gives a bracket: its work can't have begun before it went
//! to the queue, nor ended after the wait for it did. One distance between the clocks must fit all frames, so all their
//! brackets together leave it little room; the middle of what is left is taken, and half its width is how far off
//! that can be. Where no distance fits all, the clocks drift, and each frame is put into the middle of its own bracket.

/// What is known of one frame, in ns: of the CPU's clock when it went to the queue and when it was known to have
/// ended, of the GPU's its first begin and its last end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bracket {
    pub submit: i64,
    pub done: i64,
    pub first: i64,
    pub last: i64,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Alignment {
    /// By frame, what is to be added to the GPU's times.
    pub offsets: Vec<i64>,
    /// How far off they can be, ns.
    pub within: u64,
    /// One distance fits all frames.
    pub steady: bool,
}

impl Bracket {
    /// The least and the greatest distance that fits.
    fn range(&self) -> (i64, i64) {
        (self.submit - self.first, self.done - self.last)
    }
}

pub fn align(brackets: &[Bracket]) -> Alignment {
    let middle = |(low, high): (i64, i64)| low + (high - low) / 2;
    let width = |(low, high): (i64, i64)| (high - low).unsigned_abs().div_ceil(2);
    let all = brackets.iter().map(Bracket::range);
    let common = all.reduce(|a, b| (a.0.max(b.0), a.1.min(b.1))).unwrap_or_default();
    if common.0 <= common.1 {
        let offsets = vec![middle(common); brackets.len()];
        return Alignment { offsets, within: width(common), steady: true };
    }
    Alignment {
        offsets: brackets.iter().map(|b| middle(b.range())).collect(),
        within: brackets.iter().map(|b| width(b.range())).max().unwrap_or(0),
        steady: false,
    }
}
