//! A pipeline or part file as written, with the position of everything in it.
//!
//! The types here mirror the RON one to one; nothing is resolved or evaluated. Maps keep the order of the file and
//! refuse a key that occurs twice; unknown fields are refused. An absent map or list is empty.
//!
//! The place of a text is what stands between its quotes; of anything else, all of it.

mod decode;
mod read;
mod stages;
#[cfg(test)]
mod tests;
mod tree;

use crate::problem::{Place, Problem, Problems, Result, Source};

/// Reads a file. Where its syntax is right, all that is wrong with its content is reported at once.
pub fn parse(source: &Source) -> Result<Document> {
    let tree = tree::read(source)?;
    let mut reader = read::Reader { source, problems: Vec::new() };
    let document = reader.document(&tree);
    Problems::check(reader.problems)?;
    document.ok_or_else(|| {
        Problem::input("wrong-type", "this is no document").at(&source.at(tree.span), "all of it").into()
    })
}

/// A value and where it stands in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Spanned<T> {
    pub value: T,
    pub place: Place,
}

/// A RON map with text keys: in the order of the file, each key once.
pub type Entries<T> = Vec<(Spanned<String>, Spanned<T>)>;

/// An expression's text (see [`crate::expr`]). RON numbers and flags are taken too: `5` is `"5"`.
pub type ExprText = Spanned<String>;

/// A whole file: `Pipeline(…)` or `Part(…)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    pub source: Source,
    pub root: Root,
    /// What it is, in a sentence or two, with its source (document and section, or paper).
    pub about: Spanned<String>,
    pub knobs: Entries<Knob>,
    /// Named values: small numbers or vectors computed by expressions, which may use each other but not in a ring.
    pub values: Entries<String>,
    pub samplers: Entries<Sampler>,
    pub resources: Entries<Resource>,
    pub stages: Vec<Spanned<Stage>>,
    pub lacks: Vec<Lack>,
}

/// `(when: "scene.max_metallic > 0", what: "metals are rendered matt")`: what a scene can call for and the file can't do.
#[derive(Clone, Debug, PartialEq)]
pub struct Lack {
    pub when: ExprText,
    /// A sentence without its full stop: what is done instead.
    pub what: Spanned<String>,
}

/// `(batch: "batch", frames: "frames_of_a_batch", first: "first_sample")`: of a pipeline whose outputs get better from
/// frame to frame. Outputs are means of samples; an output `X_variance` is the variance of the mean `X`.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Samples of a batch: outputs are whole after each.
    pub batch: ExprText,
    /// Frames that a batch takes.
    pub frames: ExprText,
    /// The knob that says how many samples were drawn before the first frame.
    pub first: Spanned<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Root {
    Pipeline {
        /// Role → name of the part that plays it, a file below `pipelines/parts/`.
        parts: Entries<String>,
        /// Output name → the resource (or subresource) that holds it.
        outputs: Entries<String>,
        progress: Option<Progress>,
    },
    Part {
        /// The role it can play.
        role: Spanned<String>,
        /// The WGSL module, below `kernels/`, that stands behind `role/NAME` in imports.
        module: Option<Spanned<String>>,
        /// Further modules: `NAME` → the one behind `role/NAME`, for names that are no roles of their own.
        modules: Entries<String>,
        /// Binding of its module → the resource that stands behind it in stages over what moves.
        moving: Entries<String>,
        /// Why what its module writes depends on the order of threads; stages that import it say so.
        order_dependent: Option<Spanned<String>>,
        /// Resources, values and knobs of this part that the pipeline and other parts can name.
        exports: Vec<Spanned<String>>,
    },
}

/// `"resolution": (default: 64, range: (8, 512), unit: "texels", about: "…")`
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    pub default: Spanned<Literal>,
    pub allowed: Allowed,
    pub unit: Option<String>,
    pub about: Spanned<String>,
}

/// A knob's value as written. Its kind is the knob's type: `64` whole, `0.5` real, `true` flag, `"…"` text.
#[derive(Clone, Debug, PartialEq)]
pub enum Literal {
    Whole(i64),
    Real(f64),
    Flag(bool),
    Text(String),
}

#[derive(Clone, Debug, PartialEq)]
pub enum Allowed {
    /// Flags need no more; other types must say `range` or `values`.
    Any,
    /// Both ends included.
    Range(f64, f64),
    Values(Vec<Literal>),
}

