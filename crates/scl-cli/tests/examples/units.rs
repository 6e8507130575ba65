//! The unit tests of the examples' components in C, C++ and Python, as `build LANGUAGE check` builds and runs them.
//! Those in Rust are tests of the examples' crates.

use crate::{example, lock_machine};
use std::process::Command;

#[test]
fn the_parts_of_the_aircraft_in_c() {
    check("arcade", "c");
}

#[test]
fn the_parts_of_the_aircraft_in_cpp() {
    check("arcade", "cpp");
}

#[test]
fn the_parts_of_the_aircraft_in_python() {
    check("arcade", "python");
}

#[test]
fn the_parts_of_the_radio_in_cpp() {
    check("ospecorr", "cpp");
}

#[test]
fn the_parts_of_the_radio_in_python() {
    check("ospecorr", "python");
}

#[test]
fn the_topologies_have_no_warnings() {
    for name in ["arcade", "ospecorr"] {
        let mut check = Command::new(env!("CARGO_BIN_EXE_scl"));
        check.args(["check", "--deny", "warnings"]).arg(example(name).join("topology.yaml"));
        let output = check.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

/// The output of a failure is that of the tests, or what to install.
#[track_caller]
fn check(name: &str, language: &str) {
    let _machine = lock_machine();
    let mut build = Command::new(example(name).join("build"));
    let output = build.args([language, "check"]).env("SCL", env!("CARGO_BIN_EXE_scl")).output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(output.status.success(), "`build {language} check` of {name}\n{out}\n{err}");
}
