//! Components that are closed by what runs at the end of a process or a thread, when thread-local values may be gone.

use crate::programs::{Build, Program, expect_success, shared_library, source};

/// Ways to end a process, each with the last messages sent and the component closed by a function that runs then.
const WAYS: [&str; 6] = ["atexit", "on_exit", "destructor", "quick_exit", "key of a thread", "exit of another thread"];

/// The promise: what is sent last arrives, and closing says that it has.
#[test]
fn what_is_sent_at_the_exit_arrives() {
    for build in [Build::Plain, Build::Address] {
        for way in WAYS {
            everything_arrives(build, &[way]);
        }
    }
    // LeakSanitizer does not see the thread-local values of a main thread that has ended.
    everything_arrives(Build::Plain, &["end of the main thread"]);
}

/// The promise: so does what the destructor of a plugin sends when the plugin is unloaded.
#[test]
fn what_is_sent_while_a_plugin_is_unloaded_arrives() {
    let plugin = shared_library(&source("exits"), "plugin", &["-DPLUGIN"]);
    everything_arrives(Build::Plain, &["plugin", plugin.to_str().unwrap()]);
}

#[track_caller]
fn everything_arrives(build: Build, how: &[&str]) {
    let program = Program::new(scl_tests::System::new(), build);
    let mut peer = program.peer();
    let mut lossless = peer.subscriber("lossless").unwrap();
    let mut c = program.start("exits", how);
    for number in 0..200 {
        assert_eq!(lossless.recv_blocking().unwrap(), number.to_string(), "{build:?}, {how:?}");
    }
    c.expect("published 200");
    c.expect("closed");
    expect_success(c);
}
