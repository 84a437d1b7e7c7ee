//! Names beside points, where there is room.

use super::plot::{At, width};

/// Height of a line of text in pixels.
const HEIGHT: i32 = 14;
/// Half the side of a marker.
const MARKER: i32 = 8;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Area {
    left: i32,
    top: i32,
    right: i32,
    bottom: i32,
}

impl Area {
    fn overlaps(&self, other: &Area) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    fn within(&self, other: &Area) -> bool {
        self.left >= other.left && self.right <= other.right && self.top >= other.top && self.bottom <= other.bottom
    }
}

/// For each point its text and where the middle of its left edge goes. `texts` are what a point may be called, the one
/// wanted most first; the last is put down even where it covers something. Texts stay within `bounds` (upper left,
/// lower right) where they can.
pub fn place(points: &[At], texts: &[Vec<String>], bounds: [At; 2]) -> Vec<(String, At)> {
    let [(left, top), (right, bottom)] = bounds;
    let bounds = Area { left, top, right, bottom };
    let marker = |at: &At| Area {
        left: at.0 - MARKER,
        top: at.1 - MARKER,
        right: at.0 + MARKER,
        bottom: at.1 + MARKER,
    };
    let mut taken: Vec<Area> = points.iter().map(marker).collect();
    let mut placed = Vec::new();
    for (at, wanted) in points.iter().zip(texts) {
        let choices = wanted.iter().flat_map(|text| around(*at, width(text)).map(|area| (text, area)));
        let free = |(_, area): &(&String, Area)| area.within(&bounds) && !taken.iter().any(|t| t.overlaps(area));
        let fallback = wanted.last().map(|text| (text, around(*at, width(text))[0]));
        if let Some((text, area)) = choices.clone().find(free).or(fallback) {
            taken.push(area);
            placed.push((text.clone(), (area.left, area.top + HEIGHT / 2)));
        }
    }
    placed
}

/// Right of `at`, above, below and left of it.
fn around(at: At, width: i32) -> [Area; 4] {
    let area = |left: i32, top: i32| Area { left, top, right: left + width, bottom: top + HEIGHT };
    [
        area(at.0 + MARKER + 2, at.1 - HEIGHT / 2),
        area(at.0 - width / 2, at.1 - MARKER - HEIGHT),
        area(at.0 - width / 2, at.1 + MARKER),
        area(at.0 - MARKER - 2 - width, at.1 - HEIGHT / 2),
    ]
}
