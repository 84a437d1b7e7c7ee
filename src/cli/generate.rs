//! `voxgi generate`: writes the scenes that need no model from elsewhere.

use super::print;
use crate::picture;
use crate::problem::{Problem, Result};
use crate::scene::generate::{self, Generated};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct GenerateArgs {
    /// Which: `cornell-box`, `cornell-point`, `triangle`, `hairball`. Default: the first two, which voxgi's repository has.
    #[arg(value_name = "SCENE", value_parser = scene)]
    scenes: Vec<Generated>,
    /// The folder to write to.
    #[arg(long, value_name = "DIR", default_value = "scenes")]
    out: PathBuf,
}

pub fn run(args: &GenerateArgs) -> Result<()> {
    std::fs::create_dir_all(&args.out).map_err(|e| {
        Problem::failure("unwritable", format!("can't make the folder `{}`: {e}", args.out.display()))
    })?;
    let scenes = if args.scenes.is_empty() { &generate::ALL[..] } else { &args.scenes };
    for (name, make) in scenes {
        let path = args.out.join(name);
        picture::write_bytes(&path, &make())?;
        print(&format!("{}\n", path.display()));
    }
    Ok(())
}

fn scene(name: &str) -> std::result::Result<Generated, String> {
    generate::find(name).ok_or_else(|| "no scene is made under this name".to_owned())
}
