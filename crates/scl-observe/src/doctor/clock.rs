//! The clock, by which messages are stamped and delays measured.

use super::{Examined, Finding};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

const CHECK: &str = "clock";
const SOURCE: &str = "clock source";

/// Clock sources that take a system call to read, and some of them a microsecond or more.
const SLOW: [&str; 4] = ["hpet", "acpi_pm", "jiffies", "pit"];

pub(super) fn check(_examined: &Examined<'_>) -> Vec<Finding> {
    let source = fs::read_to_string("/sys/devices/system/clocksource/clocksource0/current_clocksource").ok();
    [Some(judge_synchronised(is_synchronised())), source.map(|source| judge_source(source.trim()))]
        .into_iter()
        .flatten()
        .collect()
}

/// Whether the clock is synchronised; `None` if no service knows.
fn is_synchronised() -> Option<bool> {
    if Path::new("/run/systemd/timesync/synchronized").exists() {
        return Some(true);
    }
    // `timeout`, because the service that answers may hang.
    let mut command = Command::new("timeout");
    command.args(["2", "timedatectl", "show", "--property=NTPSynchronized", "--value"]);
    let output = command.stdin(Stdio::null()).stderr(Stdio::null()).output().ok()?;
    match output.stdout.trim_ascii() {
        b"yes" => Some(true),
        b"no" => Some(false),
        _ => None,
    }
}

fn judge_synchronised(synchronised: Option<bool>) -> Finding {
    match synchronised {
        Some(true) => Finding::ok(CHECK, "synchronised"),
        Some(false) => {
            Finding::note(CHECK, "not synchronised: times in recordings may differ from those of other hosts")
                .help("install `systemd-timesyncd` or `chrony`")
        }
        None => Finding::note(CHECK, "unknown whether it is synchronised: `timedatectl` gives no answer"),
    }
}

fn judge_source(source: &str) -> Finding {
    if SLOW.contains(&source) {
        Finding::warning(SOURCE, format!("`{source}` is slow to read, and it is read for each message"))
            .help("see /sys/devices/system/clocksource/clocksource0/available_clocksource for others")
    } else {
        Finding::ok(SOURCE, format!("`{source}`"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Severity;
    use super::*;

    #[test]
    fn a_clock_is_judged() {
        assert_eq!(judge_synchronised(Some(true)).severity, Severity::Ok);
        assert_eq!(judge_synchronised(Some(false)).severity, Severity::Note);
        assert_eq!(judge_synchronised(None).severity, Severity::Note);
        assert_eq!(judge_source("tsc").severity, Severity::Ok);
        assert_eq!(judge_source("hpet").severity, Severity::Warning);
    }
}
