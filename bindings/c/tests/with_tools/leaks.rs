//! The calls under valgrind, which also sees the memory of the library.

use crate::programs::{Build, Program, compiled};
use scl_tests::System;
use std::process::Command;

/// The promise: every call gives back its memory, and none reads what it must not.
#[test]
fn valgrind_finds_nothing() {
    let program = Program::new(System::new(), Build::Plain);
    let mut peer = program.peer();
    let mut command = Command::new("valgrind");
    // Not those that are only possibly lost: plans are kept until the process ends, in a tree that points into the
    // middle of its nodes.
    command.args(["--quiet", "--leak-check=full", "--show-leak-kinds=definite,indirect"]);
    command.args(["--errors-for-leak-kinds=definite,indirect", "--error-exitcode=99"]);
    command.arg(compiled("commands", Build::Plain)).args([program.plan(), "program", ""]);
    let found = Command::new("valgrind").arg("--version").output();
    assert!(found.is_ok(), "valgrind is missing; install it (Debian: apt-get install valgrind)");
    let mut c = program.spawn(command);
    c.expect("open");
    c.ask("ready 60000000000", "");
    let mut out = peer.subscriber("out").unwrap();
    let (mut values, mut questions) = (peer.publisher("values").unwrap(), peer.replier("question").unwrap());
    let mut answer = peer.requester("answer").unwrap();
    for text in ["short".to_owned(), "long ".repeat(150)] {
        for call in ["send", "send_in_place"] {
            c.ask(&format!("{call} out -1 {text}"), "");
            assert_eq!(out.recv_blocking().unwrap(), text);
        }
        for call in ["recv values -1", "latest values"] {
            values.send_blocking(&text.clone().into()).unwrap();
            c.ask("wait -1 values", "1");
            c.ask(call, &text);
        }
        c.tell(&format!("call question -1 {text}"));
        let question = questions.recv_blocking().unwrap();
        let echo = question.message().clone();
        question.reply(&echo).unwrap();
        c.expect(&text);
        std::thread::scope(|scope| {
            let asking = scope.spawn(|| answer.call_blocking(&text.clone().into()));
            c.ask("take answer -1", &text);
            c.ask(&format!("reply_in_place {text}"), "");
            assert_eq!(asking.join().unwrap().unwrap(), text);
        });
    }
    values.send_blocking(&"kept".into()).unwrap();
    c.ask("into values -1 1", "4 needed");
    c.tell("call question 1000000 x");
    c.expect_containing("SCL_TIMEOUT");
    c.tell("recv nothing 0");
    c.expect_containing("SCL_ARGUMENT: the gate is NULL");
    c.tell("stats out");
    c.expect_containing("\"sent\":4");
    c.ask("close 60000000000", "");
    let exit = c.wait_for_exit();
    assert_eq!(exit.code(), 0, "{exit:#?}");
}
