//! `scl complete-gates`: the names that a shell offers where a gate, a component or a parameter is expected.

use clap::Args;
use scl_observe::System;
use scl_terminal::print_out;
use std::process::ExitCode;

/// Print the names of gates that start with PREFIX, one per line.
#[derive(Args)]
pub(crate) struct CompleteGatesArguments {
    /// Names of components instead.
    #[arg(long)]
    components: bool,
    /// Names of parameters instead.
    #[arg(long, conflicts_with = "components")]
    parameters: bool,
    /// The system.
    #[arg(long)]
    system: Option<String>,
    /// What the user has typed so far.
    #[arg(default_value = "", allow_hyphen_values = true)]
    prefix: String,
}

/// The body of `scl complete-gates`. If no system is found, it prints nothing, not even an error: the user is typing.
pub(crate) fn complete_gates(arguments: &CompleteGatesArguments) -> ExitCode {
    let system = arguments.system.as_deref().filter(|name| !name.is_empty());
    if let Ok(system) = System::find(system) {
        let names = names(&system, arguments).into_iter();
        let fitting = names.filter(|name| name.starts_with(&arguments.prefix));
        print_out(&fitting.map(|name| name + "\n").collect::<String>());
    }
    ExitCode::SUCCESS
}

fn names(system: &System, arguments: &CompleteGatesArguments) -> Vec<String> {
    let components = system.components();
    if arguments.components {
        return components.into_iter().map(|component| component.name).collect();
    }
    let running = components.iter().filter(|component| component.is_running());
    if arguments.parameters {
        let named = running.flat_map(|it| it.parameters().map(|(plan, _)| format!("{}.{}", it.name, plan.name)));
        return named.collect();
    }
    let gates = running.flat_map(|it| it.gates().iter().map(|gate| format!("{}.{}", it.name, gate.name)));
    gates.collect()
}
