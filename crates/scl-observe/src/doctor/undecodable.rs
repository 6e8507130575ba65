//! Messages that running programs could not decode.

use super::{Examined, Finding};
use scl_terminal::escape;

const CHECK: &str = "undecodable messages";

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (system, component, _) in examined.running() {
        for (index, gate) in component.gates().iter().enumerate() {
            let Some(count @ 1..) = component.figures(index).map(|figures| figures.undecodable) else { continue };
            let text = format!("`{}.{}` of system `{}` has received {count}", component.name, gate.name, system.name());
            let help = "the program's log names the first sender and says what is wrong with its message";
            findings.push(Finding::warning(CHECK, escape(&text)).help(help));
        }
    }
    findings
}
