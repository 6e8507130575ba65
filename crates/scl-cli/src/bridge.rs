//! `scl bridge`: the messages of a running system for other programs.

use crate::load::TOPOLOGY;
use crate::observed::SystemArgument;
use clap::{Args, Subcommand};
use scl::tap::{Observation, ObservedKind, TapEvent};
use scl_observe::{ObservedGate, Selection, StopSignals, System, Taps, TapsEvent, block_on};
use scl_record::format::{Part, Topic};
use scl_terminal::{Problem, print_out};
use scl_value::{GateTypes, to_json};
use std::path::Path;
use std::process::ExitCode;
use zeromq::{PubSocket, Socket, SocketSend, ZmqMessage};

/// Pass the messages of a running system on to another program.
#[derive(Args)]
pub(crate) struct BridgeArguments {
    #[command(subcommand)]
    to: To,
}

#[derive(Subcommand)]
enum To {
    Plotjuggler(PlotjugglerArguments),
}

/// Publish messages for PlotJuggler, which plots their numbers as they come.
///
/// In PlotJuggler, start the streaming of `ZMQ Subscriber` with the protocol JSON, at the printed address. Each message
/// has three frames: the topic, as in recordings (`/sensor/measurements`), the message as JSON, and the seconds since
/// 1970 at which it was sent. Components notice nothing; what PlotJuggler reads too slowly is dropped for it alone.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl bridge plotjuggler
  scl bridge plotjuggler sensor controller.actuator
  scl bridge plotjuggler --listen tcp://0.0.0.0:9872       for another machine

Exit code: 0 stopped with Ctrl-C, 2 no such gate or system, or the address is in use.")]
struct PlotjugglerArguments {
    /// Gates, as `component.gate`, or components [default: all gates].
    #[arg(value_name = "GATE|COMPONENT")]
    gates: Vec<String>,
    /// Where PlotJuggler connects.
    #[arg(long, value_name = "ADDRESS", default_value = "tcp://127.0.0.1:9872")]
    listen: String,
    #[command(flatten)]
    system: SystemArgument,
}

/// A gate, and how its messages are published.
struct Published {
    gate: ObservedGate,
    types: GateTypes,
}

/// The body of `scl bridge`.
pub(crate) fn bridge(arguments: &BridgeArguments) -> Result<ExitCode, Problem> {
    let To::Plotjuggler(arguments) = &arguments.to;
    block_on(publish(arguments))
}

async fn publish(arguments: &PlotjugglerArguments) -> Result<ExitCode, Problem> {
    let mut stop = StopSignals::watch()?;
    let system = System::find_or_await(arguments.system.name())?;
    let selection = Selection::new(&system, &arguments.gates, &[], Path::new(TOPOLOGY))?;
    let mut socket = PubSocket::new();
    let address = socket.bind(&arguments.listen).await.map_err(|error| {
        Problem::new(format!("cannot listen at {}: {error}", arguments.listen))
            .help("choose another address with `--listen`, for example `tcp://127.0.0.1:9873`")
    })?;
    print_out(&format!("{address}\n"));
    let mut taps = Taps::follow_all(&system, move |gate| selection.includes(gate));
    let mut gates: Vec<Published> = Vec::new();
    loop {
        let event = tokio::select! {
            () = stop.received() => break,
            event = taps.next() => event,
        };
        for gate in &taps.gates()[gates.len()..] {
            gates.push(Published::new(gate.clone()));
        }
        if let TapsEvent::Event { gate, event: TapEvent::Observed(seen) } = event {
            // Fails only if no subscriber takes it.
            _ = socket.send(gates[gate].frames(&seen)).await;
        }
    }
    Ok(ExitCode::SUCCESS)
}

impl Published {
    fn new(gate: ObservedGate) -> Self {
        let types = GateTypes::new(gate.payload.types(), &gate.codec, gate.schema.as_deref());
        Self { gate, types }
    }

    /// Topic, message and time.
    fn frames(&self, seen: &Observation) -> ZmqMessage {
        let part = match seen.kind {
            ObservedKind::Message => Part::Message,
            ObservedKind::Request => Part::Request,
            ObservedKind::Reply => Part::Reply,
        };
        let topic = Topic { component: self.gate.component.clone(), gate: self.gate.gate.clone(), part }.to_string();
        let messages = self.types.of(part == Part::Reply);
        let text = to_json(&messages.for_json(messages.show(&seen.payload))).to_string();
        let mut frames = ZmqMessage::from(topic);
        frames.push_back(text.into());
        frames.push_back(format!("{:.6}", seen.sent_ns as f64 / 1e9).into());
        frames
    }
}
