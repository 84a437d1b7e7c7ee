//! Colours of charts, for light, dark and print.
//!
//! The chart library writes fixed colours into its SVG. Each [`Ink`] has one that no other ink has, and [`css`] turns
//! it into a custom property by an attribute selector, `.plot [fill="#0072B2"] { fill: var(--series-0) }`, and sets
//! that for each scheme. The fixed colours are those of the light scheme, so a chart that is copied out of the
//! page looks as it does there on paper.

use plotters::style::RGBColor;
use std::fmt::Write;

/// Colours of series: the hues of Okabe and Ito, which colour-blind people can tell apart, each dark or light enough to
/// stand out from the paper (3:1 at least).
pub const SERIES: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    Text,
    Muted,
    Grid,
    /// Of the paper.
    Surface,
    /// The reference's noise.
    Noise,
    /// Modulo [`SERIES`].
    Series(usize),
    /// What a stack has no series for.
    Rest,
    /// Text upon a series.
    Upon(usize),
}

/// Light and dark; the light ones are unlike each other.
const TEXT: [&str; 2] = ["#1B1F24", "#E6E8EB"];
const MUTED: [&str; 2] = ["#59616B", "#A3ABB5"];
const GRID: [&str; 2] = ["#DDE1E6", "#343A42"];
const SURFACE: [&str; 2] = ["#FFFFFF", "#15181C"];
const NOISE: [&str; 2] = ["#6B7280", "#949CA8"];
const REST: [&str; 2] = ["#9AA1AB", "#6F7884"];
const UPON_DEEP: [&str; 2] = ["#FEFEFE", "#0B0D0F"];
const UPON_PALE: [&str; 2] = ["#0A0B0C", "#0A0B0C"];
const SERIES_COLORS: [[&str; 2]; SERIES] = [
    ["#0072B2", "#4C9FDB"],
    ["#D55E00", "#F0803C"],
    ["#009E73", "#2CC295"],
    ["#BC5F96", "#E79CC6"],
    ["#3697CF", "#A5DBFA"],
    ["#C58200", "#F5B93D"],
    ["#2B2F36", "#C4CAD2"],
    ["#756600", "#F0E442"],
];

impl Ink {
    fn entry(self) -> (String, [&'static str; 2]) {
        match self {
            Ink::Text => ("text".to_owned(), TEXT),
            Ink::Muted => ("muted".to_owned(), MUTED),
            Ink::Grid => ("grid".to_owned(), GRID),
            Ink::Surface => ("surface".to_owned(), SURFACE),
            Ink::Noise => ("noise".to_owned(), NOISE),
            Ink::Rest => ("rest".to_owned(), REST),
            Ink::Series(index) => (format!("series-{}", index % SERIES), SERIES_COLORS[index % SERIES]),
            Ink::Upon(index) if matches!(index % SERIES, 0 | 6 | 7) => ("upon-deep".to_owned(), UPON_DEEP),
            Ink::Upon(_) => ("upon-pale".to_owned(), UPON_PALE),
        }
    }

    /// As the chart library takes it.
    pub fn color(self) -> RGBColor {
        let light = self.entry().1[0];
        let channel =
            |at: usize| light.get(at..at + 2).and_then(|hex| u8::from_str_radix(hex, 16).ok()).unwrap_or(0);
        RGBColor(channel(1), channel(3), channel(5))
    }

    /// As a value of CSS.
    pub fn property(self) -> String {
        format!("var(--{})", self.entry().0)
    }

    pub fn all() -> Vec<Ink> {
        let mut all = vec![
            Ink::Text,
            Ink::Muted,
            Ink::Grid,
            Ink::Surface,
            Ink::Noise,
            Ink::Rest,
            Ink::Upon(0),
            Ink::Upon(1),
        ];
        all.extend((0..SERIES).map(Ink::Series));
        all
    }
}

/// Custom properties for both schemes and for print, and the selectors that put them in the place of fixed colours.
pub fn css() -> String {
    let scheme = |which: usize| -> String {
        Ink::all().into_iter().map(|ink| format!("--{}:{};", ink.entry().0, ink.entry().1[which])).collect()
    };
    let (light, dark) = (scheme(0), scheme(1));
    let mut css = format!(
        ":root{{color-scheme:light dark;{light}}}\n\
         @media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n"
    );
    for ink in Ink::all() {
        let ((name, _), RGBColor(r, g, b)) = (ink.entry(), ink.color());
        for attribute in ["fill", "stroke"] {
            let _infallible =
                writeln!(css, ".plot [{attribute}=\"#{r:02X}{g:02X}{b:02X}\"]{{{attribute}:var(--{name})}}");
        }
    }
    // Names of points may cross lines: they stand upon a rim of paper.
    let RGBColor(r, g, b) = Ink::Text.color();
    let _infallible = writeln!(
        css,
        ".plot text[fill=\"#{r:02X}{g:02X}{b:02X}\"]{{paint-order:stroke;stroke:var(--surface);stroke-width:3px}}"
    );
    css
}
