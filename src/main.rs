//! The `voxgi` command.

fn main() -> std::process::ExitCode {
    voxgi::cli::main()
}
