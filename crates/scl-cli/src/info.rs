//! `scl info`: everything about one gate, or one component and its gates in short, or what is in a recording.

#[cfg(feature = "record")]
mod recording;
mod text;

use crate::format::FormatArgument;
use crate::observed::SystemArgument;
use clap::Args;
use scl_observe::{Component, GateRate, System, rates};
use scl_terminal::Problem;
use serde_json::Value;
use std::process::ExitCode;
use std::time::{Duration, SystemTime};

/// How long to wait for a second reading of the figures. A component writes them twice a second by default.
const PATIENCE: Duration = Duration::from_secs(2);

/// Show everything about a gate, or about a component and its gates, or what is in a recording.
///
/// Type, codec, queue, contract and peers are those that the running program was built with. Rates are measured between
/// two figures that the component writes, half a second apart by default.
///
/// A name with a slash or the ending `.mcap` is that of a recording, which is read completely.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl info controller.sensor               a gate
  scl info controller                      a component
  scl info controller.sensor --format json
  scl info flight.mcap                     a recording

Exit code: 0 shown, 2 there is no such system, component, gate or recording, or the component is not running.")]
pub(crate) struct InfoArguments {
    /// The gate, the component or the recording.
    #[arg(value_name = "GATE|COMPONENT|FILE")]
    name: String,
    #[command(flatten)]
    system: SystemArgument,
    #[command(flatten)]
    format: FormatArgument,
}

/// The body of `scl info`.
pub(crate) fn info(arguments: &InfoArguments) -> Result<ExitCode, Problem> {
    #[cfg(feature = "record")]
    if recording::is_recording(&arguments.name) {
        recording::print_recording(&arguments.name, arguments.format)?;
        return Ok(ExitCode::SUCCESS);
    }
    let system = System::find(arguments.system.name())?;
    let (component, gate) = system.component_and_gate(&arguments.name)?;
    let reading = Reading::take(&system, component);
    arguments.format.print(|| reading.to_json(gate), || reading.text(gate));
    Ok(ExitCode::SUCCESS)
}

/// A component, and the rates of its gates.
struct Reading {
    component: Component,
    /// In the plan's order; `None` without two readings of the figures.
    rates: Option<Vec<GateRate>>,
    now: SystemTime,
}

impl Reading {
    fn take(system: &System, mut component: Component) -> Self {
        let mut found = None;
        let writes = component.is_running() && component.silent_for(SystemTime::now()).is_none();
        if writes
            && let (Some(plan), Some(earlier)) = (component.plan(), &component.stats)
            && let Some(later) = system.newer_stats(&component.name, earlier, PATIENCE)
        {
            found = rates(plan, earlier, &later);
            component.stats = Some(later);
        }
        Self { component, rates: found, now: SystemTime::now() }
    }

    fn rate(&self, gate: usize) -> Option<GateRate> {
        self.rates.as_ref()?.get(gate).copied()
    }

    fn to_json(&self, gate: Option<usize>) -> Value {
        let gate_to_json = |gate| self.component.gate_to_json(gate, self.rate(gate));
        let component = self.component.to_json(self.now);
        if let Some(gate) = gate {
            let mut value = gate_to_json(gate);
            value["component"] = component;
            return value;
        }
        let mut value = component;
        value["parameters"] = self.component.parameters_to_json();
        value["gates"] = (0..self.component.gates().len()).map(gate_to_json).collect();
        value
    }
}
