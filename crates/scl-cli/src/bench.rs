//! `scl bench`: compares SCL with raw sockets and other libraries on this machine.

use clap::Args;
use scl_bench::BenchArguments;
use scl_terminal::{Problem, print_out};
use std::process::ExitCode;

/// The arguments of a worker process.
#[derive(Args)]
pub(crate) struct WorkerArguments {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<String>,
}

pub(crate) fn bench(arguments: &BenchArguments) -> Result<ExitCode, Problem> {
    finish(arguments.measure().map(|report| print_out(&report)))
}

pub(crate) fn run_worker(arguments: &WorkerArguments) -> Result<ExitCode, Problem> {
    finish(scl_bench::run_worker(&arguments.arguments))
}

fn finish(result: scl_bench::Result<()>) -> Result<ExitCode, Problem> {
    result.map(|()| ExitCode::SUCCESS).map_err(|error| Problem::new(format!("{error:?}")))
}
