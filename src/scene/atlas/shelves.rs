//! Rectangles on shelves: packed without overlap into a square that is not much larger than they are.
//!
//! The highest come first, each to the lowest shelf that has room for it. Of some widths of the shelves the one with
//! the smallest square is taken.

use glam::DVec2;

#[derive(Clone, Debug, PartialEq)]
pub struct Shelves {
    /// Where each rectangle begins.
    pub places: Vec<DVec2>,
    /// Of the square from (0, 0) that holds them all; greater than 0.
    pub side: f64,
}

struct Shelf {
    low: f64,
    height: f64,
    /// How far it is filled.
    filled: f64,
}

/// Packs rectangles of these sizes, `gap` apart.
pub fn pack(sizes: &[DVec2], gap: f64) -> Shelves {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    // Stable, so that equal ones keep their order.
    order.sort_by(|a, b| sizes[*b].y.total_cmp(&sizes[*a].y));
    let area: f64 = sizes.iter().map(|size| (size.x + gap) * (size.y + gap)).sum();
    let widest = sizes.iter().map(|size| size.x).fold(0.0, f64::max);
    let widths = (0..16).map(|step| widest.max(area.sqrt() * (1.0 + 0.04 * f64::from(step))));
    let all = widths.map(|width| on_shelves(sizes, &order, width, gap));
    let best = all.min_by(|a, b| a.side.total_cmp(&b.side));
    best.unwrap_or(Shelves { places: Vec::new(), side: 1.0 })
}

fn on_shelves(sizes: &[DVec2], order: &[usize], width: f64, gap: f64) -> Shelves {
    let mut shelves: Vec<Shelf> = Vec::new();
    let mut places = vec![DVec2::ZERO; sizes.len()];
    let (mut top, mut side) = (0.0, 0.0_f64);
    for &index in order {
        let size = sizes[index];
        let at = shelves.iter().position(|shelf| shelf.filled + size.x <= width && size.y <= shelf.height);
        let at = at.unwrap_or_else(|| {
            shelves.push(Shelf { low: top, height: size.y, filled: 0.0 });
            top += size.y + gap;
            shelves.len() - 1
        });
        let shelf = &mut shelves[at];
        places[index] = DVec2::new(shelf.filled, shelf.low);
        shelf.filled += size.x + gap;
        side = side.max((places[index] + size).max_element());
    }
    Shelves { places, side: if side > 0.0 { side } else { 1.0 } }
}
