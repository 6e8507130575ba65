//! What C programs get wrong, and what they are told.

use crate::programs::{Build, Program, expect_success, on_each_build, plans};
use scl::untyped::Component;
use scl_tests::System;

/// The promise: every wrong argument has a status and a text of its own, and harms nothing.
#[test]
fn wrong_arguments_are_explained() {
    on_each_build(|program| {
        let mut c = program.start("bad_input", &[]);
        c.expect("done");
        expect_success(c);
    });
}

/// The promise: a forked child can use nothing of its parent, and harms nothing.
///
/// Without AddressSanitizer: that of GCC 12 does not protect the locks of its allocator when a process forks, so a
/// child hangs in `malloc` if another thread of the parent was in there.
#[test]
fn a_forked_child_is_refused() {
    let program = Program::new(System::new(), Build::Plain);
    let mut peer = program.peer();
    let (mut values, mut out) = (peer.publisher("values").unwrap(), peer.subscriber("out").unwrap());
    values.send_blocking(&"hello".into()).unwrap();
    let mut c = program.start("forked", &[]);
    c.expect("done");
    assert_eq!(out.recv_blocking().unwrap(), "still here");
    expect_success(c);
}

/// The promise: a peer with another contract, or with messages of another shape, is not connected, and the text says
/// why.
#[test]
fn other_contracts_and_shapes_are_refused() {
    for (theirs, words) in
        [("contract", "codec `json`, this program expects `test.Number` and `protobuf`"), ("shape", "`test.Number`")]
    {
        let system = System::new();
        let mut peer = Component::open_blocking_with(
            plans(&format!("peers/{theirs}.yaml")).component("sensor").unwrap(),
            system.options(),
        )
        .unwrap();
        let folder = tempfile::tempdir().unwrap();
        let plan = folder.path().join("plan.json");
        std::fs::write(&plan, plans("peers/original.yaml").to_json()).unwrap();
        let program = Program::new(system, Build::Address);
        let mut c = program.start_plan("commands", &plan, &["viewer", ""]);
        c.expect("open");
        c.tell("ready 60000000");
        let refused = c.expect_containing("SCL_TIMEOUT: component `viewer` is not ready");
        assert!(refused.contains(words), "{theirs}: {refused}");
        // What it sends does not arrive.
        peer.publisher("numbers").unwrap().send_blocking(&"x".into()).unwrap();
        c.ask("recv numbers 0", "SCL_NOTHING: no message has arrived yet");
        expect_success(c);
        // While it runs, it would create its files again after `program` has removed the folder.
        drop(peer);
    }
}
