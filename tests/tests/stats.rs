//! What components leave for tools while they run, hang or are dead.

use crate::programs::{PEER, open};
use scl::runtime_dir::{Announcement, ComponentProcess, ComponentState, ComponentStats, RuntimeDir, SystemDir};
use scl_tests::{System, wait_until};
use std::time::{Duration, SystemTime};

/// The promise: a killed component leaves its last figures and its announcement, and its successor starts afresh.
#[test]
fn a_killed_component_leaves_its_figures() {
    let system = System::new();
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    source.ask("push 0 10", "pushed");
    sink.ask("pull 10", "0..10");
    let dir = dir(&system);
    assert_eq!(dir.state("source"), ComponentState::Running(ComponentProcess::Process(source.id())));
    wait_until("the figures are written", || sent(&dir) >= 10);
    let (pid, before) = (source.id(), ComponentStats::read(&dir, "source").expect("stats"));
    assert_eq!(before.pid, pid);
    assert!(before.ready);
    source.kill();
    assert_eq!(dir.state("source"), ComponentState::Dead);
    let left = ComponentStats::read(&dir, "source").expect("stats of a killed component");
    assert_eq!((left.pid, left.started), (pid, Announcement::read(&dir, "source").expect("one").started));
    assert!(sent(&dir) >= 10);
    let source = open(&system, "source");
    let found = ComponentStats::read(&dir, "source").expect("stats");
    assert_eq!((found.pid, sent(&dir)), (source.id(), 0));
    assert_eq!(dir.state("source"), ComponentState::Running(ComponentProcess::Process(source.id())));
    assert_eq!(source.wait_for_exit().code(), 0);
    assert_eq!((dir.state("source"), ComponentStats::read(&dir, "source")), (ComponentState::Stopped, None));
}

/// The promise: the figures of a program that is stopped, or hangs, grow old, and are written again when it goes on.
#[test]
fn figures_of_a_stopped_program_grow_old() {
    let system = System::new();
    let source = open(&system, "source");
    let dir = dir(&system);
    source.pause();
    let written = || ComponentStats::read(&dir, "source").expect("stats").written;
    let last = written();
    let started = SystemTime::now();
    wait_until("two periods have passed", || started.elapsed().unwrap_or_default() > Duration::from_secs(1));
    assert_eq!(written(), last);
    source.resume();
    wait_until("the figures are written again", || written() > last);
}

/// The promise: `SCL_STATS` sets the period or switches the file off; a wrong value is an error that names it.
#[test]
fn the_period_is_a_setting() {
    let system = System::new();
    let start = |value| system.start_with(PEER, &["source"], &[("SCL_STATS", value)]);
    let mut source = start("20ms");
    source.expect("open");
    let dir = dir(&system);
    assert_eq!(ComponentStats::read(&dir, "source").map(|found| found.period), Some(Duration::from_millis(20)));
    drop(source.wait_for_exit());
    let mut source = start("off");
    source.expect("open");
    assert_eq!(ComponentStats::read(&dir, "source"), None);
    drop(source.wait_for_exit());
    let refused = start("often").wait_for_exit();
    assert!(!refused.status.success() && refused.text().contains("`SCL_STATS=often`"), "{refused:?}");
    assert!(refused.text().contains("500ms"), "{refused:?}");
}

fn sent(dir: &SystemDir) -> u64 {
    let found = ComponentStats::read(dir, "source").map(|found| found.gates);
    found.into_iter().flatten().map(|gate| gate.sent).sum()
}

/// The folder of the system that these programs form.
pub(crate) fn dir(system: &System) -> SystemDir {
    dir_of(system, "six")
}

/// The folder of a system of this name.
pub(crate) fn dir_of(system: &System, name: &str) -> SystemDir {
    let env = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| system.runtime_dir().into());
    let runtime_dir = RuntimeDir::existing(&env).expect("a safe folder").expect("the runtime folder");
    runtime_dir.existing_system(name).expect("a safe folder").expect("the system's folder")
}
