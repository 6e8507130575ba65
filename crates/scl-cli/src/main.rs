//! The `scl` command: checks, draws and runs SCL systems.
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![cfg_attr(not(test), warn(clippy::print_stdout, reason = "a failed write would go unnoticed"))]

#[cfg(feature = "bench")]
mod bench;
#[cfg(feature = "bridge")]
mod bridge;
#[cfg(feature = "observe")]
mod call;
mod check;
#[cfg(feature = "record")]
mod compare;
#[cfg(feature = "observe")]
mod complete_gates;
mod completions;
#[cfg(feature = "run")]
mod deploy;
mod diff;
#[cfg(feature = "observe")]
mod doctor;
#[cfg(feature = "observe")]
mod echo;
mod exit;
mod expand;
mod explain;
mod external;
mod format;
#[cfg(feature = "generate")]
mod generate;
mod graph;
#[cfg(feature = "observe")]
mod info;
#[cfg(feature = "observe")]
mod list;
mod load;
#[cfg(feature = "run")]
mod log;
#[cfg(feature = "observe")]
mod measure;
#[cfg(feature = "observe")]
mod meters;
#[cfg(feature = "watch")]
mod metrics;
#[cfg(feature = "new")]
mod new;
#[cfg(feature = "observe")]
mod observed;
#[cfg(feature = "observe")]
mod parameters;
mod plan;
#[cfg(feature = "observe")]
mod play;
#[cfg(feature = "observe")]
mod publish;
#[cfg(feature = "observe")]
mod quantity;
#[cfg(feature = "record")]
mod record;
#[cfg(feature = "record")]
mod recover;
#[cfg(feature = "record")]
mod replay;
#[cfg(feature = "run")]
mod request;
#[cfg(feature = "run")]
mod run;
mod schema;
#[cfg(feature = "watch")]
mod serving;
#[cfg(feature = "simulate")]
mod simulate;
#[cfg(feature = "observe")]
mod top;
#[cfg(feature = "watch")]
mod watch;

use clap::{CommandFactory, Parser, Subcommand};
use exit::Outcome;
use scl_terminal::{finish_output, note_failure};
use std::ffi::OsString;
use std::process::ExitCode;

/// Check, draw and run systems made of components that talk through typed gates.
#[derive(Parser)]
#[command(name = "scl", version, arg_required_else_help = true)]
#[command(after_help = "Exit code: 0 fine (or only warnings), 1 errors or a failed component, 2 could not run.

`scl x` runs the program `scl-x` beside `scl` or from PATH if there is no command `x`. Of SCL, these are `scl gateway`,
which connects the components of several hosts, and `scl foxglove`, which shows a system to Foxglove and Lichtblick.")]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

