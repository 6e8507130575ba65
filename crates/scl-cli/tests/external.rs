//! `scl x` runs the user's `scl-x`.

use crate::system::System;
use expect_test::{Expect, expect};
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Output};

/// Files of a folder in `PATH`, with their modes.
const FILES: [(&str, u32, &str); 4] = [
    ("scl-hello", 0o755, "#!/bin/sh\necho \"$# arguments: $*, $(basename \"$SCL\")\"\nexit 7\n"),
    ("scl-plain", 0o644, "no program"),
    ("scl-broken", 0o755, "#!/nowhere/interpreter\n"),
    ("scl-list", 0o755, "#!/bin/sh\necho never run\n"),
];

fn run(arguments: &[&str]) -> (System, Output) {
    let system = System::of_files(&[]);
    for (name, mode, text) in FILES {
        system.write(&format!("bin/{name}"), text);
        std::fs::set_permissions(system.path(&format!("bin/{name}")), PermissionsExt::from_mode(mode)).unwrap();
    }
    let mut command: Command = system.scl(arguments);
    let path = std::env::var_os("PATH").unwrap();
    let folders = [system.path("bin")].into_iter().chain(std::env::split_paths(&path));
    let output = command.env("PATH", std::env::join_paths(folders).unwrap()).output().unwrap();
    (system, output)
}

#[track_caller]
fn check_error(arguments: &[&str], expected: &Expect) {
    let (system, output) = run(arguments);
    assert_eq!((output.status.code(), &*output.stdout), (Some(2), &b""[..]));
    let text = String::from_utf8(output.stderr).unwrap();
    expected.assert_eq(&text.replace(system.path("").to_str().unwrap(), "FOLDER/"));
}

#[test]
fn an_unknown_command_is_a_program_of_the_user() {
    let (_, output) = run(&["hello", "one", "--two", "-h"]);
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "3 arguments: one --two -h, scl\n");
    assert_eq!(output.status.code(), Some(7));
}

#[test]
fn misspelt_commands_get_a_suggestion() {
    check_error(
        &["grph"],
        &expect![[r#"
            error: there is no command `grph`
              = help: did you mean `scl graph`?
              = note: there is no program `scl-grph` beside `scl` or in PATH either
        "#]],
    );
    check_error(
        &["../hello\u{1b}"],
        &expect![[r#"
            error: there is no command `../hello\u{1b}`
              = help: `scl --help` lists the commands
              = note: there is no program `scl-../hello\u{1b}` beside `scl` or in PATH either
        "#]],
    );
}

#[cfg(not(feature = "bench"))]
#[test]
fn commands_that_are_not_built_in_name_their_feature() {
    check_error(
        &["bench", "roundtrip", "--bytes", "20"],
        &expect![[r#"
            error: there is no command `bench`
              = help: build `scl` with it, in the repository of SCL: `cargo build --release -p scl-cli --features bench`
              = note: there is no program `scl-bench` beside `scl` or in PATH either
        "#]],
    );
}

#[test]
fn programs_that_cannot_run_are_errors() {
    check_error(
        &["plain"],
        &expect![[r#"
            error: `FOLDER/bin/scl-plain` is not executable
              = help: run `chmod +x 'FOLDER/bin/scl-plain'`
        "#]],
    );
    check_error(
        &["broken"],
        &expect![[r#"
            error: cannot run `FOLDER/bin/scl-broken`: No such file or directory (os error 2)
              = help: check that it is a program for this machine, or a script whose first line names an interpreter
        "#]],
    );
}

#[test]
fn own_commands_come_first() {
    let (_, output) = run(&["explain", "queue"]);
    assert_eq!(output.status.code(), Some(0));
    let (_, output) = run(&["list", "--no-such-option"]);
    assert!(!String::from_utf8(output.stdout).unwrap().contains("never run"));
}
