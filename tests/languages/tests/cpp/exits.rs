//! Components that are closed by destructors and functions that run at the end of a process or a thread.

use super::build::{Build, binding, program};
use crate::programs::{TAKER, open_with};
use scl_tests::System;
use std::path::Path;

/// The promise: what is sent by whatever runs last arrives, and nothing panics.
#[test]
fn what_is_sent_at_the_exit_arrives() {
    let ways = [
        "static object",
        "static object of a function",
        "atexit",
        "quick_exit",
        "thread-local object",
        "thread-local object of a thread",
        "exit of another thread",
        "end of the main thread",
        "uncaught error",
    ];
    let topology = Path::new(env!("CARGO_MANIFEST_DIR")).join("topologies/exits.yaml");
    for build in [Build::Plain, Build::Address] {
        let program = program(&binding().join("tests/programs/exits.cpp"), &topology, build);
        // LeakSanitizer does not see the thread-local values of a main thread that has ended.
        let checked = |way: &&&str| build == Build::Plain || **way != "end of the main thread";
        for way in ways.iter().filter(checked) {
            let system = System::new();
            let mut taker = open_with(&system, TAKER, "taker");
            let exit = system.start(program.to_str().expect("a path of ASCII"), &[way]).wait_for_exit();
            taker.ask("jobs 199", "0..200");
            assert_eq!(exit.code(), i32::from(*way == "uncaught error"), "{way}: {exit:?}");
            assert!(exit.text().contains("closed") && !exit.text().contains("panicked"), "{way}: {exit:?}");
        }
    }
}
