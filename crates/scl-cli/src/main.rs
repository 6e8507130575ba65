//! The `scl` command: checks, draws and runs SCL systems.
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![cfg_attr(not(test), warn(clippy::print_stdout, reason = "a failed write would go unnoticed"))]

#[cfg(feature = "bench")]
mod bench;
#[cfg(feature = "observe")]
mod bw;
#[cfg(feature = "observe")]
mod call;
mod check;
#[cfg(feature = "record")]
mod compare;
#[cfg(feature = "observe")]
mod complete_gates;
mod completions;
#[cfg(feature = "observe")]
mod delay;
#[cfg(feature = "run")]
mod deploy;
mod diff;
#[cfg(feature = "observe")]
mod doctor;
#[cfg(feature = "observe")]
mod echo;
mod exit;
mod explain;
mod external;
#[cfg(any(feature = "observe", feature = "run"))]
mod format;
#[cfg(feature = "generate")]
mod generate;
mod graph;
#[cfg(feature = "observe")]
mod hz;
#[cfg(feature = "observe")]
mod info;
#[cfg(feature = "observe")]
mod list;
mod load;
#[cfg(feature = "run")]
mod log;
#[cfg(feature = "observe")]
mod measure;
#[cfg(feature = "new")]
mod new;
#[cfg(feature = "observe")]
mod observed;
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
mod restart;
#[cfg(feature = "run")]
mod run;
mod schema;
#[cfg(feature = "run")]
mod stop;
#[cfg(feature = "observe")]
mod top;

use clap::{CommandFactory, Parser, Subcommand};
use scl_terminal::{finish_output, note_failure};
use std::ffi::OsString;
use std::process::ExitCode;

/// Check, draw and run systems made of components that talk through typed gates.
#[derive(Parser)]
#[command(name = "scl", version, arg_required_else_help = true)]
#[command(after_help = "Exit code: 0 fine (or only warnings), 1 errors or a failed component, 2 could not run.

`scl x` runs the program `scl-x` beside `scl` or from PATH if there is no command `x`. One of them is `scl gateway`, which
connects the components of several hosts.")]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[cfg(feature = "bench")]
    Bench(scl_bench::BenchArguments),
    #[cfg(feature = "bench")]
    #[command(name = scl_bench::WORKER_COMMAND, hide = true)]
    BenchWorker(bench::WorkerArguments),
    #[cfg(feature = "observe")]
    Bw(bw::BwArguments),
    #[cfg(feature = "observe")]
    Call(call::CallArguments),
    Check(check::CheckArguments),
    #[cfg(feature = "record")]
    Compare(compare::CompareArguments),
    #[cfg(feature = "observe")]
    #[command(name = complete_gates::COMMAND, hide = true)]
    CompleteGates(complete_gates::CompleteGatesArguments),
    Completions(completions::CompletionsArguments),
    #[cfg(feature = "observe")]
    Delay(delay::DelayArguments),
    #[cfg(feature = "run")]
    Deploy(deploy::DeployArguments),
    Diff(diff::DiffArguments),
    #[cfg(feature = "observe")]
    Doctor(doctor::DoctorArguments),
    #[cfg(feature = "observe")]
    Echo(echo::EchoArguments),
    Explain(explain::ExplainArguments),
    #[cfg(feature = "generate")]
    Generate(generate::GenerateArguments),
    Graph(graph::GraphArguments),
    #[cfg(feature = "observe")]
    Hz(hz::HzArguments),
    #[cfg(feature = "observe")]
    Info(info::InfoArguments),
    #[cfg(feature = "observe")]
    List(list::ListArguments),
    #[cfg(feature = "run")]
    Log(log::LogArguments),
    #[cfg(feature = "new")]
    New(new::NewArguments),
    Plan(plan::PlanArguments),
    #[cfg(feature = "observe")]
    #[command(name = "pub")]
    Publish(publish::PubArguments),
    #[cfg(feature = "record")]
    Record(record::RecordArguments),
    #[cfg(feature = "record")]
    Recover(recover::RecoverArguments),
    #[cfg(feature = "record")]
    Replay(replay::ReplayArguments),
    #[cfg(feature = "run")]
    Restart(restart::RestartArguments),
    #[cfg(feature = "run")]
    Run(run::RunArguments),
    Schema(schema::SchemaArguments),
    #[cfg(feature = "run")]
    Stop(stop::StopArguments),
    #[cfg(feature = "observe")]
    Top(top::TopArguments),
    #[cfg(feature = "run")]
    #[command(name = run::START_WORD, hide = true)]
    Start(run::StartArguments),
    #[cfg(feature = "run")]
    #[command(name = run::GUARD_WORD, hide = true)]
    Guard {
        run_mark: String,
    },
    #[cfg(feature = "run")]
    #[command(name = run::KEYS_WORD, hide = true)]
    Keys,
    /// A program `scl-x` of the user's, as `scl x`.
    #[command(external_subcommand)]
    External(Vec<OsString>),
}

