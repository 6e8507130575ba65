//! What `scl run` shows: whole lines of all components, with names, and how each ended.

use crate::system::{System, without_times};
use expect_test::{Expect, expect};

#[track_caller]
fn check(components: &[(&str, &str)], expected_code: i32, expected_out: &Expect, expected_err: &Expect) {
    let output = System::of(components).run(&[]);
    expected_out.assert_eq(&String::from_utf8(output.stdout).unwrap());
    expected_err.assert_eq(&without_times(&output.stderr));
    assert_eq!(output.status.code(), Some(expected_code));
}

#[test]
fn lines_carry_the_padded_name_and_the_last_needs_no_end() {
    check(
        &[("user_interface", "echo one; echo; printf two")],
        0,
        &expect![[r#"
            user_interface | one
            user_interface | 
            user_interface | two
        "#]],
        &expect![[r#"
            user_interface  ended with exit code 0 after N s
        "#]],
    );
}

#[test]
fn standard_error_stays_standard_error() {
    check(
        &[("sensor", "echo ill >&2")],
        0,
        &expect![[""]],
        &expect![[r#"
            sensor | ill
            sensor  ended with exit code 0 after N s
        "#]],
    );
}

#[test]
fn a_failed_component_is_named_with_its_code() {
    check(
        &[("sensor", "exit 7")],
        1,
        &expect![[""]],
        &expect![[r#"
            sensor  ended with exit code 7 after N s
            scl: component `sensor` failed: ended with exit code 7
        "#]],
    );
}

#[test]
fn a_crash_is_named_with_its_signal() {
    check(
        &[("sensor", "kill -SEGV $$")],
        1,
        &expect![[""]],
        &expect![[r#"
            sensor  killed by signal 11 (SIGSEGV) after N s
            scl: component `sensor` failed: killed by signal 11 (SIGSEGV)
        "#]],
    );
}

#[test]
fn names_are_padded_to_the_longest() {
    let system = System::of(&[("a", "echo 1"), ("longer", "echo 2")]);
    let out = String::from_utf8(system.run(&[]).stdout).unwrap();
    let mut lines: Vec<&str> = out.lines().collect();
    lines.sort_unstable();
    assert_eq!(lines, ["a      | 1", "longer | 2"]);
}

#[test]
fn bytes_that_are_not_text_survive() {
    let output = System::of(&[("sensor", r"printf '\377\000\376\r\nend\n'")]).run(&[]);
    assert_eq!(output.stdout, b"sensor | \xff\x00\xfe\r\nsensor | end\n");
}

#[test]
fn long_lines_of_several_components_are_never_mixed() {
    let long_lines = |letter: &str| {
        format!("for i in 1 2 3 4 5 6 7 8 9 10; do head -c 300000 /dev/zero | tr '\\0' {letter}; echo; done")
    };
    let (a, b, c) = (long_lines("a"), long_lines("b"), long_lines("c"));
    let output = System::of(&[("a", &a), ("b", &b), ("c", &c)]).run(&[]);
    let out = String::from_utf8(output.stdout).unwrap();
    for name in ["a", "b", "c"] {
        let expected = format!("{name} | {}", name.repeat(300_000));
        assert_eq!(out.lines().filter(|line| *line == expected).count(), 10, "whole lines of {name}");
    }
    assert_eq!(out.lines().count(), 30);
}

#[test]
fn colours_are_for_those_who_want_them() {
    let system = System::of(&[("sensor", "echo one")]);
    let coloured = system.scl(&["run"]).env("CLICOLOR_FORCE", "1").output().unwrap();
    assert_eq!(String::from_utf8(coloured.stdout).unwrap(), "\u{1b}[36msensor\u{1b}[39m | one\n");
    let plain = system.scl(&["run"]).env("NO_COLOR", "1").output().unwrap();
    assert_eq!(String::from_utf8(plain.stdout).unwrap(), "sensor | one\n");
}

#[test]
fn programs_get_environment_folder_and_transport_of_the_launch_file() {
    let system = System::of_files(&[
        (
            "launch.yaml",
            "\
transport: tcp
environment: {A: all, B: all}
components:
  sensor:
    command: 'echo $A $B $SCL_TRANSPORT $(basename $PWD) ${SCL_SYSTEM-unset}'
    environment: {B: 0.5}
    working_directory: below
",
        ),
        ("below/file", ""),
    ]);
    let output = system.scl(&["run"]).env_remove("SCL_SYSTEM").output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "sensor | all 0.5 tcp below unset\n");
}

#[test]
fn a_list_is_executed_as_it_is() {
    let system = System::of_files(&[("launch.yaml", "components: {a: {command: [printf, '%s;', '$A b', 1, true]}}")]);
    assert_eq!(String::from_utf8(system.run(&[]).stdout).unwrap(), "a | $A b;1;true;\n");
}

#[test]
fn a_line_of_100_megabytes_arrives_and_holds_nobody_up() {
    const LENGTH: usize = 100_000_000;
    let flood = format!("head -c {LENGTH} /dev/zero | tr '\\0' x");
    let output = System::of(&[("sensor", &flood), ("controller", "echo done")]).run(&[]);
    let count = |byte: u8| output.stdout.iter().filter(|it| **it == byte).count();
    // Split into parts, so that it does not fill the memory.
    assert_eq!(count(b'x'), LENGTH);
    assert!(count(b'\n') > 2);
    assert_eq!(output.status.code(), Some(0));
}

/// A paused `less`, Ctrl-S, a pipe that nobody reads.
#[test]
fn a_reader_that_takes_nothing_holds_no_component_up() {
    let print = "for i in $(seq 40); do head -c 1000000 /dev/zero | tr '\\0' x; echo; done";
    let system = System::of(&[("sensor", &format!("echo ready; {print}; echo done > go; exec tail -f /dev/null"))]);
    let pipe = system.make_pipe("go");
    let mut run = system.start(&["--grace", "1h"]);
    run.wait_for_line("sensor | ready");
    // From here on nobody reads.
    assert_eq!(std::fs::read_to_string(pipe).unwrap(), "done\n");
    run.signal("-TERM");
    let (status, out, err) = run.finish();
    let shown = out.lines().count();
    assert!(out.lines().all(|line| line.len() == "sensor | ".len() + 1_000_000), "only whole lines");
    let dropped = format!("scl: {} lines of `sensor` were dropped, because nobody read the output\n", 40 - shown);
    assert!(shown >= 16 && err.contains(&dropped), "{shown} lines shown: {err}");
    assert_eq!(status.code(), Some(0), "{err}");
}