/// Declares the commands: the feature that each needs, its arguments, and the function that runs it.
macro_rules! commands {
    ($($(#[cfg($needs:meta)])? $(#[command($($clap:tt)*)])? $name:ident($arguments:ty) => $run:expr;)*) => {
        #[derive(Subcommand)]
        enum Command {
            $($(#[cfg($needs)])? $(#[command($($clap)*)])? $name($arguments),)*
            #[cfg(feature = "run")]
            #[command(name = run::GUARD_WORD, hide = true)]
            Guard { run_mark: String },
            #[cfg(feature = "run")]
            #[command(name = run::KEYS_WORD, hide = true)]
            Keys,
            /// A program `scl-x` of the user's, as `scl x`.
            #[command(external_subcommand)]
            External(Vec<OsString>),
        }

        fn run_command(command: Command) -> ExitCode {
            match command {
                $($(#[cfg($needs)])? Command::$name(arguments) => $run(&arguments).exit_code(),)*
                #[cfg(feature = "run")]
                Command::Guard { run_mark } => run::keep_watch(&run_mark),
                #[cfg(feature = "run")]
                Command::Keys => run::tell_keys(),
                Command::External(words) => external::run_external(&words, &CommandLine::command()),
            }
        }
    };
}

commands! {
    #[cfg(feature = "bench")]
    Bench(scl_bench::BenchArguments) => bench::bench;
    #[cfg(feature = "bench")]
    #[command(name = scl_bench::WORKER_COMMAND, hide = true)]
    BenchWorker(bench::WorkerArguments) => bench::run_worker;
    #[cfg(feature = "bridge")]
    Bridge(bridge::BridgeArguments) => bridge::bridge;
    #[cfg(feature = "observe")]
    Bw(meters::BwArguments) => meters::bw;
    #[cfg(feature = "observe")]
    Call(call::CallArguments) => call::call;
    Check(check::CheckArguments) => check::check;
    #[cfg(feature = "record")]
    Compare(compare::CompareArguments) => compare::compare;
    #[cfg(feature = "observe")]
    #[command(hide = true)]
    CompleteGates(complete_gates::CompleteGatesArguments) => complete_gates::complete_gates;
    Completions(completions::CompletionsArguments) => print_completions;
    #[cfg(feature = "observe")]
    Delay(meters::DelayArguments) => meters::delay;
    #[cfg(feature = "run")]
    Deploy(deploy::DeployArguments) => deploy::deploy;
    Diff(diff::DiffArguments) => diff::diff;
    #[cfg(feature = "observe")]
    Doctor(doctor::DoctorArguments) => doctor::doctor;
    #[cfg(feature = "observe")]
    Echo(echo::EchoArguments) => echo::echo;
    Expand(expand::ExpandArguments) => expand::expand;
    Explain(explain::ExplainArguments) => explain::explain;
    #[cfg(feature = "generate")]
    Generate(generate::GenerateArguments) => generate::generate;
    #[cfg(feature = "observe")]
    Get(parameters::GetArguments) => parameters::get;
    Graph(graph::GraphArguments) => graph::graph;
    #[cfg(feature = "observe")]
    Hz(meters::HzArguments) => meters::hz;
    #[cfg(feature = "observe")]
    Info(info::InfoArguments) => info::info;
    #[cfg(feature = "observe")]
    List(list::ListArguments) => list::list;
    #[cfg(feature = "run")]
    Log(log::LogArguments) => log::log;
    #[cfg(feature = "watch")]
    Metrics(metrics::MetricsArguments) => metrics::metrics;
    #[cfg(feature = "new")]
    New(new::NewArguments) => new::new;
    Plan(plan::PlanArguments) => plan::plan;
    #[cfg(feature = "observe")]
    Pub(publish::PubArguments) => publish::publish;
    #[cfg(feature = "record")]
    Record(record::RecordArguments) => record::record;
    #[cfg(feature = "record")]
    Recover(recover::RecoverArguments) => recover::recover;
    #[cfg(feature = "record")]
    Replay(replay::ReplayArguments) => replay::replay;
    #[cfg(feature = "run")]
    Restart(request::RestartArguments) => request::restart;
    #[cfg(feature = "run")]
    Run(run::RunArguments) => run::run;
    Schema(schema::SchemaArguments) => schema::schema;
    #[cfg(feature = "observe")]
    Set(parameters::SetArguments) => parameters::set;
    #[cfg(feature = "simulate")]
    Simulate(simulate::SimulateArguments) => simulate::simulate;
    #[cfg(feature = "simulate")]
    #[command(name = simulate::RUN_WORD, hide = true)]
    SimulateHere(simulate::HereArguments) => simulate::simulate_here;
    #[cfg(feature = "run")]
    Stop(request::StopArguments) => request::stop;
    #[cfg(feature = "observe")]
    Top(top::TopArguments) => top::top;
    #[cfg(feature = "watch")]
    Watch(watch::WatchArguments) => watch::watch;
    #[cfg(feature = "run")]
    #[command(name = run::START_WORD, hide = true)]
    Start(run::StartArguments) => run::start_component;
}

fn print_completions(arguments: &completions::CompletionsArguments) -> ExitCode {
    completions::print_completions(arguments, &CommandLine::command())
}

fn main() -> ExitCode {
    finish_output(match CommandLine::try_parse() {
        Ok(command_line) => run_command(command_line.command),
        // `clap` also returns the output of `--help` and `--version` as an error.
        Err(error) => {
            let printed = error.print();
            if !error.use_stderr() {
                note_failure(printed);
            }
            ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(u8::MAX))
        }
    })
}
