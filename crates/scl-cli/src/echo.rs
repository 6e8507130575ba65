//! `scl echo`: the messages that pass gates.

mod output;
mod watched;

use crate::load::TOPOLOGY;
use crate::observed::SystemArgument;
use clap::{Args, ValueEnum};
use output::Output;
use scl::tap::TapEvent;
use scl_observe::{ObservedGate, Selection, StopSignals, System, Taps, TapsEvent, at_taps, block_on};
use scl_terminal::{Problem, output_is_closed, parse_duration, print_err, quoted_list};
use scl_value::{Condition, FieldPath, Value};
use std::io::{self, IsTerminal};
use std::num::NonZeroU64;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;
use tokio::time::{Instant, sleep_until};
use watched::Watched;

/// Show the messages that pass gates, decoded: messages of `pub` and `push` gates, requests and replies of `rep` gates.
///
/// Nothing is restarted, and no gate is delayed: messages that this program is too slow to read are dropped for it
/// alone, and are noted on standard error. If a component is not running yet, or stops, this command waits for it. A
/// payload that is not the gate's type is shown as bytes, with the reason.
///
/// At a gate that receives, the messages are shown where they come from; those of a `req` gate at the gate that
/// answers, with all its requests.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl echo sensor.measurements
  scl echo sensor                                     all that a component sends at its `pub` gates
  scl echo sensor.measurements --field speed --field pose.x
  scl echo sensor.measurements --where \"speed > 1.5 and mode == 'AUTO'\"
  scl echo controller.commands                        requests and replies, with the number of their call
  scl echo sensor.measurements --once --timeout 2s    is anything sent?
  scl echo sensor.measurements controller.actuator --format json | jq .message
  scl echo sensor.measurements --format csv > speed.csv

Exit code: 0 shown, or stopped with Ctrl-C; 1 no message within --timeout; 2 no such gate, field or system, or
standard output could not be written.")]
pub(crate) struct EchoArguments {
    /// Gates, as `component.gate`, or components, for their `pub`, `rep` and `pull` gates.
    #[arg(required = true, value_name = "GATE|COMPONENT")]
    gates: Vec<String>,
    /// Show this field only, for example `pose.x`, `joints[0].angle` or `limits."front left"`; may be repeated.
    #[arg(long = "field", value_name = "PATH")]
    fields: Vec<FieldPath>,
    /// Show only messages for which this holds, for example `speed > 1.5`. Operators: == != < <= > >= contains, and,
    /// or, not and parentheses; put texts in quotes. A comparison of a field that a message does not have is false.
    #[arg(long = "where", value_name = "CONDITION")]
    condition: Option<Condition>,
    /// End after one message.
    #[arg(long, conflicts_with = "count")]
    once: bool,
    /// End after this many messages.
    #[arg(short = 'n', long, value_name = "N")]
    count: Option<NonZeroU64>,
    /// End with exit code 1 when no message was shown for this long: `2s`.
    #[arg(long, value_name = "TIME", value_parser = parse_duration)]
    timeout: Option<Duration>,
    /// How to show messages.
    #[arg(long, value_enum, default_value_t = MessageFormat::Yaml, value_name = "FORMAT")]
    format: MessageFormat,
    #[command(flatten)]
    system: SystemArgument,
}

/// How messages are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MessageFormat {
    /// One document per message, as `scl pub` reads it.
    Yaml,
    /// One object per line, with gate, time, sequence, kind and message.
    Json,
    /// One row per message, one column per field; lists and maps as JSON.
    Csv,
}

/// The body of `scl echo`.
pub(crate) fn echo(arguments: &EchoArguments) -> Result<ExitCode, Problem> {
    block_on(run(arguments))
}

