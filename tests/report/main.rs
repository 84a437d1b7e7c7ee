//! The page of a folder of runs: what is in it, and what a browser makes of it.

mod browser;
mod fixture;
mod page;
