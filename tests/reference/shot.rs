//! Runs of the pipeline, and means over their pixels with standard errors.

use glam::DVec3;
use std::sync::OnceLock;
use voxgi::converge::{Estimate, Until, converge};
use voxgi::device::{Gpu, LimitSet};
use voxgi::frame::Clock;
use voxgi::library::Library;
use voxgi::scene::Scene;
use voxgi::session::{Request, prepare};

pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| {
        Gpu::open(None, &LimitSet::Adapter)
            .expect("a Vulkan device: `sh scripts/setup.sh` installs a software one")
    })
}

/// A run to be made: 512 samples of each of 16² pixels in batches of 64, all surfaces Lambert, unless told otherwise.
#[derive(Clone)]
pub struct Shot<'a> {
    scene: &'a Scene,
    library: Library,
    request: Request,
    samples: u64,
}

impl<'a> Shot<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        let request = Request { pipeline: "reference".to_owned(), size: [16, 16], ..Request::default() };
        Self { scene, library: Library::default(), request, samples: 512 }
            .set("batch", "64")
            .set("samples_per_frame", "64")
            .set("diffuse_only", "true")
    }

    /// The last word counts.
    pub fn set(mut self, knob: &str, value: impl ToString) -> Self {
        self.request.sets.retain(|(set, _)| set != knob);
        self.request.sets.push((knob.to_owned(), value.to_string()));
        self
    }

    pub fn size(mut self, size: [u32; 2]) -> Self {
        self.request.size = size;
        self
    }

    pub fn samples(mut self, samples: u64) -> Self {
        self.samples = samples;
        self
    }

    /// With kernels of this library in place of the shipped ones.
    pub fn by(mut self, library: &Library) -> Self {
        self.library = library.clone();
        self
    }

    pub fn take(&self) -> Estimate {
        let prepared = prepare(&self.request, &self.library, Some(self.scene)).expect("a plan");
        let progress = prepared.graph.plan.progress.clone().expect("it gets better from frame to frame");
        let clock = Clock::Wall("not timed".to_owned());
        let mut frame = prepared.realise(gpu(), self.scene, clock, None).expect("a frame");
        let until = Until { samples: Some(self.samples), ..Until::default() };
        converge(gpu(), &mut frame, &progress, None, &until, &mut |_, _| Ok(())).expect("an estimate").0
    }
}

/// Rays begin above a triangle by 1.5·10⁻⁵ of its size, which changes distances to lights; relative. Single precision of some ten
/// products and a sum of hundreds is less.
const ROUNDING: f64 = 1e-4;

/// A mean of pixels.
#[derive(Clone, Copy, Debug)]
pub struct Mean {
    pub value: DVec3,
    /// Its standard error.
    pub error: DVec3,
}

impl Mean {
    /// Whether it is the truth within three standard errors, in all channels.
    pub fn agrees(&self, truth: DVec3) -> bool {
        self.agrees_within(truth, ROUNDING)
    }

    /// Likewise; the truth itself is known to `tolerance`, relative.
    pub fn agrees_within(&self, truth: DVec3, tolerance: f64) -> bool {
        (self.value - truth).abs().cmple(3.0 * self.error + tolerance * truth.abs()).all()
    }

    /// Sees that it is the truth, and is none of the `mistakes`.
    pub fn expect(&self, what: &str, truth: DVec3, mistakes: &[(&str, DVec3)]) {
        println!("{what}: {:.5} ± {:.5}, to be {truth:.5}", self.value, self.error);
        assert!(self.agrees(truth), "{what}: {self:?} is not {truth:?}");
        for (mistake, wrong) in mistakes {
            assert!(!self.agrees(*wrong), "{what}: {self:?} could as well be {wrong:?}: {mistake}");
        }
    }
}

/// The mean of an output over all pixels.
pub fn mean(estimate: &Estimate, output: &str) -> Mean {
    mean_where(estimate, output, |_, _| true)
}

/// The mean of an output over the pixels that `chosen` wants, by column and row. Pixels are independent, so that variances
/// add up. Outputs of one channel count as grey.
pub fn mean_where(estimate: &Estimate, output: &str, chosen: impl Fn(u32, u32) -> bool) -> Mean {
    let (_, picture, variance) = estimate.means().find(|(name, ..)| *name == output).expect("the output");
    let rgb = |texel: &[f32]| match *texel {
        [r, g, b, ..] => DVec3::new(r.into(), g.into(), b.into()),
        [grey, ..] => DVec3::splat(grey.into()),
        [] => DVec3::ZERO,
    };
    let (mut value, mut squared, mut count) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for (i, (texel, variance)) in picture.texels().zip(variance.texels()).enumerate() {
        let (x, y) = (i as u32 % picture.width(), i as u32 / picture.width());
        if chosen(x, y) {
            (value, squared, count) = (value + rgb(texel), squared + rgb(variance), count + 1.0);
        }
    }
    assert!(count > 0.0, "no pixel of {output} is wanted");
    Mean { value: value / count, error: (squared / (count * count)).map(f64::sqrt) }
}
