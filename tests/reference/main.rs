//! Is the pipeline `reference` the truth? Its means against closed forms and quadratures in double precision, within three
//! of its own standard errors, and these against how runs with other seeds differ; what else it promises, too: the
//! hierarchy that its rays go through, the list of emitters, the cache of what it made.
//!
//! Each oracle is also made wrong, by a mistake that renderers make, and so are some kernels: that must show.

mod files;
mod flaws;
mod furnace;
mod gloss;
mod invariance;
mod kept;
mod lights;
mod shot;
mod sky;
mod sphere;
mod stage;
mod statistics;
mod surfaces;
mod tree;
mod weights;
