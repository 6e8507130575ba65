//! What `scl check` says, where it says it, and its exit codes.

use crate::system::System;
use expect_test::{Expect, expect};

/// Without a problem.
const CLEAN: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
";

/// With two errors.
const ERRORS: &str = "\
componets:
  - name: sensor
colour: red
";

/// What a test expects of one run.
struct Expected {
    code: i32,
    out: Expect,
    err: Expect,
}

#[track_caller]
fn check(files: &[(&str, &str)], arguments: &[&str], expected: &Expected) {
    let output = System::of_files(files).scl(&[&["check"], arguments].concat()).output().unwrap();
    expected.out.assert_eq(&String::from_utf8(output.stdout).unwrap());
    expected.err.assert_eq(&String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(expected.code));
}

#[test]
fn a_clean_file_is_counted() {
    let expected = Expected {
        code: 0,
        out: expect![[""]],
        err: expect![[r#"
        topology.yaml: 2 components, 2 gates, 1 connection
    "#]],
    };
    check(&[("topology.yaml", CLEAN)], &[], &expected);
}

#[test]
fn names_that_clash_in_another_language_are_a_note() {
    let text = "\
components:
  - name: motor
    gates:
      - speed: pub
  - name: motor-open
    gates:
      - speed: sub
connections:
  - [motor.speed, motor-open.speed]
";
    let expected = |err| Expected { code: 0, out: expect![[""]], err };
    check(
        &[("topology.yaml", text)],
        &[],
        &expected(expect![[r#"
        topology.yaml: note: component `motor` and component `motor-open` would both become `topology_motor_open` in C; `scl check --for c` shows where
        topology.yaml: 2 components, 2 gates, 1 connection
    "#]]),
    );
    // With `--for`, the languages that were not asked for are still named.
    check(
        &[("topology.yaml", text)],
        &["--for", "python"],
        &expected(expect![[r#"
        topology.yaml: note: component `motor` and component `motor-open` would both become `topology_motor_open` in C; `scl check --for c` shows where
        topology.yaml: 2 components, 2 gates, 1 connection
    "#]]),
    );
}

#[test]
fn warnings_do_not_fail() {
    let warned = CLEAN.replace("connections:", "  - name: logger\nconnections:");
    let expected = Expected {
        code: 0,
        out: expect![[""]],
        err: expect![[r#"
        warning: [SCL0209] component `logger` has no gates
         --> topology.yaml:8:11
          |
        8 |   - name: logger
          |           ^^^^^^ it cannot be part of any connection
          |
          = help: each gate is an item of the list `gates`: `- name: kind`
          = help: if it is meant to have none, write `gates: []`

        topology.yaml: 3 components, 2 gates, 1 connection; 1 warning
    "#]],
    };
    check(&[("topology.yaml", &warned)], &[], &expected);
}

#[test]
fn every_error_is_shown_and_counted() {
    let expected = Expected {
        code: 1,
        out: expect![[""]],
        err: expect![[r#"
            error: [SCL0202] unknown section `componets`
             --> topology.yaml:1:1
              |
            1 | componets:
              | ^^^^^^^^^ not a section of a topology
              |
              = help: did you mean `components`?
              = note: sections: `components`, `connections`, `kinds`, `everyone`, `include`, `exports`, `system`, `schemas`, `schema_roots`, `codec`, `scl`
              = note: keys that start with `x-` are ignored, for your own use

            error: [SCL0202] unknown section `colour`
             --> topology.yaml:3:1
              |
            3 | colour: red
              | ^^^^^^ not a section of a topology
              |
              = note: sections: `components`, `connections`, `kinds`, `everyone`, `include`, `exports`, `system`, `schemas`, `schema_roots`, `codec`, `scl`
              = note: keys that start with `x-` are ignored, for your own use

            topology.yaml: 2 errors
        "#]],
    };
    check(&[("topology.yaml", ERRORS)], &[], &expected);
}

#[test]
fn json_goes_to_standard_output_one_object_a_line() {
    let expected = Expected {
        code: 1,
        out: expect![[r#"
            {"code":"SCL0202","severity":"error","message":"unknown section `componets`","file":"topology.yaml","line":1,"column":1,"end_line":1,"end_column":10,"labels":[{"file":"topology.yaml","line":1,"column":1,"end_line":1,"end_column":10,"text":"not a section of a topology"}],"helps":["did you mean `components`?"],"notes":["sections: `components`, `connections`, `kinds`, `everyone`, `include`, `exports`, `system`, `schemas`, `schema_roots`, `codec`, `scl`","keys that start with `x-` are ignored, for your own use"],"fixes":[{"file":"topology.yaml","line":1,"column":1,"end_line":1,"end_column":10,"replacement":"components","sure":true,"proposal":0,"help":0}]}
            {"code":"SCL0202","severity":"error","message":"unknown section `colour`","file":"topology.yaml","line":3,"column":1,"end_line":3,"end_column":7,"labels":[{"file":"topology.yaml","line":3,"column":1,"end_line":3,"end_column":7,"text":"not a section of a topology"}],"helps":[],"notes":["sections: `components`, `connections`, `kinds`, `everyone`, `include`, `exports`, `system`, `schemas`, `schema_roots`, `codec`, `scl`","keys that start with `x-` are ignored, for your own use"],"fixes":[]}
        "#]],
        err: expect![[""]],
    };
    check(&[("topology.yaml", ERRORS)], &["--format", "json"], &expected);
}

#[test]
fn lints_are_shown_on_request_and_do_not_fail() {
    let files = [("topology.yaml", CLEAN)];
    let expected = Expected {
        code: 0,
        out: expect![[""]],
        err: expect![[r#"
        warning: [SCL0402] this connection carries bytes of no declared type
         --> topology.yaml:9:5
          |
        4 |       - measurements: pub
          |         ----------------- no type
        ...
        7 |       - sensor: sub
          |         ----------- no type
        8 | connections:
        9 |   - [sensor.measurements, controller.sensor]
          |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ neither end names a type
          |
          = help: name it on one end: `measurements: {pub: Measurement}`; the other end takes it over

        topology.yaml: 2 components, 2 gates, 1 connection; 1 lint
    "#]],
    };
    check(&files, &["--lints"], &expected);
}

#[test]
fn the_worst_of_several_files_is_the_exit_code() {
    let files = [("a.yaml", CLEAN), ("b.yaml", ERRORS)];
    let system = System::of_files(&files);
    for (arguments, code) in [
        (&["a.yaml"][..], 0),
        (&["a.yaml", "b.yaml"], 1),
        (&["b.yaml", "a.yaml"], 1),
        (&["missing.yaml", "b.yaml"], 2),
        (&["."], 2),
        (&["/dev/zero"], 2),
    ] {
        let output = system.scl(&[&["check"], arguments].concat()).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
    }
}

#[test]
fn colours_are_for_those_who_want_them() {
    let system = System::of_files(&[("topology.yaml", ERRORS)]);
    for (variable, coloured) in [("CLICOLOR_FORCE", true), ("NO_COLOR", false)] {
        let output = system.scl(&["check"]).env(variable, "1").output().unwrap();
        assert_eq!(output.stderr.contains(&b'\x1b'), coloured, "{variable}");
    }
}

#[test]
fn a_reader_that_has_gone_is_no_panic() {
    let system = System::of_files(&[("topology.yaml", ERRORS)]);
    let mut command = system.scl(&["check", "--format", "json"]);
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let output = command.stdout(writer).stderr(std::process::Stdio::piped()).output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    assert_eq!(output.status.code(), Some(1));
}
