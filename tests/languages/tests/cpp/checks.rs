//! The promises of the C++ binding to one program, as `bindings/cpp/tests/programs/checks.cpp` checks them.

use super::build::{Build, binding, program};
use scl_tests::{Process, System};
use std::path::PathBuf;

#[test]
fn every_promise_holds() {
    expect_success(start(Build::Plain, &[]));
}

#[test]
fn the_address_sanitizer_finds_nothing() {
    expect_success(start(Build::Address, &[]));
}

/// The C library is compiled without ThreadSanitizer, so only accesses of the C++ part are judged.
#[test]
fn the_thread_sanitizer_finds_nothing() {
    let suppressions = binding().join("tests/thread_sanitizer.supp");
    let options = format!("suppressions={}", suppressions.display());
    expect_success(start(Build::Thread, &[("TSAN_OPTIONS", &options)]));
}

/// Valgrind sees memory of the C library, too, which AddressSanitizer does not.
#[test]
fn valgrind_finds_nothing() {
    let system = System::new();
    let program = compiled(Build::Plain);
    let program = program.to_str().expect("a path of ASCII");
    // Threads of the library live until the process ends, so what they hold is still reachable.
    let arguments = ["--quiet", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite", program];
    for check in ["bytes_are_taken_from_anything", "types_of_the_program_have_codecs", "json_is_canonical"] {
        expect_success_in(system.start("valgrind", &[&arguments[..], &[check]].concat()));
    }
}

fn start(build: Build, environment: &[(&str, &str)]) -> (System, Process) {
    let system = System::new();
    let program = compiled(build);
    let process = system.start_with(program.to_str().expect("a path of ASCII"), &[], environment);
    (system, process)
}

fn compiled(build: Build) -> PathBuf {
    let tests = binding().join("tests");
    program(&tests.join("programs/checks.cpp"), &tests.join("topologies/checks.yaml"), build)
}

#[track_caller]
fn expect_success((_system, process): (System, Process)) {
    expect_success_in(process);
}

#[track_caller]
fn expect_success_in(process: Process) {
    let exit = process.wait_for_exit();
    assert_eq!(exit.code(), 0, "after {:?}:\n{}", exit.output.last(), exit.log.join("\n"));
    assert!(!exit.output.is_empty());
    let forgotten = "WARN gate `right.answer` did not answer a request";
    let expects_it = exit.output.iter().any(|check| check == "an_exception_of_the_program_loses_no_request_in_silence");
    assert_eq!(exit.text().contains(forgotten), expects_it, "{exit:?}");
}
