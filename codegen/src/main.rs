//! The command `zonal`: reads arguments, calls the library, prints. It decides nothing about kernels.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
