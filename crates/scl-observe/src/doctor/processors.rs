//! Processors whose frequency is lowered while they are idle, which costs the first message after a pause some
//! microseconds.

use super::{Examined, Finding};
use std::collections::BTreeSet;
use std::fs;

const CHECK: &str = "processors";

pub(super) fn check(_examined: &Examined<'_>) -> Vec<Finding> {
    let processors = fs::read_dir("/sys/devices/system/cpu").into_iter().flatten().flatten();
    let governors = processors.filter_map(|entry| {
        let governor = fs::read_to_string(entry.path().join("cpufreq/scaling_governor")).ok()?;
        Some(governor.trim().to_owned())
    });
    judge(&governors.collect()).into_iter().collect()
}

fn judge(governors: &BTreeSet<String>) -> Option<Finding> {
    let names: Vec<_> = governors.iter().map(|name| format!("`{name}`")).collect();
    match governors.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => None,
        ["performance"] => Some(Finding::ok(CHECK, "at their full frequency: the governor is `performance`")),
        _ => Some(
            Finding::note(CHECK, format!("their frequency varies: the governor is {}", names.join(", ")))
                .help("for even delays, `cpupower frequency-set -g performance`"),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Severity;
    use super::*;

    #[test]
    fn only_performance_keeps_the_frequency() {
        let found = |names: &[&str]| judge(&names.iter().map(|name| (*name).to_owned()).collect());
        assert_eq!(found(&[]), None);
        assert_eq!(found(&["performance"]).unwrap().severity, Severity::Ok);
        assert_eq!(found(&["performance", "powersave"]).unwrap().severity, Severity::Note);
    }
}