fn main() -> ExitCode {
    finish_output(match CommandLine::try_parse() {
        Ok(command_line) => run_command(command_line.command),
        // `--help` and `--version` are output, too.
        Err(error) => {
            let printed = error.print();
            if !error.use_stderr() {
                note_failure(printed);
            }
            ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(u8::MAX))
        }
    })
}

fn run_command(command: Command) -> ExitCode {
    match command {
        #[cfg(feature = "bench")]
        Command::Bench(arguments) => exit::exit_code(bench::bench(&arguments)),
        #[cfg(feature = "bench")]
        Command::BenchWorker(arguments) => exit::exit_code(bench::run_worker(&arguments)),
        #[cfg(feature = "observe")]
        Command::Bw(arguments) => bw::bw(&arguments),
        #[cfg(feature = "observe")]
        Command::Call(arguments) => call::call(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        #[cfg(feature = "record")]
        Command::Compare(arguments) => compare::compare(&arguments),
        #[cfg(feature = "observe")]
        Command::CompleteGates(arguments) => complete_gates::complete_gates(&arguments),
        Command::Completions(arguments) => completions::print_completions(&arguments, &CommandLine::command()),
        #[cfg(feature = "observe")]
        Command::Delay(arguments) => delay::delay(&arguments),
        #[cfg(feature = "run")]
        Command::Deploy(arguments) => deploy::deploy(&arguments),
        Command::Diff(arguments) => diff::diff(&arguments),
        #[cfg(feature = "observe")]
        Command::Doctor(arguments) => doctor::doctor(&arguments),
        #[cfg(feature = "observe")]
        Command::Echo(arguments) => echo::echo(&arguments),
        Command::Explain(arguments) => explain::explain(&arguments),
        #[cfg(feature = "generate")]
        Command::Generate(arguments) => generate::generate(&arguments),
        Command::Graph(arguments) => graph::graph(&arguments),
        #[cfg(feature = "observe")]
        Command::Hz(arguments) => hz::hz(&arguments),
        #[cfg(feature = "observe")]
        Command::Info(arguments) => info::info(&arguments),
        #[cfg(feature = "observe")]
        Command::List(arguments) => list::list(&arguments),
        #[cfg(feature = "run")]
        Command::Log(arguments) => log::log(&arguments),
        #[cfg(feature = "new")]
        Command::New(arguments) => new::new(&arguments),
        Command::Plan(arguments) => plan::plan(&arguments),
        #[cfg(feature = "observe")]
        Command::Publish(arguments) => publish::publish(&arguments),
        #[cfg(feature = "record")]
        Command::Record(arguments) => record::record(&arguments),
        #[cfg(feature = "record")]
        Command::Recover(arguments) => recover::recover(&arguments),
        #[cfg(feature = "record")]
        Command::Replay(arguments) => replay::replay(&arguments),
        #[cfg(feature = "run")]
        Command::Restart(arguments) => restart::restart(&arguments),
        #[cfg(feature = "run")]
        Command::Run(arguments) => run::run(&arguments),
        Command::Schema(arguments) => schema::schema(&arguments),
        #[cfg(feature = "run")]
        Command::Stop(arguments) => stop::stop(&arguments),
        #[cfg(feature = "observe")]
        Command::Top(arguments) => top::top(&arguments),
        #[cfg(feature = "run")]
        Command::Start(arguments) => run::start_component(&arguments),
        #[cfg(feature = "run")]
        Command::Guard { run_mark } => run::keep_watch(&run_mark),
        #[cfg(feature = "run")]
        Command::Keys => run::tell_keys(),
        Command::External(words) => external::run_external(&words, &CommandLine::command()),
    }
}
