//! `scl call`: sends a request in place of a component, and prints the reply.

use crate::exit::COULD_NOT_DO;
use crate::play::{Plans, PlayArguments, message_type};
use clap::{Args, ValueEnum};
use scl::CallError;
use scl_observe::{StopSignals, block_on, problem_of};
use scl_plan::{ConnectionPlan, GateKind, GatePlan, Plan};
use scl_terminal::{Problem, escape, parse_duration, print_err, print_out, quoted_list};
use scl_value::{MessageType, read_yaml, to_json, to_yaml};
use std::process::ExitCode;
use std::time::Duration;

/// Timeout for closing the component; nothing is left to be sent by then.
const CLOSE: Duration = Duration::from_secs(1);

/// Send a request to a `rep` gate, in place of one of its requesters, and print the reply.
///
/// The requester must not be running. It is opened as its program would open it; its `pull` and `rep` gates stay
/// closed, because nothing would handle their messages.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl call controller.commands                         an example request; nothing is sent
  scl call controller.commands '{target_speed: 0.5}'
  scl call controller.commands '{target_speed: 0.5}' --as user_interface --format json | jq .accepted

Exit code: 0 a reply was printed, 1 no reply within --timeout, 2 no such gate, the component runs, or the request is
wrong or missing.")]
pub(crate) struct CallArguments {
    /// The `rep` gate, as `component.gate`.
    gate: String,
    /// The request, as YAML or JSON; `{}` has the default in each field. If omitted, an example is printed and nothing
    /// is sent.
    #[arg(conflicts_with = "template", allow_hyphen_values = true)]
    request: Option<String>,
    /// The requester to stand in for [default: the only one that is connected to the gate and not running].
    #[arg(long = "as", value_name = "COMPONENT")]
    component: Option<String>,
    /// Print an example request with all its fields, as YAML, and send nothing.
    #[arg(long)]
    template: bool,
    /// How long to wait for the reply, which includes connecting.
    #[arg(long, value_name = "TIME", default_value = "5s", value_parser = parse_duration)]
    timeout: Duration,
    /// How to print the reply.
    #[arg(long, value_enum, default_value_t = ReplyFormat::Yaml, value_name = "FORMAT")]
    format: ReplyFormat,
    #[command(flatten)]
    play: PlayArguments,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ReplyFormat {
    /// As a user would write it.
    Yaml,
    /// One value on one line.
    Json,
}

/// The body of `scl call`.
pub(crate) fn call(arguments: &CallArguments) -> Result<ExitCode, Problem> {
    block_on(run(arguments))
}

async fn run(arguments: &CallArguments) -> Result<ExitCode, Problem> {
    let plans = Plans::find(&arguments.play)?;
    let (plan, gate) = plans.gate(&arguments.gate)?;
    check_kind(&plan, &gate)?;
    let (requests, replies) = types(&plan, &gate)?;
    let written = arguments.request.as_deref().filter(|request| !request.trim().is_empty());
    let Some(request) = written.filter(|_| !arguments.template) else {
        print_template(arguments, &gate, &requests)?;
        return Ok(if arguments.template { ExitCode::SUCCESS } else { without_request(arguments) });
    };
    let request = requests.encode(&read_yaml(request)?)?;
    let requester = find_requester(arguments, &plans, &gate)?;
    let mut component = plans.open(&plans.component(&requester.peer_component)?).await?;
    let mut asks = component.requester(&requester.peer_gate).map_err(|error| problem_of(&error))?;
    let mut stop = StopSignals::watch()?;
    let reply = tokio::select! {
        reply = asks.call_within(&request, arguments.timeout) => reply,
        () = stop.received() => return Ok(ExitCode::FAILURE),
    };
    drop(asks);
    // The call is complete, so a failure to close the component's other gates does not matter.
    let _ = component.close(CLOSE).await;
    match reply {
        Ok(bytes) => {
            let reply = replies.show(&bytes);
            print_out(&match arguments.format {
                ReplyFormat::Yaml => to_yaml(&reply).lines().map(|line| format!("{}\n", escape(line))).collect(),
                ReplyFormat::Json => format!("{}\n", to_json(&replies.for_json(reply))),
            });
            Ok(ExitCode::SUCCESS)
        }
        Err(error @ (CallError::Timeout { connected: true, .. } | CallError::PeerLost { .. })) => {
            print_err(&problem_of(&error).to_string());
            Ok(ExitCode::FAILURE)
        }
        Err(error) => Err(problem_of(&error)),
    }
}

/// Returns an error unless the gate is a `rep` gate: no other kind takes requests.
fn check_kind(plan: &Plan, gate: &GatePlan) -> Result<(), Problem> {
    if gate.kind == GateKind::Rep {
        return Ok(());
    }
    let name = format!("{}.{}", plan.component, gate.name);
    let problem = Problem::new(format!("`{name}` is a `{}` gate, which takes no requests", gate.kind.word()));
    Err(match (gate.kind, gate.connections.first()) {
        (GateKind::Req, Some(peer)) => problem.help(format!(
            "call the gate that answers: `scl call {}.{} REQUEST --as {}`",
            peer.peer_component, peer.peer_gate, plan.component
        )),
        (GateKind::Pub | GateKind::Push, _) => problem.help(format!("`scl pub {name} MESSAGE` sends messages there")),
        _ => problem,
    })
}

fn types(plan: &Plan, gate: &GatePlan) -> Result<(MessageType, MessageType), Problem> {
    let mut types = gate.payload.types();
    Ok((message_type(plan, gate, types.next())?, message_type(plan, gate, types.next())?))
}

/// Reports that the request is missing. A request with defaults is sent only if the user writes it, because it could
/// move an actuator.
fn without_request(arguments: &CallArguments) -> ExitCode {
    let problem = Problem::new("there is no request, so nothing was sent; an example is on standard output");
    print_err(&problem.help(format!("`scl call {} '{{}}'` sends one with defaults", arguments.gate)).to_string());
    ExitCode::from(COULD_NOT_DO)
}

fn print_template(arguments: &CallArguments, gate: &GatePlan, requests: &MessageType) -> Result<(), Problem> {
    let Some(template) = requests.template() else {
        let problem = Problem::new(format!("cannot make an example request for `{}`", arguments.gate));
        return Err(problem.note(format!("its type `{}`, in `{}`, has no schema", gate.payload, gate.codec)));
    };
    print_out(&match arguments.format {
        ReplyFormat::Yaml => to_yaml(&template),
        ReplyFormat::Json => format!("{}\n", to_json(&template)),
    });
    Ok(())
}

/// Finds the gate's connection to the component in whose place the request is sent: the one named with `--as`, else the
/// only one that is not running.
fn find_requester<'g>(
    arguments: &CallArguments,
    plans: &Plans,
    gate: &'g GatePlan,
) -> Result<&'g ConnectionPlan, Problem> {
    let name = &arguments.gate;
    let all = quoted_list(gate.connections.iter().map(|requester| requester.peer_component.as_str()));
    if let Some(component) = &arguments.component {
        return gate.connections.iter().find(|requester| requester.peer_component == *component).ok_or_else(|| {
            let problem = Problem::new(format!("component `{}` is not a requester of `{name}`", escape(component)));
            problem.note(if all.is_empty() { "it has none".to_owned() } else { format!("its requesters: {all}") })
        });
    }
    let stopped = gate.connections.iter().filter(|requester| !plans.is_running(&requester.peer_component));
    let mut stopped: Vec<&ConnectionPlan> = stopped.collect();
    stopped.dedup_by_key(|requester| &requester.peer_component);
    match stopped[..] {
        [one] => Ok(one),
        [] if gate.connections.is_empty() => Err(Problem::new(format!("no component is connected to `{name}`"))
            .help("connect a requester in the topology; `scl call` then stands in for it")),
        [] => {
            let problem = Problem::new(format!("every requester of `{name}` is running"))
                .help("stop one of them; `scl call` then stands in for it");
            let holders = gate.connections.iter().filter_map(|requester| {
                let holder = plans.holder(&requester.peer_component)?;
                Some(format!("`{}` is {holder}", requester.peer_component))
            });
            Err(holders.fold(problem, Problem::note))
        }
        _ => {
            let names = quoted_list(stopped.iter().map(|requester| requester.peer_component.as_str()));
            Err(Problem::new(format!("several requesters of `{name}` are not running"))
                .help(format!("choose one with `--as {}`", stopped[0].peer_component))
                .note(format!("not running: {names}")))
        }
    }
}
