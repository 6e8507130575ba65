//! What a supervisor reports about programs.

use super::super::ending::{Ending, name_of};
use super::super::member::{Member, Role};
use super::super::terminal::StandardInput;
use rustix::process::Signal;
use std::time::Duration;

/// The report on a program that opens another component than the one that it was started as.
pub(super) fn wrong_program(member: &Member<'_>, opened: &str) -> String {
    let shown = match opened.split_once('.') {
        Some((system, name)) => format!("`{name}` of system `{system}`"),
        None => format!("`{opened}`"),
    };
    let program =
        member.program.command.first().map_or_else(String::new, |program| format!("`{}` ", program.display()));
    let place = member.entry.map_or_else(String::new, |place| format!("; its entry is at {place}"));
    format!("wrong program: {program}opens component {shown}, but was started as `{}`{place}", member.name)
}

/// The report on a program that uses a terminal that it does not have.
pub(super) fn stopped_by_terminal(member: &Member<'_>, signal: Signal) -> String {
    let signal = name_of(signal);
    match member.program.input {
        StandardInput::Empty => {
            format!(
                "stopped by {signal}: it uses the terminal; write `input: terminal` in the entry of `{}`",
                member.name
            )
        }
        StandardInput::Terminal => format!("stopped by {signal}: it uses the terminal, which it was not given"),
    }
}

pub(super) fn end_text(role: Role, ending: Ending, after: Duration) -> String {
    let after = after.as_secs_f64();
    match (role, ending) {
        (Role::Component | Role::Gateway | Role::Recorder, _) => format!("{ending} after {after:.1} s"),
        (Role::Build, Ending::Exited(0)) => format!("built after {after:.1} s"),
        (Role::Build, _) => format!("build {ending} after {after:.1} s"),
    }
}

/// Returns why one of these components could not be started again. The restart is refused then, because its old process
/// is better than none.
pub(super) fn unusable(members: &[Member<'_>], components: &[String]) -> Option<String> {
    let chosen = members.iter().filter(|member| components.iter().any(|name| name == member.name));
    let mut checks = chosen.map(|member| member.program.check("program", &format!("component `{}`", member.name)));
    checks.find_map(Result::err).map(|problem| problem.message().to_owned())
}
