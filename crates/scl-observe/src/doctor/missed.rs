//! Messages that did not come when they were due.

use super::{Examined, Finding};
use scl_terminal::escape;
use scl_text::duration::text;

const CHECK: &str = "time";

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (system, component, _) in examined.running() {
        for (index, gate) in component.gates().iter().enumerate() {
            let Some(count @ 1..) = component.figures(index).map(|figures| figures.missed) else { continue };
            let (name, system) = (format!("`{}.{}`", component.name, gate.name), system.name());
            let (what, help) = match (gate.options.period, gate.options.deadline) {
                (Some(period), _) => (
                    format!(
                        "{name} of system `{system}` promises a message every {}, and {count} are missing",
                        text(period)
                    ),
                    "the program sends too late, or not at all",
                ),
                (None, Some(deadline)) => (
                    format!(
                        "{name} of system `{system}` needs a message every {}, and {count} are missing",
                        text(deadline)
                    ),
                    "`scl info` shows from which sender; if that keeps its own promise, look at the connection",
                ),
                (None, None) => continue,
            };
            findings.push(Finding::warning(CHECK, escape(&what)).help(help));
        }
    }
    findings
}
