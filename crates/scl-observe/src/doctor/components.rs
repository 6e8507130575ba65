//! Components that were killed, hang, or were built with another release.

use super::{Examined, Finding};
use crate::{Activity, Component, System};
use scl::runtime_dir::ComponentState;
use std::time::SystemTime;

const CHECK: &str = "components";

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    let now = SystemTime::now();
    let all = examined.systems.iter().flat_map(|(system, components)| components.iter().map(move |it| (system, it)));
    let mut findings: Vec<Finding> = all.filter_map(|(system, component)| judge(system, component, now)).collect();
    let running = examined.running().count();
    if findings.is_empty() {
        findings.push(match (running, examined.systems.len()) {
            (0, _) => Finding::note(CHECK, "none is running"),
            (running, 1) => Finding::ok(CHECK, format!("{running} running in 1 system")),
            (running, systems) => Finding::ok(CHECK, format!("{running} running in {systems} systems")),
        });
    }
    findings
}

fn judge(system: &System, component: &Component, now: SystemTime) -> Option<Finding> {
    let name = format!("`{}` of system `{}`", component.name, system.name());
    let process = component.announcement.as_ref().map_or(String::new(), |it| format!(" (process {})", it.pid));
    if component.state == ComponentState::Dead {
        let text = format!("{name} was killed or has crashed{process}; its files are still there");
        return Some(Finding::warning(CHECK, text).help("start it again, which removes them"));
    }
    if !component.is_running() {
        return None;
    }
    match component.activity(now) {
        Activity::Hangs(silence) => {
            let text = format!("{name} hangs{process}: it has written no figures for {} s", silence.as_secs());
            Some(Finding::error(CHECK, text).help("its process is stopped, or blocks a thread that its gates need"))
        }
        Activity::Waiting => {
            Some(Finding::warning(CHECK, format!("{name} waits for peers")).help("`scl list` shows which do not run"))
        }
        _ if component.announcement.as_ref().is_some_and(|it| it.plan.is_none()) => {
            let text = format!("{name} was built with another release of SCL{process}");
            Some(Finding::warning(CHECK, text).help("build all programs of a system with the same release"))
        }
        _ => None,
    }
}
