//! What is wrong with a machine or with the systems that run on it, and what to do about it.

mod clock;
mod components;
mod descriptors;
mod environment;
mod folder;
mod limits;
mod peers;
mod processors;
mod real_time;
mod time;
mod undecodable;

use crate::{Component, System};
use scl::runtime_dir::RuntimeDir;
use std::ffi::OsString;
use std::path::Path;

/// What one check found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// What was checked: `runtime folder`.
    pub check: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// What was found.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
}

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// It is as it should be.
    Ok,
    /// Good to know.
    Note,
    /// It works, but less well than it could.
    Warning,
    /// It does not work.
    Error,
}

/// The environment variables and systems that the checks examine.
struct Examined<'e> {
    variables: &'e [(OsString, OsString)],
    systems: Vec<(System, Vec<Component>)>,
}

/// Runs all checks: of this machine, this user, these environment variables, and of one or all systems.
///
/// It only reads. The checks of systems are left out if nothing has run yet.
///
/// # Errors
/// The system that was named does not exist.
pub fn examine(
    system: Option<&str>,
    variables: &[(OsString, OsString)],
) -> Result<Vec<Finding>, scl_terminal::Problem> {
    let variable = |name: &str| variables.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone());
    let find = |name: &str| System::find_with(Some(name), &variable, Path::new("."));
    let systems = match system {
        Some(name) => vec![find(name)?],
        None => {
            let runtime_dir = RuntimeDir::existing(&variable).ok().flatten();
            let names = runtime_dir.and_then(|dir| dir.systems().ok()).unwrap_or_default();
            names.iter().filter_map(|name| find(name).ok()).collect()
        }
    };
    let systems = systems.into_iter().map(|system| (system.components(), system));
    let systems = systems.map(|(components, system)| (system, components)).collect();
    let examined = Examined { variables, systems };
    let checks: [fn(&Examined<'_>) -> Vec<Finding>; 11] = [
        environment::check,
        folder::check,
        components::check,
        peers::check,
        undecodable::check,
        time::check,
        descriptors::check,
        limits::check,
        real_time::check,
        processors::check,
        clock::check,
    ];
    Ok(checks.iter().flat_map(|check| check(&examined)).collect())
}

impl Examined<'_> {
    fn variable(&self, name: &str) -> Option<OsString> {
        self.variables.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone())
    }

    /// All running components with the ids of their processes, if these are visible.
    fn running(&self) -> impl Iterator<Item = (&System, &Component, Option<u32>)> {
        let all = self.systems.iter().flat_map(|(system, components)| components.iter().map(move |it| (system, it)));
        all.filter(|(_, component)| component.is_running())
            .map(|(system, component)| (system, component, component.process_id()))
    }
}

impl Finding {
    fn new(check: &'static str, severity: Severity, message: impl Into<String>) -> Self {
        Self { check, severity, message: message.into(), help: None }
    }

    fn ok(check: &'static str, message: impl Into<String>) -> Self {
        Self::new(check, Severity::Ok, message)
    }

    fn note(check: &'static str, message: impl Into<String>) -> Self {
        Self::new(check, Severity::Note, message)
    }

    fn warning(check: &'static str, message: impl Into<String>) -> Self {
        Self::new(check, Severity::Warning, message)
    }

    fn error(check: &'static str, message: impl Into<String>) -> Self {
        Self::new(check, Severity::Error, message)
    }

    fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }
}

impl Severity {
    /// `ok`, `note`, `warning` or `error`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}
