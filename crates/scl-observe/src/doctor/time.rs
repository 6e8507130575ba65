//! Messages that did not come when they were due, or were too old when they came.

use super::{Examined, Finding};
use scl_plan::GateOptions;
use scl_terminal::escape;
use scl_text::duration::text;

const CHECK: &str = "time";

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (system, component, _) in examined.running() {
        for (index, gate) in component.gates().iter().enumerate() {
            let Some(figures) = component.figures(index) else { continue };
            let gate_text = format!("`{}.{}` of system `{}`", component.name, gate.name, system.name());
            findings.extend(missed(&gate_text, &gate.options, figures.missed));
            findings.extend(expired(&gate_text, &gate.options, figures.expired));
        }
    }
    findings
}

fn missed(gate: &str, options: &GateOptions, count: u64) -> Option<Finding> {
    let (verb, interval, help) = match (options.period, options.deadline) {
        (Some(period), _) => ("promises", period, "the program sends too late, or not at all"),
        (None, Some(deadline)) => (
            "needs",
            deadline,
            "`scl info` shows from which sender; if that keeps its own promise, look at the connection",
        ),
        (None, None) => return None,
    };
    let what = format!("{gate} {verb} a message every {}, and {count} are missing", text(interval));
    (count > 0).then(|| Finding::warning(CHECK, escape(&what)).help(help))
}

fn expired(gate: &str, options: &GateOptions, count: u64) -> Option<Finding> {
    let max_age = options.max_age?;
    let what = format!("{gate} has dropped {count} messages that were older than {}", text(max_age));
    let help = "the program receives too seldom, or the messages wait at their sender: `scl info` shows from which";
    (count > 0).then(|| Finding::warning(CHECK, escape(&what)).help(help))
}
