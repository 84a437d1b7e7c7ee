//! Writes the generated scenes into a folder, `scenes` unless another is named:
//! `cargo run --release --example generate_scenes [FOLDER]`.

use std::path::PathBuf;
use voxgi::scene::generate::ALL;

fn main() -> std::io::Result<()> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("scenes"), PathBuf::from);
    for (name, make) in ALL {
        std::fs::write(folder.join(name), make())?;
        println!("{}", folder.join(name).display());
    }
    Ok(())
}
