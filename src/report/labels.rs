//! Names beside points, where there is room.

use super::plot::{At, width};

/// Height of a line of text in pixels.
const HEIGHT: i32 = 14;
/// Half the side of a marker.
const MARKER: i32 = 7;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Area {
    left: i32,
    top: i32,
    right: i32,
    bottom: i32,
}

impl Area {
    fn overlaps(&self, other: &Area) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    fn within(&self, other: &Area) -> bool {
        self.left >= other.left
            && self.right <= other.right
            && self.top >= other.top
            && self.bottom <= other.bottom
    }
}

/// A point that wants a name.
pub struct Wish {
    pub at: At,
    /// What it may be called, wanted most first; the last is put down even where it covers something.
    pub texts: Vec<String>,
    /// Whether to look for room to the lower left first, as points of the front do: nothing is beyond them.
    pub low: bool,
}

/// For each point its text and where the middle of its left edge goes. Texts stay within `bounds` (upper left, lower
/// right) where they can.
pub fn place(wishes: &[Wish], bounds: [At; 2]) -> Vec<(String, At)> {
    let [(left, top), (right, bottom)] = bounds;
    let bounds = Area { left, top, right, bottom };
    let marker = |wish: &Wish| Area {
        left: wish.at.0 - MARKER,
        top: wish.at.1 - MARKER,
        right: wish.at.0 + MARKER,
        bottom: wish.at.1 + MARKER,
    };
    let mut taken: Vec<Area> = wishes.iter().map(marker).collect();
    let mut placed = Vec::new();
    for wish in wishes {
        let choices = wish.texts.iter().flat_map(|text| around(wish, width(text)).map(|area| (text, area)));
        let free =
            |(_, area): &(&String, Area)| area.within(&bounds) && !taken.iter().any(|t| t.overlaps(area));
        let fallback = wish.texts.last().map(|text| (text, around(wish, width(text))[0]));
        if let Some((text, area)) = choices.clone().find(free).or(fallback) {
            taken.push(area);
            placed.push((text.clone(), (area.left, area.top + HEIGHT / 2)));
        }
    }
    placed
}

/// Places for a text, best first; beside the point last: bars of times go there.
fn around(wish: &Wish, width: i32) -> [Area; 8] {
    let (x, y) = wish.at;
    let (above, below, level) = (y - HEIGHT - 3, y + 4, y - HEIGHT / 2);
    let (right, centre, left) = (x + MARKER, x - width / 2, x - MARKER - width);
    let mut corners = [(right, above), (right, below), (left, above), (left, below)];
    if wish.low {
        corners.rotate_right(1);
    }
    let sides = [(centre, above - MARKER), (centre, below + MARKER), (right + 2, level), (left - 2, level)];
    let [a, b, c, d] = corners;
    let [e, f, g, h] = sides;
    [a, b, c, d, e, f, g, h].map(|(left, top)| Area { left, top, right: left + width, bottom: top + HEIGHT })
}
