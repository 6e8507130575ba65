//! `scl doctor`: what is wrong with this machine or with what runs on it.

use crate::format::FormatArgument;
use clap::Args;
use scl_observe::{Finding, Severity, examine};
use scl_terminal::Problem;
use serde_json::{Value, json};
use std::process::ExitCode;

/// Check this machine and what runs on it: folders, limits, clock, killed and hanging components, builds that differ.
///
/// It reads, and changes nothing. Without a running system it checks the machine and the environment variables of this
/// shell.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl doctor
  scl doctor --system rover
  scl doctor --format json | jq -r '.findings[] | select(.severity == \"error\") | .message'

Exit code: 0 no error was found, 1 an error was found, 2 there is no such system.")]
pub(crate) struct DoctorArguments {
    /// Check only this system [default: all of them].
    #[arg(long, value_name = "NAME")]
    system: Option<String>,
    #[command(flatten)]
    format: FormatArgument,
}

/// The body of `scl doctor`.
pub(crate) fn doctor(arguments: &DoctorArguments) -> Result<ExitCode, Problem> {
    let variables: Vec<_> = std::env::vars_os().collect();
    let findings = examine(arguments.system.as_deref(), &variables)?;
    arguments.format.print(|| to_json(&findings), || to_text(&findings));
    let has_error = findings.iter().any(|finding| finding.severity == Severity::Error);
    Ok(if has_error { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn to_text(findings: &[Finding]) -> String {
    let mut text = String::new();
    for Finding { check, severity, message, help } in findings {
        text.push_str(&format!("{:8} {check}: {message}\n", severity.word()));
        if let Some(help) = help {
            text.push_str(&format!("{:8}   = help: {help}\n", ""));
        }
    }
    let count = |wanted| findings.iter().filter(|finding| finding.severity == wanted).count();
    text.push_str(&format!(
        "\n{}, {}\n",
        counted(count(Severity::Error), "error"),
        counted(count(Severity::Warning), "warning")
    ));
    text
}

/// `no errors`, `1 error`, `2 errors`
fn counted(count: usize, word: &str) -> String {
    match count {
        0 => format!("no {word}s"),
        1 => format!("1 {word}"),
        _ => format!("{count} {word}s"),
    }
}

fn to_json(findings: &[Finding]) -> Value {
    let finding = |it: &Finding| json!({"check": it.check, "severity": it.severity.word(), "message": it.message, "help": it.help});
    json!({"findings": findings.iter().map(finding).collect::<Vec<_>>()})
}
