//! The unit files of systemd that run the programs of a launch file as services, in place of `scl run`.
//!
//! Settings without a counterpart in systemd are left out: `essential`, because services do not stop each other, the
//! growth of `restart_delay`, and `input: terminal`.

mod templates;
mod text;

use super::Options;
use super::component::Component;
use super::orphan_guard::THIS_PROGRAM;
use super::plan::{ComponentNames, RunPlan, plan_run_launch_file};
use super::policy::{Policy, Restart};
use super::program::Program;
use scl_terminal::Problem;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;
use text::{duration, environment, quoted};

/// The shortest limit: systemd understands 0 as no limit.
const SHORTEST: Duration = Duration::from_millis(1);

/// What systemd replaces by the name of the component in the template of a kind.
const INSTANCE: &str = "%i";

/// What to write unit files for, and the user of the services.
#[derive(Debug, Clone, Default)]
pub struct UnitOptions {
    /// What the services run. Nothing is built.
    pub run: Options,
    /// The user of all services; that of the service manager if `None`.
    pub user: Option<String>,
}

/// A unit file.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Unit {
    /// `rover-sensor.service`, `rover-motor@.service` for the components of a kind, or `rover.target` for all.
    pub name: String,
    /// The content of the file.
    pub text: String,
}

/// The unit files of the components, the gateway if there is one, and last the target that starts them all.
///
/// # Errors
///
/// Every reason why the system could not be started; also if it has no name or no launch file.
pub fn systemd_units(options: &UnitOptions, component_names: ComponentNames<'_>) -> Result<Vec<Unit>, Vec<Problem>> {
    let plan = plan_run_launch_file(&options.run, component_names)?;
    let system = plan.system.clone().ok_or_else(|| vec![without_name()])?;
    let units =
        Units { system: &system, user: options.user.as_deref(), host: options.run.host.as_deref(), plan: &plan };
    units.all().map_err(|problem| vec![problem])
}

struct Units<'u> {
    system: &'u str,
    user: Option<&'u str>,
    host: Option<&'u str>,
    plan: &'u RunPlan,
}

/// What a service is called: a component, or each component of a kind, by a template.
#[derive(Clone, Copy)]
enum Called<'c> {
    Component(&'c str),
    AnyOf(&'c str),
}

impl Called<'_> {
    /// The name of the component in the unit file.
    fn component(self) -> String {
        match self {
            Called::Component(name) => name.to_owned(),
            Called::AnyOf(_) => INSTANCE.to_owned(),
        }
    }
}

impl Units<'_> {
    fn all(&self) -> Result<Vec<Unit>, Problem> {
        let gateway = self.plan.gateway.iter().map(|gateway| self.gateway(gateway));
        let mut units = gateway.collect::<Result<Vec<Unit>, Problem>>()?;
        let mut started: Vec<String> = units.iter().map(|unit| unit.name.clone()).collect();
        for service in self.services()? {
            units.extend(service.file);
            started.push(service.started);
        }
        units.push(self.target(&started));
        Ok(units)
    }

    fn component(&self, component: &Component, called: Called<'_>) -> Result<Unit, Problem> {
        let policy = &component.policy;
        // Start after the gateway: systemd stops in reverse order, so a stopping component can still send.
        let gateway = self.plan.gateway.as_ref().map(|gateway| self.service_name(Called::Component(&gateway.name)));
        let order = gateway.map_or_else(String::new, |name| format!("Wants={name}\nAfter={name}\n"));
        let limit = match policy.restart {
            Restart::Never => String::new(),
            // systemd counts the first start, too.
            _ => format!(
                "StartLimitIntervalSec={}\nStartLimitBurst={}\n",
                duration(policy.limit.within),
                policy.limit.count.saturating_add(1)
            ),
        };
        let unit = format!("Description=Component {} of {}\n{order}{limit}", called.component(), self.system);
        let service = [readiness(policy), restarts(policy), placement(&component.program)].concat();
        self.service(component, called, &unit, &service)
    }

    fn gateway(&self, gateway: &Component) -> Result<Unit, Problem> {
        let host = self.host.unwrap_or_default();
        // Nothing else restores the connections, so there is no start limit.
        let unit = format!(
            "Description=Gateway of {} on host {host}\nWants=network-online.target\nAfter=network-online.target\nStartLimitIntervalSec=0\n",
            self.system
        );
        let called = Called::Component(&gateway.name);
        self.service(gateway, called, &unit, "Type=notify\nRestart=always\nRestartSec=1s\n")
    }

    fn service(&self, component: &Component, called: Called<'_>, unit: &str, service: &str) -> Result<Unit, Problem> {
        let Component { program, policy, .. } = component;
        let system = self.system;
        let variables =
            [("SCL_RUNTIME_DIR".to_owned(), format!("/run/{system}")), ("SCL_SYSTEM".to_owned(), system.to_owned())];
        let line = |variable| match called {
            Called::AnyOf(_) if templates::names(variable, &component.name) => {
                templates::line(variable, &component.name)
            }
            _ => environment(variable),
        };
        let variables: String = variables.iter().chain(&program.environment).map(line).collect();
        let user = self.user.map_or_else(String::new, |user| format!("User={user}\n"));
        let text = format!(
            "# Written by `scl deploy systemd`.\n\
             [Unit]\n{unit}PartOf={system}.target\n\n\
             [Service]\n{service}NotifyAccess=all\n{user}\
             RuntimeDirectory={system}\nRuntimeDirectoryMode=0700\nRuntimeDirectoryPreserve=yes\n\
             WorkingDirectory={}\n{variables}ExecStart={}\nTimeoutStopSec={}\n",
            text::path(&program.folder),
            command(program)?,
            duration(policy.stop_within.max(SHORTEST)),
        );
        Ok(Unit { name: self.service_name(called), text })
    }

    fn target(&self, services: &[String]) -> Unit {
        let wants: String = services.iter().map(|name| format!("Wants={name}\n")).collect();
        let place = self.host.map_or_else(String::new, |host| format!(" on host {host}"));
        let text = format!(
            "# Written by `scl deploy systemd`.\n[Unit]\nDescription=System {}{place}\n{wants}\n[Install]\nWantedBy=multi-user.target\n",
            self.system
        );
        Unit { name: format!("{}.target", self.system), text }
    }

    fn service_name(&self, called: Called<'_>) -> String {
        match called {
            Called::Component(name) => format!("{}-{name}.service", self.system),
            Called::AnyOf(kind) => format!("{}-{kind}@.service", self.system),
        }
    }
}

