//! Programs in every language of SCL show their figures, and report to a service manager.

use super::program::{Program, SCL};
use rustix::process::Signal;
use scl::runtime_dir::{Announcement, ComponentState, ComponentStats, RuntimeDir};
use scl_tests::{ServiceManager, System, wait_until};

/// The promise: what tools see of a program does not depend on its language.
#[test]
fn programs_in_every_language_are_seen() {
    for language in SCL {
        let (system, manager) = (System::new(), ServiceManager::new());
        let more = [("NOTIFY_SOCKET", manager.address()), ("WATCHDOG_USEC", "500000")];
        // Rust's program has a main function of its own, without a service manager.
        let notifies = language != super::program::Language::Rust;
        let mut left = Program::start_with(&system, language, "left", if notifies { &more } else { &[] });
        left.tell("ready 300000");
        if notifies {
            // Until it first calls a gate; later not while it waits for commands.
            manager.expect("WATCHDOG=1");
        }
        let mut right = Program::start(&system, language, "right");
        left.expect("ready");
        left.ask("send pub_bytes 0 7", "sent");
        right.ask("take sub_bytes 7", "0..7");

        let env = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| system.runtime_dir().into());
        let dir = RuntimeDir::existing(&env).expect("a safe folder").expect("the runtime folder");
        let dir = dir.existing_system("matrix").expect("a safe folder").expect("the system's folder");
        for (component, gate, program) in [("left", "pub_bytes", &left), ("right", "sub_bytes", &right)] {
            let plan = Announcement::read(&dir, component).and_then(|found| found.plan).expect("a plan");
            let index = plan.gates.iter().position(|found| found.name == gate).expect("the gate");
            wait_until("the figures are written", || {
                let found = ComponentStats::read(&dir, component).expect("stats");
                let figures = &found.gates[index];
                found.pid == program.id() && found.ready && figures.sent + figures.received == 7
            });
        }
        if notifies {
            manager.expect("READY=1");
            left.signal(Signal::TERM);
            // Before its input is closed, which ends it as well.
            manager.expect("STOPPING=1");
        }
        left.end();
        right.kill();
        assert_eq!((dir.state("left"), dir.state("right")), (ComponentState::Stopped, ComponentState::Dead));
    }
}