/// `"linear": (filter: Linear, mip_filter: Linear, wrap: Clamp, compare: Greater)`
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampler {
    pub filter: Filter,
    pub mip_filter: Filter,
    pub wrap: Wrap,
    pub compare: Option<Compare>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    #[default]
    Nearest,
    Linear,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    #[default]
    Clamp,
    Repeat,
    Mirror,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compare {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    Always,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Resource {
    /// `Texture(format: "rgba16float", size: ["w", "h", "d"], mips: "all", layers: "n", start: Covered)`
    Texture {
        /// A format's name, or an expression with a text value (a knob).
        format: ExprText,
        /// One to three expressions; absent: the size of the output.
        size: Vec<ExprText>,
        /// Absent: 1. `"all"`: down to one texel.
        mips: Option<ExprText>,
        /// Present: an array texture with that many layers.
        layers: Option<ExprText>,
        start: Spanned<Start>,
    },
    /// `Buffer(count: "n", start: Fill(0))`: `count` elements of the kernels' runtime-sized array, or one struct.
    Buffer { count: Option<ExprText>, start: Spanned<Start> },
}

/// How a resource's content begins in each frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// Every texel or word has this value.
    Fill(f64),
    /// Undefined: stages write every texel before any is read.
    Covered,
    /// What the frame before left; `value` before the first frame and after any of `reset` changed.
    Kept {
        value: f64,
        reset: Vec<Cause>,
        /// Stages that run again without a change leave it as it was, so that they may be kept.
        steady: bool,
    },
}

/// What can change between frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cause {
    Geometry,
    Moving,
    Lights,
    Camera,
    Knobs,
    /// The frame number: always.
    Frame,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Stage {
    Compute(Compute),
    Raster(Raster),
    /// `Part(role: "mipmap", name: "mipmap_emitted", bind: {"volume": "emitted"})`: the stages of the part in that role.
    Part {
        role: Spanned<String>,
        name: Option<Spanned<String>>,
        when: Option<ExprText>,
        bind: Entries<String>,
    },
    /// `Each(name: "level", over: Range("0", "n"), stages: […])`: once for each element, `level` its index.
    Each {
        name: Spanned<String>,
        over: Spanned<Over>,
        when: Option<ExprText>,
        stages: Vec<Spanned<Stage>>,
    },
    /// `Repeat(times: "n", swap: [("a", "b")], stages: […])`: after each round `a` and `b` change names.
    Repeat {
        times: ExprText,
        swap: Vec<(Spanned<String>, Spanned<String>)>,
        when: Option<ExprText>,
        stages: Vec<Spanned<Stage>>,
    },
}

/// Which triangles of the scene a stage goes over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Geometry {
    #[default]
    All,
    /// Those that no motion moves.
    Still,
    /// Those that some motion moves, even if not in this frame.
    Moving,
}

/// What every kernel call says.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// Absent: the last piece of the kernel's name.
    pub name: Option<Spanned<String>>,
    /// A file below `kernels/`, without `.wgsl`.
    pub kernel: Spanned<String>,
    pub when: Option<ExprText>,
    /// Binding (or target) → resource, possibly one mip, layer or history slot of it: `"radiance@mip(level + 1)"`.
    pub bind: Entries<String>,
    /// What `Triangles`, `Scene` and the uniform `geometry` stand for.
    pub geometry: Geometry,
    /// Why the result depends on thread order by nature, if it does.
    pub order_dependent: Option<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Compute {
    pub call: Call,
    pub over: Spanned<Extent>,
}

/// How many threads a compute stage has.
#[derive(Clone, Debug, PartialEq)]
pub enum Extent {
    /// One for each texel of the resource bound under (or named by) this.
    Texels(Spanned<String>),
    /// One to three expressions.
    Count(Vec<ExprText>),
    /// One for each triangle of the stage's geometry.
    Triangles,
    /// Workgroup counts that a kernel wrote: three u32 at element `offset` (default 0) of the buffer.
    Indirect { buffer: Spanned<String>, offset: Option<ExprText> },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    pub call: Call,
    pub draw: Spanned<Draw>,
    pub depth: Option<Depth>,
    /// Absent: targets are overwritten.
    pub blend: Option<Blend>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Draw {
    /// Three vertices for each triangle of the stage's geometry, pulled from the scene's buffers.
    Scene,
    /// One triangle that covers the screen: three vertices.
    Screen,
    /// `count` points.
    Points(ExprText),
    /// `count` vertices, as a triangle list.
    Vertices(ExprText),
    /// A triangle list with draw arguments that a kernel wrote: four u32 at element `offset` of the buffer.
    Indirect { buffer: Spanned<String>, offset: Option<ExprText> },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Depth {
    /// The depth texture: a resource, possibly one layer of it.
    pub target: Spanned<String>,
    pub compare: Compare,
    pub write: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blend {
    Add,
    Alpha,
    Max,
}

/// What `Each` goes over.
#[derive(Clone, Debug, PartialEq)]
pub enum Over {
    /// From the first to before the second.
    Range(ExprText, ExprText),
    /// The scene's lights of a kind: `"point"`, `"spot"`, `"directional"` or `"all"`; the index is the light's.
    Lights(Spanned<String>),
    /// The views that the engine fits to the lights.
    Views,
    /// The mip levels of a resource.
    Mips(Spanned<String>),
}
