//! How to read the page.

use super::errors::better;
use super::measures::MEASURES;
use super::view::View;
use maud::{Markup, html};

pub fn guide(view: &View) -> Markup {
    html! {
        section class="guide" id="guide" {
            h2 { "How to read this" }
            dl {
                @for measure in &MEASURES {
                    dt { (measure.title) " " span class="quiet" { "(" (better(measure)) ")" } }
                    dd { (measure.about) }
                }
                dt { "Within the reference's noise" }
                dd {
                    "A reference is an average of random samples and has an error of its own, known from its "
                    "variance and given as relMSE. A run whose relMSE is no more than that noise explains can't "
                    "be told from the truth, and two such runs can't be told from each other; more samples would."
                }
                dt { "GPU time" }
                dd {
                    "Median over the sampled frames, after the first; bars reach from the tenth to the ninetieth "
                    "percentile."
                }
                dt { "Pictures" }
                dd {
                    "Radiance times 2 to the power of " (view.comparison.exposure) ", tone curve “"
                    (view.comparison.curve) "”, sRGB-coded: the same for runs and references. FLIP and SSIM see "
                    "these; all other measures see linear values."
                }
                dt { "Outputs" }
                dd {
                    "color is all light, direct is visible emission and one scattering, indirect is the rest; "
                    "each is held against the reference's own."
                }
                dt { "Masks" }
                dd {
                    "surface: pixels that show a surface; lit and unlit: those of them that are lit directly, or "
                    "not."
                }
                dt { "Difference" }
                dd { "Signed and relative to the reference: blue is darker, white alike, red brighter." }
            }
        }
    }
}
