//! `voxgi generate`: writes the scenes that are made from published numbers.

use super::print;
use crate::problem::{Problem, Result};
use crate::{picture, scene::generate};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct GenerateArgs {
    /// The folder to write to.
    #[arg(long, value_name = "DIR", default_value = "scenes")]
    out: PathBuf,
}

pub fn run(args: &GenerateArgs) -> Result<()> {
    std::fs::create_dir_all(&args.out).map_err(|e| {
        Problem::failure("unwritable", format!("can't make the folder `{}`: {e}", args.out.display()))
    })?;
    for (name, make) in generate::ALL {
        let path = args.out.join(name);
        picture::write_bytes(&path, &make())?;
        print(&format!("{}\n", path.display()));
    }
    Ok(())
}
