//! The `scl` command: checks, draws and runs SCL systems.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod bench;
mod check;
mod completions;
mod diff;
mod duration;
mod explain;
mod graph;
mod load;
mod plan;
mod print;
mod run;
mod schema;

use clap::{CommandFactory, Parser, Subcommand};
use std::process::ExitCode;

/// Checks, draws and runs systems made of components that talk through typed gates.
#[derive(Parser)]
#[command(name = "scl", version, arg_required_else_help = true)]
#[command(after_help = "Exit code: 0 fine (or only warnings), 1 errors or a failed component, 2 could not run.")]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Bench(bench::BenchArguments),
    #[command(name = bench::WORKER_COMMAND, hide = true)]
    BenchWorker(bench::WorkerArguments),
    Check(check::CheckArguments),
    Completions(completions::CompletionsArguments),
    Diff(diff::DiffArguments),
    Explain(explain::ExplainArguments),
    Graph(graph::GraphArguments),
    Plan(plan::PlanArguments),
    Run(run::RunArguments),
    Schema(schema::SchemaArguments),
    #[command(name = run::START_WORD, hide = true)]
    Start(run::StartArguments),
    #[command(name = run::GUARD_WORD, hide = true)]
    Guard,
}

fn main() -> ExitCode {
    match CommandLine::parse().command {
        Command::Bench(arguments) => bench::bench(&arguments),
        Command::BenchWorker(arguments) => bench::run_worker(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Completions(arguments) => completions::print_completions(&arguments, &CommandLine::command()),
        Command::Diff(arguments) => diff::diff(&arguments),
        Command::Explain(arguments) => explain::explain(&arguments),
        Command::Graph(arguments) => graph::graph(&arguments),
        Command::Plan(arguments) => plan::plan(&arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Schema(arguments) => schema::schema(&arguments),
        Command::Start(arguments) => run::start_component(&arguments),
        Command::Guard => run::keep_watch(),
    }
}