async fn run(arguments: &EchoArguments) -> Result<ExitCode, Problem> {
    let mut stop = StopSignals::watch()?;
    let system = System::find_or_await(arguments.system.name())?;
    let selection = Selection::new(&system, &arguments.gates, &[], Path::new(TOPOLOGY))?;
    note_where_seen(&system, &selection, &arguments.gates);
    let mut taps = Taps::follow_all(&system, {
        let selection = selection.clone();
        move |gate| selection.includes(gate)
    });
    // `taps` reports these gates as started, too; skip those events.
    let mut known = taps.gates().len();
    let mut watched: Vec<Watched> = taps.gates().iter().cloned().map(Watched::new).collect();
    let mut output = Output::new(arguments.format, &arguments.fields, !selection.is_one_gate());
    check_all(arguments, &selection, taps.gates(), &watched)?;
    output.learn(&watched);
    let limit = if arguments.once { Some(1) } else { arguments.count.map(NonZeroU64::get) };
    let (started, mut shown, mut last) = (Instant::now(), 0, Instant::now());
    loop {
        let silence = async {
            match arguments.timeout {
                Some(timeout) => sleep_until(last + timeout).await,
                None => std::future::pending().await,
            }
        };
        let (gate, event) = tokio::select! {
            () = stop.received() => break,
            () = silence => {
                watched.iter_mut().for_each(Watched::note_lost);
                return Ok(report_silence(arguments, shown));
            }
            event = taps.next() => match event {
                TapsEvent::Event { gate, event } => (gate, event),
                TapsEvent::Started(gate) => {
                    if known > 0 {
                        known -= 1;
                        continue;
                    }
                    print_err(&format!("note: `{}` has started\n", gate.name()));
                    watched.push(Watched::new(gate));
                    check_all(arguments, &selection, taps.gates(), &watched)?;
                    output.learn(&watched);
                    continue;
                }
            },
        };
        let Some(gate) = watched.get_mut(gate) else { continue };
        let seen = match event {
            TapEvent::Connected => {
                gate.connected(&system);
                continue;
            }
            TapEvent::Disconnected => {
                gate.disconnected();
                continue;
            }
            TapEvent::Observed(seen) => seen,
        };
        gate.count(&seen);
        let message = gate.decode(&seen);
        if let Some(condition) = &arguments.condition
            && !condition.holds(&message)?
        {
            continue;
        }
        // A request does not have the fields of its reply.
        if output.shows_several_types() && !has_any(&message, &arguments.fields) {
            continue;
        }
        output.print(gate, &seen, &message);
        if output_is_closed() {
            return Ok(ExitCode::SUCCESS);
        }
        (shown, last) = (shown + 1, Instant::now());
        if limit == Some(shown) {
            break;
        }
    }
    watched.iter_mut().for_each(Watched::note_lost);
    if limit != Some(shown) && io::stderr().is_terminal() {
        let lost: u64 = watched.iter().map(|gate| gate.lost).sum();
        let seconds = started.elapsed().as_secs_f64();
        print_err(&format!("{shown} messages in {seconds:.1} s, {lost} lost\n"));
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints which of the named gates and components are not running yet, and at which gates the messages of receiving
/// gates are shown.
fn note_where_seen(system: &System, selection: &Selection, names: &[String]) {
    for name in selection.waiting() {
        print_err(&format!("note: `{name}` is not running; waiting until it starts\n"));
    }
    let named = names.iter().filter_map(|name| system.gate(name).ok());
    for gate in named.filter(|gate| gate.taps.first().is_some_and(|tap| tap.component != gate.component)) {
        let senders: Vec<String> = at_taps(std::slice::from_ref(&gate)).iter().map(ObservedGate::name).collect();
        let senders = quoted_list(&senders);
        print_err(&format!("note: the messages of `{}` are observed at {senders}\n", gate.name()));
    }
}

/// Checks the fields and the condition, as soon as all gates are known.
fn check_all(
    arguments: &EchoArguments,
    selection: &Selection,
    gates: &[ObservedGate],
    watched: &[Watched],
) -> Result<(), Problem> {
    if !selection.is_complete(gates) {
        return Ok(());
    }
    for path in &arguments.fields {
        check_field(watched, |gate| gate.check_field(path))?;
    }
    match &arguments.condition {
        Some(condition) => check_field(watched, |gate| gate.check_condition(condition)),
        None => Ok(()),
    }
}

/// Returns the first error if `check` fails for every gate: fields and conditions must fit at least one.
fn check_field<E: Into<Problem>>(gates: &[Watched], check: impl Fn(&Watched) -> Result<(), E>) -> Result<(), Problem> {
    let mut errors = gates.iter().map(check);
    match errors.next() {
        Some(Err(first)) if errors.all(|result| result.is_err()) => Err(first.into()),
        _ => Ok(()),
    }
}

fn report_silence(arguments: &EchoArguments, shown: u64) -> ExitCode {
    let gates = quoted_list(&arguments.gates);
    let waited = arguments.timeout.unwrap_or_default();
    let (more, matching) = (
        if shown > 0 { " more" } else { "" },
        if arguments.condition.is_some() { " that meets the condition" } else { "" },
    );
    let problem = Problem::new(format!("no{more} message{matching} at {gates} within {waited:?}"));
    print_err(&problem.help("`scl info GATE` shows peers and rates").to_string());
    ExitCode::FAILURE
}

/// Whether a message has at least one of the fields. True if there are no fields, and for a payload shown as bytes.
fn has_any(message: &Value, fields: &[FieldPath]) -> bool {
    fields.is_empty() || matches!(message, Value::Opaque(_)) || fields.iter().any(|path| path.find(message).is_some())
}

/// The parts of a message that are shown: the fields, or all of it.
fn selected(message: &Value, fields: &[FieldPath]) -> Value {
    let find = |path: &FieldPath| path.find(message).cloned().unwrap_or(Value::Null);
    match fields {
        _ if matches!(message, Value::Opaque(_)) => message.clone(),
        [] => message.clone(),
        [one] => find(one),
        fields => Value::Map(fields.iter().map(|path| (path.to_string().into(), find(path))).collect()),
    }
}
