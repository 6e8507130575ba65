//! Plays `left` or `right` of `topologies/matrix/matrix.yaml`: `matrix COMPONENT`, or, with the plan of another
//! topology without generated code, `matrix COMPONENT PLAN_FILE`. The commands are those of all programs in
//! `languages`.

mod left;
mod right;

use scl::bytes::Bytes;
use scl::plan::SystemPlan;
use scl::untyped::Component;
use scl_tests::{say, say_error};
use std::process::ExitCode;
use std::time::Duration;

scl::topology!("topologies/matrix/matrix.yaml");

/// A message of any gate: a number, and a text that contains it.
trait Message {
    fn of(number: u64) -> Self;
    /// The number, or nothing if the text is another one.
    fn number(&self) -> Option<u64>;
}

impl Message for matrix::Sample {
    fn of(number: u64) -> Self {
        Self { number, text: text(number) }
    }

    fn number(&self) -> Option<u64> {
        (self.text == text(self.number)).then_some(self.number)
    }
}

impl Message for Bytes {
    fn of(number: u64) -> Self {
        text(number).into()
    }

    fn number(&self) -> Option<u64> {
        let number = std::str::from_utf8(self).ok()?.split(' ').nth(1)?.parse().ok()?;
        (*self == text(number)).then_some(number)
    }
}

/// Does something with the gate that has a name.
macro_rules! with_gate {
    ($component:ident.$name:ident: [$($gate:ident),*], $found:ident => $action:expr) => {
        match $name {
            $(stringify!($gate) => { let $found = &mut $component.$gate; $action })*
            other => say(format!("no gate {other}")),
        }
    };
}

use with_gate;

fn text(number: u64) -> String {
    format!("sample {number} ü")
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match (arguments[0].as_str(), arguments.get(1)) {
        (component, Some(plan)) => untyped(component, plan),
        ("left", None) => left::main(),
        _ => right::main(),
    }
}

/// Only opens, and tells why it does not find its peers.
fn untyped(component: &str, plan: &str) -> ExitCode {
    let open = || -> scl::Result<Component> {
        let system = SystemPlan::from_json(&std::fs::read_to_string(plan)?)?;
        Ok(Component::open_blocking(system.component(component)?)?)
    };
    match open() {
        Ok(component) => {
            say("open");
            commands(|words| {
                match component.ready_blocking(millis(words)) {
                    Ok(()) => say("ready"),
                    Err(error) => say_error(error),
                }
                Ok(())
            })
            .map_or(ExitCode::FAILURE, |()| ExitCode::SUCCESS)
        }
        Err(error) => {
            say_error(error);
            ExitCode::FAILURE
        }
    }
}

/// Follows the commands of the test.
fn commands(mut follow: impl FnMut(&[&str]) -> scl::Result<()>) -> scl::Result<()> {
    for line in std::io::stdin().lines() {
        let line = line?;
        follow(&line.split(' ').collect::<Vec<_>>())?;
    }
    Ok(())
}

fn millis(words: &[&str]) -> Duration {
    Duration::from_millis(number(words, 1))
}

fn number(words: &[&str], index: usize) -> u64 {
    words.get(index).and_then(|word| word.parse().ok()).unwrap_or_default()
}

/// Counts that the test knows exactly.
fn say_account(stats: &scl::GateStats) {
    say(format!("{} {} {}", stats.sent, stats.received, stats.rejected));
}