/// Returns the lines about readiness and the watchdog. systemd must not wait for a program that reports nothing; a
/// limit in the launch file says that a program reports.
fn readiness(policy: &Policy) -> String {
    match (policy.ready_within, policy.alive_within) {
        (None, None) => "Type=exec\n".to_owned(),
        (ready, alive) => {
            let ready = ready.map_or_else(|| "infinity".to_owned(), duration);
            let alive = alive.map_or_else(String::new, |limit| format!("WatchdogSec={}\n", duration(limit)));
            format!("Type=notify\nTimeoutStartSec={ready}\n{alive}")
        }
    }
}

fn restarts(policy: &Policy) -> String {
    let when = match policy.restart {
        Restart::Never => return "Restart=no\n".to_owned(),
        Restart::OnAbnormal => "on-abnormal",
        Restart::OnFailure => "on-failure",
        Restart::Always => "always",
    };
    format!("Restart={when}\nRestartSec={}\n", duration(policy.delay.first))
}

fn placement(program: &Program) -> String {
    let cpu: Vec<String> = program.placement.cpu.iter().map(usize::to_string).collect();
    let mut text = if cpu.is_empty() { String::new() } else { format!("CPUAffinity={}\n", cpu.join(" ")) };
    text.extend(program.placement.descriptors.map(|most| format!("LimitNOFILE={most}\n")));
    let Some(priority) = program.placement.fifo else { return text };
    // `SCL_SCHED` makes an SCL program lock its memory as well, as under `scl run`.
    format!(
        "{text}CPUSchedulingPolicy=fifo\nCPUSchedulingPriority={priority}\nLimitRTPRIO={priority}\nLimitMEMLOCK=infinity\n\
         Environment=SCL_SCHED=fifo:{priority}\n"
    )
}

fn command(program: &Program) -> Result<String, Problem> {
    let [first, arguments @ ..] = program.command.as_slice() else { return Ok(String::new()) };
    let executable = executable(program, first)?;
    let words = [executable.into_os_string()].into_iter().chain(arguments.iter().cloned());
    Ok(words.map(|word| quoted(&word.to_string_lossy(), true)).collect::<Vec<_>>().join(" "))
}

/// The absolute path of the program: systemd has another search path.
fn executable(program: &Program, first: &OsString) -> Result<PathBuf, Problem> {
    if first == THIS_PROGRAM {
        return std::env::current_exe().map_err(|error| Problem::new(format!("cannot find `scl`: {error}")));
    }
    if !first.as_encoded_bytes().contains(&b'/') {
        let found = program.find_installed(first);
        return found
            .ok_or_else(|| Problem::new(format!("the program `{}` is not in the search path", first.display())));
    }
    // Drops the `./` that a path in a launch file usually starts with.
    Ok(program.folder.join(Path::new(first)).components().collect())
}

fn without_name() -> Problem {
    Problem::new("the system has no name, so its services cannot be named")
        .help("write `topology:` into the launch file, or set `SCL_SYSTEM`")
}

#[cfg(test)]
mod tests;
