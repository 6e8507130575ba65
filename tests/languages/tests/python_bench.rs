//! The benchmarks in Python: they run, and print a line for everything that they measure.

use scl_tests::{Process, python_with_scl};
use std::process::Command;

fn run(script: &str, arguments: &[&str]) -> String {
    let path = format!("{}/../bench/python/{script}", env!("CARGO_MANIFEST_DIR"));
    let exit = Process::start(python_with_scl(), &[&[path.as_str()], arguments].concat(), &[]).wait_for_exit();
    assert!(exit.status.success(), "{:#?}", exit.log);
    exit.output.join("\n")
}

#[test]
fn codecs_are_measured() {
    let output = run("codecs.py", &["--iterations", "10", "--rounds", "1"]);
    for name in ["protobuf", "json of a message", "json", "cbor", "msgpack", "pickle", "xml"] {
        assert!(output.lines().any(|line| line.starts_with(&format!("{name}  "))), "{name}: {output}");
    }
}

#[test]
fn delays_are_measured() {
    let output = run("delay.py", &["--seconds", "0.2"]);
    for name in ["SCL, idle", "pyzmq, idle", "SCL, load", "pyzmq, load"] {
        assert!(output.lines().any(|line| line.starts_with(name)), "{name}: {output}");
    }
    // Where real-time priority is not permitted, the program says so.
    assert!(["SCL, real-time", "not measured"].iter().any(|words| output.contains(words)), "{output}");
}

#[test]
fn the_programs_are_typed_and_formatted() {
    for arguments in [
        &["-m", "mypy", "--strict", "bench/python"][..],
        &["-m", "ruff", "format", "--check", "--no-cache", "bench/python"],
    ] {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
        let output = Command::new(python_with_scl()).args(arguments).current_dir(root).output().expect("Python");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    }
}
