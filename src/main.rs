//! The command `dalembert`.

use std::process::ExitCode;

fn main() -> ExitCode {
    dalembert::cli::main()
}
