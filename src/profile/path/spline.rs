//! A smooth curve through points that are given at times of any spacing.
//!
//! Between two points it is the cubic that meets them with the slopes chosen there: at each point the slope of the
//! parabola through it and its neighbours (Catmull-Rom's, where the spacing is even). So the curve has no jump in place
//! or speed, goes through all points, and is exact where they lie on a parabola.

/// The curve through `points` (time, place) at time `at`; it stays at its ends before the first and after the last.
/// Times must rise.
pub fn curve<const N: usize>(points: &[(f64, [f64; N])], at: f64) -> Option<[f64; N]> {
    let (first, last) = (points.first()?, points.last()?);
    let after = points.partition_point(|(time, _)| *time <= at);
    if after == 0 {
        return Some(first.1);
    }
    if after == points.len() {
        return Some(last.1);
    }
    let ((begin, from), (end, to)) = (points[after - 1], points[after]);
    let span = end - begin;
    let x = (at - begin) / span;
    let weights = [
        (1.0 + 2.0 * x) * (1.0 - x) * (1.0 - x),
        x * (1.0 - x) * (1.0 - x) * span,
        x * x * (3.0 - 2.0 * x),
        x * x * (x - 1.0) * span,
    ];
    Some(std::array::from_fn(|axis| {
        let slopes = [after - 1, after].map(|point| slope(points, point, axis));
        weights[0] * from[axis] + weights[1] * slopes[0] + weights[2] * to[axis] + weights[3] * slopes[1]
    }))
}

/// The slope at a point: of the parabola through it and the nearest two others, of the line if there is only one.
fn slope<const N: usize>(points: &[(f64, [f64; N])], point: usize, axis: usize) -> f64 {
    let last = points.len() - 1;
    let middle = point.clamp(1, last.max(2) - 1);
    let chord = |a: usize, b: usize| (points[b].1[axis] - points[a].1[axis]) / (points[b].0 - points[a].0);
    if last < 2 {
        return chord(0, 1);
    }
    let (before, after) = (chord(middle - 1, middle), chord(middle, middle + 1));
    let bend = (after - before) / (points[middle + 1].0 - points[middle - 1].0);
    let [from, between] = [middle - 1, middle].map(|p| points[p].0);
    // Newton's form p(t) = p₀ + before (t − from) + bend (t − from)(t − between), derived.
    let at = points[point].0;
    before + bend * (2.0 * at - from - between)
}
