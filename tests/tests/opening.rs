//! What keeps a component from opening, and what a message that does not decode does to a running one.

use crate::programs::{PEER, open};
use scl_tests::{Exit, Process, System};
use std::os::unix::fs::PermissionsExt;

#[test]
fn a_second_program_for_a_component_is_told_which_process_runs_it() {
    let system = System::new();
    let first = open(&system, "sink");
    let exit = system.start(PEER, &["sink"]).wait_for_exit();
    assert_fails(&exit, "component `sink` cannot be opened");
    assert_fails(&exit, &first.id().to_string());
}

#[test]
fn of_two_programs_started_at_once_for_one_component_exactly_one_runs_it() {
    for _ in 0..10 {
        let system = System::new();
        let mut both = [system.start(PEER, &["sink"]), system.start(PEER, &["sink"])];
        let lines = both.each_mut().map(Process::next_line);
        let winners = lines.iter().filter(|line| *line == "open").count();
        assert_eq!(winners, 1, "{lines:?}");
        let (winner, loser) = if lines[0] == "open" { (0, 1) } else { (1, 0) };
        assert!(lines[loser].contains("component `sink` cannot be opened"), "{lines:?}");
        let pid = both[winner].id().to_string();
        assert!(lines[loser].contains(&pid), "the loser does not name process {pid}: {lines:?}");
    }
}

#[test]
fn a_runtime_folder_that_others_may_write_to_is_refused() {
    let system = System::new();
    std::fs::set_permissions(system.runtime_dir(), PermissionsExt::from_mode(0o777)).expect("opened to all");
    let exit = system.start(PEER, &["sink"]).wait_for_exit();
    assert_fails(&exit, &system.runtime_dir().to_string_lossy());
}

#[test]
fn a_runtime_folder_too_deep_for_a_socket_is_refused() {
    let system = System::new();
    let deep = system.runtime_dir().join("d".repeat(90));
    let exit = Process::start(PEER, &["sink"], &[("SCL_RUNTIME_DIR", deep.as_os_str())]).wait_for_exit();
    assert_fails(&exit, "107");
}

#[test]
fn a_transport_that_does_not_exist_is_refused() {
    for (chosen, text) in [
        ("udp", "`SCL_TRANSPORT=udp`"),
        ("udp", "`ipc`, `tcp` or `shm`"),
        (
            "ipc,sink.reading=tcp",
            "has no gate `reading`, for which a transport is chosen (`sink.reading=tcp`); did you mean `readings`?",
        ),
    ] {
        assert_fails(&System::new().start_with(PEER, &["sink"], &[("SCL_TRANSPORT", chosen)]).wait_for_exit(), text);
    }
}

fn assert_fails(exit: &Exit, text: &str) {
    assert!(!exit.status.success(), "{exit:?}");
    assert!(exit.text().contains(text), "`{text}` is not in: {}", exit.text());
}
