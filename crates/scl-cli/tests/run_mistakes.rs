//! What `scl run` says when nothing can be started: every mistake, each with its place and the way out.

mod settings;

use crate::system::System;
use expect_test::{Expect, expect};

/// Runs a launch file that cannot be used; the folder of the test is shown as `FOLDER`.
#[track_caller]
fn check(launch: &str, expected: &Expect) {
    let system = System::of_files(&[("launch.yaml", launch)]);
    let output = system.run(&["launch.yaml"]);
    let folder = system.path("").canonicalize().unwrap();
    let err = String::from_utf8(output.stderr).unwrap().replace(&*folder.to_string_lossy(), "FOLDER");
    expected.assert_eq(&err);
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn unknown_keys_get_a_suggestion_and_the_list() {
    check(
        "transprt: ipc\ncomponents:\n  # sensor: {comand: ls}\n  sensor: {command: ls, comand: ls}\n  b: {command: ls, colour: red}\n",
        &expect![[r#"
            error: [SCL1201] unknown key `transprt` in a launch file
             --> launch.yaml:1:1
              |
            1 | transprt: ipc
              | ^^^^^^^^
              |
              = help: did you mean `transport`?

            error: [SCL1201] unknown key `comand` in component `sensor`
             --> launch.yaml:4:25
              |
            4 |   sensor: {command: ls, comand: ls}
              |                         ^^^^^^
              |
              = help: `command` is what this is called here: remove one of the two
              = note: `command` is there already

            error: [SCL1201] unknown key `colour` in component `b`
             --> launch.yaml:5:20
              |
            5 |   b: {command: ls, colour: red}
              |                    ^^^^^^
              |
              = note: the keys are `alive_within`, `build`, `command`, `cpu`, `descriptors`, `environment`, `essential`, `input`, `opens`, `parameters`, `priority`, `ready_within`, `replay`, `restart`, `restart_delay`, `restart_limit`, `stop_within`, `working_directory`

        "#]],
    );
}

#[test]
fn a_missing_or_empty_command_is_shown_how_to_write() {
    check(
        "components:\n  a: {working_directory: .}\n  b:\n    command: []\n  c: ./run\n  d: {comand: ls}\n  e: {command: ['']}\n",
        &expect![[r#"
            error: [SCL1204] component `a` has no usable `command`
             --> launch.yaml:2:3
              |
            2 |   a: {working_directory: .}
              |   ^
              |
              = note: a command is a text, or a list of the program and its arguments

            error: [SCL1202] component `b` has no usable `command`
             --> launch.yaml:4:14
              |
            4 |     command: []
              |              ^^
              |
              = note: a command is a text, or a list of the program and its arguments

            error: [SCL1203] the entry of component `c` is a mapping, not `./run`
             --> launch.yaml:5:6
              |
            5 |   c: ./run
              |      ^^^^^
              |
              = help: write `c: {command: ./run}`

            error: [SCL1201] unknown key `comand` in component `d`
             --> launch.yaml:6:7
              |
            6 |   d: {comand: ls}
              |       ^^^^^^
              |
              = help: did you mean `command`?

            error: [SCL1202] component `e` has no usable `command`
             --> launch.yaml:7:16
              |
            7 |   e: {command: ['']}
              |                ^^^^
              |
              = note: a command is a text, or a list of the program and its arguments

        "#]],
    );
}

#[test]
fn values_of_the_wrong_kind_are_named() {
    check(
        "transport: udp\nenvironment: [A]\ncomponents:\n  a: {command: ls, working_directory: 3, environment: {A: [1], B: , 'C=': x}}\n  1: {command: ls}\n",
        &expect![[r#"
            error: [SCL1202] `transport` is `ipc`, `tcp` or `shm`, not `udp`
             --> launch.yaml:1:12
              |
            1 | transport: udp
              |            ^^^

            error: [SCL1203] `environment` is a mapping, not a list
             --> launch.yaml:2:14
              |
            2 | environment: [A]
              |              ^^^
              |
              = help: each variable is an entry: its name, a colon, a space and its value

            error: [SCL1202] the variable `A` is a text, not a list
             --> launch.yaml:4:59
              |
            4 |   a: {command: ls, working_directory: 3, environment: {A: [1], B: , 'C=': x}}
              |                                                           ^^^
              |
              = help: write `A: 1`

            error: [SCL1202] the variable `B` is a text, not nothing
             --> launch.yaml:4:64
              |
            4 |   a: {command: ls, working_directory: 3, environment: {A: [1], B: , 'C=': x}}
              |                                                                ^
              |
              = help: write `B: ""`

            error: [SCL1207] `C=` is not the name of an environment variable
             --> launch.yaml:4:69
              |
            4 |   a: {command: ls, working_directory: 3, environment: {A: [1], B: , 'C=': x}}
              |                                                                     ^^^^

        "#]],
    );
}

#[test]
fn a_file_without_components_is_shown_one() {
    for launch in ["{}", "components:", "components: {}", "components: [a]"] {
        let system = System::of_files(&[("launch.yaml", launch)]);
        let output = system.run(&[]);
        let err = String::from_utf8(output.stderr).unwrap();
        let help = "  = help: an entry in it is named like a component, and `command` in the entry names its program\n";
        assert!(err.contains(help), "{launch}:\n{err}");
        assert_eq!(output.status.code(), Some(2), "{launch}");
    }
}

#[test]
fn a_text_that_is_no_mapping_says_so() {
    check(
        "- a\n",
        &expect![[r#"
            error: [SCL1203] a launch file is a mapping that starts with `components:`
             --> launch.yaml:1:1
              |
            1 | - a
              | ^^^

        "#]],
    );
}

#[test]
fn a_text_that_is_no_yaml_has_its_place() {
    check(
        "components:\n  a: {command: [ls}\n",
        &expect![[r#"
            error: [SCL0102] this `[` is never closed
             --> launch.yaml:2:16
              |
            2 |   a: {command: [ls}
              |                ^ opened here
              |
              = help: add `]` after `ls`

        "#]],
    );
}

#[test]
fn a_key_given_twice_is_named() {
    check(
        "components:\n  a: {command: ls}\n  a: {command: ls}\n",
        &expect![[r#"
            error: [SCL0107] the key `a` is written twice in `components`
             --> launch.yaml:3:3
              |
            2 |   a: {command: ls}
              |   - first time
            3 |   a: {command: ls}
              |   ^ second time
              |
              = help: remove the second one
              = help: remove the first one
              = note: YAML tools disagree which one wins: PyYAML silently keeps the second

        "#]],
    );
}

#[test]
fn programs_that_are_not_there_are_found_before_the_start() {
    check(
        "components:\n  a: {command: [no-such-program]}\n  b: {command: [./b]}\n  c: {command: [./launch.yaml]}\n  d: {command: ls, working_directory: d}\n",
        &expect![[r#"
            error: the program `no-such-program` of component `a` is not in the search path
              = help: install it, or write its path: `./no-such-program` is looked up in the component's folder

            error: the program of component `b` does not exist: `FOLDER/b`

            error: the program of component `c` is not executable: `FOLDER/launch.yaml`
              = help: make it so: `chmod +x FOLDER/launch.yaml`

            error: the folder of component `d` does not exist: `FOLDER/d`

        "#]],
    );
}

#[test]
fn a_folder_without_a_system_says_what_was_looked_for() {
    let system = System::of_files(&[]);
    let output = system.run(&[]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.starts_with("error: there is neither `launch.yaml` nor `topology.yaml` in `"), "{err}");
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(system.run(&["no-such-folder"]).status.code(), Some(2));
}

#[test]
fn mistakes_in_builds_and_profiles_have_their_place() {
    check(
        "\
components:
  a: {command: ls, build: []}
  b: {command: ls, build: {make: all}}
build: 3
profiles:
  python: {a: {comand: ls}, c: {working_directory: .}, b: ls}
  sim: [a]
  2: {}
",
        &expect![[r#"
            error: [SCL1202] this `build` is not a command
             --> launch.yaml:2:27
              |
            2 |   a: {command: ls, build: []}
              |                           ^^
              |
              = note: `build` is a command that builds the program: a text, or a list of its words

            error: [SCL1202] this `build` is not a command
             --> launch.yaml:3:27
              |
            3 |   b: {command: ls, build: {make: all}}
              |                           ^^^^^^^^^^^
              |
              = note: `build` is a command that builds the program: a text, or a list of its words

            error: [SCL1201] unknown key `comand` in component `a`
             --> launch.yaml:6:16
              |
            6 |   python: {a: {comand: ls}, c: {working_directory: .}, b: ls}
              |                ^^^^^^
              |
              = help: did you mean `command`?

            error: [SCL1204] `c` needs a `command` or a `replay` in profile `python`
             --> launch.yaml:6:29
              |
            6 |   python: {a: {comand: ls}, c: {working_directory: .}, b: ls}
              |                             ^
              |
              = note: `components` has no entry `c`

            error: [SCL1203] the entry of component `b` is a mapping, not `ls`
             --> launch.yaml:6:59
              |
            6 |   python: {a: {comand: ls}, c: {working_directory: .}, b: ls}
              |                                                           ^^
              |
              = help: write `b: {command: ls}`

            error: [SCL1203] profile `sim` is a mapping from components to entries, not a list
             --> launch.yaml:7:8
              |
            7 |   sim: [a]
              |        ^^^
              |
              = help: its entries are like those of `components`

        "#]],
    );
    check(
        "components: {a: {command: ls}}\nprofiles: [python]\ntopology: []\n",
        &expect![[r#"
            error: [SCL1203] `profiles` is a mapping, not a list
             --> launch.yaml:2:11
              |
            2 | profiles: [python]
              |           ^^^^^^^^
              |
              = help: each profile has entries like those of `components`

            error: [SCL1202] `topology` is a path, not a list
             --> launch.yaml:3:11
              |
            3 | topology: []
              |           ^^

        "#]],
    );
}

#[test]
fn a_missing_topology_file_is_reported_where_it_is_named() {
    check(
        "components: {a: {command: ls}}\ntopology: wiring.yaml\n",
        &expect![[r#"
            error: the topology file does not exist: `FOLDER/wiring.yaml`
             --> launch.yaml:2:11

        "#]],
    );
}

#[test]
fn profiles_are_compared_with_the_topology() {
    let launch = "topology: t.yaml\ncomponents: {sensor: {command: ls}}\nprofiles: {python: {sensr: {command: ls}}}\n";
    let topology = "components:\n  - name: sensor\n    gates: [{m: pub}]\n";
    let system = System::of_files(&[("launch.yaml", launch), ("t.yaml", topology)]);
    let output = system.run(&["launch.yaml"]);
    expect![[r#"
        error: [SCL1205] unknown component `sensr`
         --> launch.yaml:3:21
          |
        3 | profiles: {python: {sensr: {command: ls}}}
          |                     ^^^^^
          |
          = help: did you mean `sensor`?
          = note: the topology has the components `sensor`

    "#]]
    .assert_eq(&String::from_utf8(output.stderr).unwrap());
}

/// Every setting with wrong values, in an entry or in `defaults`.

#[test]
fn a_recording_must_exist() {
    check(
        "components: {a: {replay: flight.mcap}}\n",
        &expect![[r#"
        error: the recording of component `a` does not exist: `FOLDER/flight.mcap`

    "#]],
    );
}
