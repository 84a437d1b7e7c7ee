//! Exponents: how a time grows with a number, by least squares on logarithms.

/// A slope and half of its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Slope {
    pub exponent: f64,
    pub half: f64,
}

/// The exponent b of y = c · x^b over positive x and y, with a constant c for each group of points and one b for all.
/// `None` where points are too few: fewer than three more than groups, or no two x in a group differ.
pub fn exponent(groups: &[Vec<(f64, f64)>]) -> Option<Slope> {
    let (mut count, mut used) = (0, 0);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for group in groups.iter().filter(|group| group.len() > 1) {
        let points: Vec<(f64, f64)> = group.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
        let (mean_x, mean_y) = (mean(|point| point.0), mean(|point| point.1));
        for (x, y) in &points {
            let (x, y) = (x - mean_x, y - mean_y);
            xx += x * x;
            xy += x * y;
            yy += y * y;
        }
        count += points.len();
        used += 1;
    }
    let freedom = count.checked_sub(used + 1).filter(|freedom| *freedom > 0)?;
    let exponent = xy / xx;
    let unexplained = (yy - exponent * xy).max(0.0) / freedom as f64;
    exponent.is_finite().then(|| Slope { exponent, half: student(freedom) * (unexplained / xx).sqrt() })
}

/// Half of the 95 % interval in standard errors, of an estimate with so many degrees of freedom: Student's t.
fn student(freedom: usize) -> f64 {
    const TABLE: [f64; 30] = [
        12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145,
        2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048,
        2.045, 2.042,
    ];
    // Beyond the table its last value is a little too wide.
    TABLE[freedom.clamp(1, TABLE.len()) - 1]
}
