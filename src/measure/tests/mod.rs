//! Numbers are held against other implementations' (`expected.py`), and against what must hold for any pictures.

mod expected;
mod maps;
mod masks;
mod properties;
mod refusals;

use super::*;

const WIDTH: u32 = 48;
const HEIGHT: u32 = 32;

/// The pictures of `expected.py`: reference, picture, variance of the reference.
fn pictures(channels: u32) -> [Picture; 3] {
    let mut data: [Vec<f32>; 3] = Default::default();
    for (y, x, c) in
        (0..HEIGHT).flat_map(|y| (0..WIDTH).flat_map(move |x| (0..channels).map(move |c| (y, x, c))))
    {
        let chance = |salt: u64| {
            let index = u64::from((y * WIDTH + x) * 3 + c) + salt * 100_003;
            f64::from((index * 2_654_435_761) as u32 >> 8) / 16_777_216.0
        };
        let (fx, fy, fc) = (f64::from(x), f64::from(y), f64::from(c));
        let truth = match (x, y) {
            (0..4, _) => 0.0,
            (36..40, 8..12) => 6.0 + fc,
            _ => fx / 48.0 * (fy + 4.0) / 36.0 * (0.25 + 0.375 * fc) + 0.25 * f64::from((x / 8 + y / 8) % 2),
        };
        let truth = f64::from(truth as f32);
        let test = if (x, y) == (20, 10) {
            20.0 + fc
        } else {
            truth * (0.875 + 0.25 * chance(1)) + 0.03125 * chance(2)
        };
        let variance = (truth + 0.125) * chance(3) / 64.0;
        data.iter_mut().zip([truth, test, variance]).for_each(|(data, value)| data.push(value as f32));
    }
    data.map(|data| picture(channels, data))
}

fn picture(channels: u32, data: Vec<f32>) -> Picture {
    Picture::new(WIDTH, HEIGHT, channels, data).unwrap()
}

/// `picture` with every value changed.
fn map(of: &Picture, change: impl Fn(usize, f32) -> f32) -> Picture {
    let data = of.data().iter().enumerate().map(|(i, value)| change(i, *value)).collect();
    Picture::new(of.width(), of.height(), of.channels(), data).unwrap()
}

fn measures<'a>(test: &'a Picture, truth: &'a Picture) -> Measures<'a> {
    let test = Input { name: "test", picture: test };
    let truth = Truth { name: "truth", picture: truth, variance: None };
    Measures::new(Kind::Light, test, truth, &Options::default()).unwrap()
}

fn errors(test: &Picture, truth: &Picture) -> BTreeMap<&'static str, f64> {
    measures(test, truth).errors(None).unwrap()
}
