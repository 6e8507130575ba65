//! Running programs that were built for different connections: other types, codecs or messages.

use super::{Examined, Finding};
use scl::examine::incompatible_peers;
use scl_terminal::escape;

const CHECK: &str = "contracts";

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut compared = 0;
    for (system, component, _) in examined.running() {
        let Some(announcement) = &component.announcement else { continue };
        compared += 1;
        match incompatible_peers(system.dir(), announcement) {
            Ok(differences) => findings.extend(differences.iter().map(|(gate, difference)| {
                let text = format!("`{gate}` of system `{}` does not connect: {difference}", system.name());
                Finding::error(CHECK, escape(&text)).help("build and start both again; `scl diff` shows what changed")
            })),
            Err(error) => {
                let text = format!("`{}` of system `{}`: {error}", component.name, system.name());
                findings.push(Finding::error(CHECK, escape(&text)));
            }
        }
    }
    if findings.is_empty() && compared > 1 {
        findings.push(Finding::ok(CHECK, "all running programs were built for the same connections"));
    }
    findings
}
