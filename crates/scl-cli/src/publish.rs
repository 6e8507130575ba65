//! `scl pub`: sends messages in place of a component.

mod messages;
mod sender;

use crate::play::{Plans, PlayArguments, message_type};
use clap::Args;
use messages::Messages;
use scl_observe::{StopSignals, block_on, problem_of};
use scl_plan::{GateKind, GatePlan, Plan};
use scl_terminal::{Problem, parse_duration, print_err, quoted_list};
use sender::Sender;
use std::io::{self, IsTerminal};
use std::num::NonZeroU64;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// How long closing waits until the peers have taken all messages.
const FLUSH: Duration = Duration::from_secs(5);

/// Messages per second with `-n` but without `--rate`.
const DEFAULT_RATE: f64 = 1.0;

/// Send messages at a `pub` or `push` gate, in place of its component, which must not be running.
///
/// The component is opened as its program would open it, so its peers cannot tell the difference. Its `pull` and `rep`
/// gates stay closed, because nothing would handle their messages. The first message is sent when all required peers of
/// the gate, and all others that run, are connected; at the end, everything is handed over before the component is
/// closed.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl pub sensor.measurements '{speed: 1.0}'
  scl pub sensor.measurements '{speed: 1.0}' --rate 10         ten a second, until Ctrl-C
  scl pub sensor.measurements '{speed: 1.0}' --rate 100 -n 500
  scl pub camera.image '{hex: 00ff10}'                         bytes
  scl pub sensor.measurements - < messages.yaml                one message per document
  scl echo sensor.measurements --format json | jq -c .message > messages.jsonl
  scl pub sensor.measurements - --rate 50 < messages.jsonl     one message per line

Exit code: 0 all sent and taken, or stopped with Ctrl-C; 2 the component runs, peers are missing, or a message is
wrong.")]
pub(crate) struct PubArguments {
    /// The gate, as `component.gate`.
    gate: String,
    /// The message, as YAML or JSON; `-` reads YAML documents or JSON lines from standard input, one message each.
    #[arg(allow_hyphen_values = true)]
    message: String,
    /// Send this many messages a second [default with -n: 1].
    #[arg(long, value_name = "HZ", value_parser = parse_rate)]
    rate: Option<f64>,
    /// End after this many messages [default: 1; with --rate: until Ctrl-C; from standard input: all].
    #[arg(short = 'n', long, value_name = "N")]
    count: Option<NonZeroU64>,
    /// How long to wait for the peers of the gate.
    #[arg(long, value_name = "TIME", default_value = "5s", value_parser = parse_duration)]
    ready: Duration,
    #[command(flatten)]
    play: PlayArguments,
}

fn parse_rate(text: &str) -> Result<f64, String> {
    let rate: Option<f64> = text.trim_end_matches("Hz").trim().parse().ok();
    // The timer counts whole nanoseconds, which is too coarse for much higher rates.
    let usable = rate.filter(|rate| (1e-6..=1e6).contains(rate));
    usable.ok_or_else(|| "expected messages per second, from 0.000001 to 1000000".to_owned())
}

/// The body of `scl pub`.
pub(crate) fn publish(arguments: &PubArguments) -> Result<ExitCode, Problem> {
    block_on(run(arguments))
}

async fn run(arguments: &PubArguments) -> Result<ExitCode, Problem> {
    let plans = Plans::find(&arguments.play)?;
    let (plan, gate) = plans.gate(&arguments.gate)?;
    check_kind(&plan, &gate)?;
    if arguments.message.trim().is_empty() {
        return Err(Problem::new("the message is empty").help("write `{}` for one with defaults"));
    }
    let messages = message_type(&plan, &gate, gate.payload.types().next())?;
    let mut messages =
        Messages::new(&arguments.message, messages, arguments.rate.is_some() || arguments.count.is_some())?;
    let mut stop = StopSignals::watch()?;
    let mut component = plans.open(&plan).await?;
    let mut sender = Sender::take(&mut component, &gate.name)?;
    tokio::select! {
        ready = sender.wait_for_peers(&component, &plans, &gate, arguments.ready) => ready?,
        () = stop.received() => return Ok(ExitCode::SUCCESS),
    }
    let started = Instant::now();
    let sent = send_all(arguments, &mut messages, &mut sender, &mut stop).await;
    drop(sender);
    let closed = component.close(FLUSH).await.map_err(|error| problem_of(&error));
    let sent = sent?;
    closed?;
    if io::stderr().is_terminal() {
        let seconds = started.elapsed().as_secs_f64();
        print_err(&format!("sent {sent} messages at `{}` in {seconds:.1} s\n", arguments.gate));
    }
    Ok(ExitCode::SUCCESS)
}

/// Sends the messages, and returns how many were sent.
async fn send_all(
    arguments: &PubArguments,
    messages: &mut Messages,
    sender: &mut Sender,
    stop: &mut StopSignals,
) -> Result<u64, Problem> {
    let rate = arguments.rate.or(arguments.count.filter(|_| !messages.are_from_input()).map(|_| DEFAULT_RATE));
    let timer = rate.map(|rate| scl::time::interval(Duration::from_secs_f64(1.0 / rate))).transpose();
    let mut timer = timer.map_err(|error| timer_problem(&error))?;
    let mut sent = 0;
    while arguments.count.is_none_or(|count| sent < count.get()) {
        if let Some(timer) = timer.as_mut().filter(|_| sent > 0) {
            tokio::select! {
                ticked = timer.tick() => ticked.map_err(|error| timer_problem(&error))?,
                () = stop.received() => break,
            }
        }
        let message = tokio::select! {
            message = messages.next() => message?,
            () = stop.received() => break,
        };
        let Some(message) = message else { break };
        tokio::select! {
            // With `when_full: wait`, a slow peer may block the send.
            result = sender.send(&message) => result?,
            () = stop.received() => break,
        }
        sent += 1;
    }
    Ok(sent)
}

fn timer_problem(error: &io::Error) -> Problem {
    Problem::new(format!("the timer of `--rate` has failed: {error}"))
}

/// Returns an error unless the gate is a `pub` or `push` gate: no other kind sends messages by itself.
fn check_kind(plan: &Plan, gate: &GatePlan) -> Result<(), Problem> {
    if matches!(gate.kind, GateKind::Pub | GateKind::Push) {
        return Ok(());
    }
    let name = format!("{}.{}", plan.component, gate.name);
    let problem = Problem::new(format!("`{name}` is a `{}` gate and sends no messages by itself", gate.kind.word()));
    let peers: Vec<String> =
        gate.connections.iter().map(|peer| format!("{}.{}", peer.peer_component, peer.peer_gate)).collect();
    let peers_text = quoted_list(&peers);
    Err(match gate.kind {
        GateKind::Rep => problem.help(format!("`scl call {name} REQUEST` sends it a request")),
        GateKind::Req => match peers.first() {
            Some(peer) => problem.help(format!("`scl call {peer} REQUEST --as {}` sends its requests", plan.component)),
            None => problem,
        },
        _ if peers.is_empty() => problem,
        _ => problem.help(format!("it receives from {peers_text}: send there")),
    })
}
