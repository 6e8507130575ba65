//! What `scl run` says when nothing can be started: every mistake, each with its place and the way out.

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
            error: unknown key `transprt` in a launch file
             --> launch.yaml:1:1
              = help: did you mean `transport`?

            error: unknown key `comand` in component `sensor`
             --> launch.yaml:4:25
              = help: did you mean `command`?

            error: unknown key `colour` in component `b`
             --> launch.yaml:5:20
              = note: the keys are `alive_within`, `build`, `command`, `cpu`, `descriptors`, `environment`, `essential`, `input`, `opens`, `priority`, `ready_within`, `replay`, `restart`, `restart_delay`, `restart_limit`, `stop_within`, `working_directory`

        "#]],
    );
}

#[test]
fn a_missing_or_empty_command_is_shown_how_to_write() {
    check(
        "components:\n  a: {working_directory: .}\n  b:\n    command: []\n  c: ./run\n  d: {comand: ls}\n  e: {command: ['']}\n",
        &expect![[r#"
            error: component `a` has no usable `command`
             --> launch.yaml:2:3
              = help: write `command: ./a` or `command: [./a, --verbose]`

            error: component `b` has no usable `command`
             --> launch.yaml:4:5
              = help: write `command: ./b` or `command: [./b, --verbose]`

            error: the entry of component `c` is not a mapping
             --> launch.yaml:5:3
              = help: write `c: {command: ./run}`

            error: unknown key `comand` in component `d`
             --> launch.yaml:6:7
              = help: did you mean `command`?

            error: component `e` has no usable `command`
             --> launch.yaml:7:7
              = help: write `command: ./e` or `command: [./e, --verbose]`

        "#]],
    );
}

#[test]
fn values_of_the_wrong_kind_are_named() {
    check(
        "transport: udp\nenvironment: [A]\ncomponents:\n  a: {command: ls, working_directory: 3, environment: {A: [1], B: , 'C=': x}}\n  1: {command: ls}\n",
        &expect![[r#"
            error: the variable `A` is a text, not a list
             --> launch.yaml:4:56
              = help: write `A: "..."`

            error: the variable `B` is a text, not nothing
             --> launch.yaml:4:64
              = help: write `B: "..."`

            error: `C=` is not the name of an environment variable
             --> launch.yaml:4:42

            error: `working_directory` is a path, not `3`
             --> launch.yaml:4:20

            error: the name of a component is a word, not `1`
             --> launch.yaml:3:1

            error: `environment` is a mapping like `{RUST_LOG: info}`, not a list
             --> launch.yaml:2:1

            error: `transport` is `ipc`, `tcp` or `shm`, not `udp`
             --> launch.yaml:1:1

        "#]],
    );
}

#[test]
fn a_file_without_components_is_shown_one() {
    for launch in ["{}", "components:", "components: {}", "components: [a]"] {
        let system = System::of_files(&[("launch.yaml", launch)]);
        let output = system.run(&[]);
        let err = String::from_utf8(output.stderr).unwrap();
        assert!(err.contains("  = help: write `components: {sensor: {command: ./sensor}}`\n"), "{launch}:\n{err}");
        assert_eq!(output.status.code(), Some(2), "{launch}");
    }
}

#[test]
fn a_text_that_is_no_mapping_says_so() {
    check(
        "- a\n",
        &expect![[r#"
            error: a launch file is a mapping that starts with `components:`
             --> launch.yaml

        "#]],
    );
}

#[test]
fn a_text_that_is_no_yaml_has_its_place() {
    check(
        "components:\n  a: {command: [ls}\n",
        &expect![[r#"
            error: did not find expected ',' or ']', while parsing a flow sequence at line 2 column 16
             --> launch.yaml:2:19

        "#]],
    );
}

#[test]
fn a_key_given_twice_is_named() {
    check(
        "components:\n  a: {command: ls}\n  a: {command: ls}\n",
        &expect![[r#"
            error: components: duplicate entry with key "a"
             --> launch.yaml:2:3

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
            error: this `build` is not a command
             --> launch.yaml:4:1
              = help: write `build: make sensor` or `build: [make, sensor]`

            error: this `build` is not a command
             --> launch.yaml:2:20
              = help: write `build: make sensor` or `build: [make, sensor]`

            error: this `build` is not a command
             --> launch.yaml:3:20
              = help: write `build: make sensor` or `build: [make, sensor]`

            error: unknown key `comand` in component `a`
             --> launch.yaml:6:16
              = help: did you mean `command`?

            error: component `c` has no usable `command`
             --> launch.yaml:6:29
              = help: write `command: ./c` or `command: [./c, --verbose]`

            error: the entry of component `b` is not a mapping
             --> launch.yaml:6:56
              = help: write `b: {command: ls}`

            error: profile `sim` is not a mapping from components to commands
             --> launch.yaml:7:3
              = help: write `sim: {sensor: {command: ./sensor}}`

            error: the name of a profile is a word, not `2`
             --> launch.yaml:5:1

        "#]],
    );
    check(
        "components: {a: {command: ls}}\nprofiles: [python]\ntopology: []\n",
        &expect![[r#"
        error: `topology` is a path, not a list
         --> launch.yaml:3:1

        error: `profiles` is a mapping, not a list
         --> launch.yaml:2:1
          = help: write `profiles: {python: {sensor: {command: ./sensor.py}}}`

    "#]],
    );
}

#[test]
fn a_missing_topology_file_is_reported_where_it_is_named() {
    check(
        "components: {a: {command: ls}}\ntopology: wiring.yaml\n",
        &expect![[r#"
        error: the topology file does not exist: `FOLDER/wiring.yaml`
         --> launch.yaml:2:1

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
        error: unknown component `sensr`
         --> launch.yaml:3:21
          = help: did you mean `sensor`?
          = note: the topology has the components `sensor`

    "#]]
    .assert_eq(&String::from_utf8(output.stderr).unwrap());
}

/// Every setting with wrong values, in an entry or in `defaults`.
#[test]
fn wrong_settings_are_named_with_what_was_probably_meant() {
    check(
        "\
defaults: {command: ls, restart: sometimes, environment: {}}
components:
  a:
    command: ls
    restart: on-failure
    restart_delay: 100ms-5s
    restart_limit: 5/1m
    essential: yes please
    stop_within: 3
    ready_within: 0s
    alive_within: soon
    cpu: [0, -1]
    priority: 80
    working_directory: ''
  b: {command: ls, restart: true, restart_delay: 5s..1s, restart_limit: 5, cpu: [], priority: fifo:100, essential: off}
  c: {command: ls, replay: a.mcap}
  d: {replay: a.mcap, build: make}
  e: {replay: [a.mcap]}
  f: {repaly: a.mcap}
",
        &expect![[r#"
            error: `restart` is `never`, `on_abnormal`, `on_failure` or `always`, not `on-failure`
             --> launch.yaml:5:5
              = help: did you mean `restart: on_failure`?

            error: `restart_delay` is a range like `100ms..5s`, or one time, not `100ms-5s`
             --> launch.yaml:6:5
              = help: did you mean `restart_delay: 100ms..5s`?

            error: `restart_limit` is a number of restarts and a time, like `5 in 1m`, not `5/1m`
             --> launch.yaml:7:5
              = help: did you mean `restart_limit: 5 in 1m`?

            error: `essential` is `true` or `false`, not `yes please`
             --> launch.yaml:8:5

            error: `stop_within` is a time like `500ms` or `3s`, not `3`
             --> launch.yaml:9:5
              = help: did you mean `stop_within: 3s`?

            error: `ready_within` is a time like `500ms` or `3s`, not `0s`
             --> launch.yaml:10:5

            error: `alive_within` is a time like `500ms` or `3s`, not `soon`
             --> launch.yaml:11:5

            error: `cpu` is a list of processors like `[2, 3]`, counted from 0, or one of them, not `[0, -1]`
             --> launch.yaml:12:5

            error: `priority` is `fifo:1` to `fifo:99`, not `80`
             --> launch.yaml:13:5
              = help: did you mean `priority: fifo:80`?

            error: `working_directory` is a path, not ``
             --> launch.yaml:14:5

            error: `restart` is `never`, `on_abnormal`, `on_failure` or `always`, not `true`
             --> launch.yaml:15:20

            error: `restart_delay` is a range like `100ms..5s`, or one time, not `5s..1s`
             --> launch.yaml:15:35

            error: `restart_limit` is a number of restarts and a time, like `5 in 1m`, not `5`
             --> launch.yaml:15:58

            error: `essential` is `true` or `false`, not `off`
             --> launch.yaml:15:105
              = help: did you mean `essential: false`?

            error: `cpu` is a list of processors like `[2, 3]`, counted from 0, or one of them, not a list
             --> launch.yaml:15:76

            error: `priority` is `fifo:1` to `fifo:99`, not `fifo:100`
             --> launch.yaml:15:85

            error: component `c` has both a `command` and a `replay`
             --> launch.yaml:16:20
              = help: put one of them into a profile

            error: a `replay` needs no `build`
             --> launch.yaml:17:23
              = help: remove it

            error: `replay` is a path, not a list
             --> launch.yaml:18:7

            error: unknown key `repaly` in component `f`
             --> launch.yaml:19:7
              = help: did you mean `replay`?

            error: unknown key `command` in `defaults`
             --> launch.yaml:1:12
              = note: the keys are `alive_within`, `cpu`, `descriptors`, `essential`, `priority`, `ready_within`, `restart`, `restart_delay`, `restart_limit`, `stop_within`, `working_directory`

            error: unknown key `environment` in `defaults`
             --> launch.yaml:1:45
              = note: the keys are `alive_within`, `cpu`, `descriptors`, `essential`, `priority`, `ready_within`, `restart`, `restart_delay`, `restart_limit`, `stop_within`, `working_directory`

            error: `restart` is `never`, `on_abnormal`, `on_failure` or `always`, not `sometimes`
             --> launch.yaml:1:25

        "#]],
    );
}

#[test]
fn words_of_other_tools_are_understood() {
    check(
        "\
components:
  a: {cmd: ls, folder: x, depends_on: b, respawn: true, watchdog: 1s, env: {A: 1}, max_restarts: 3, Grace: 1s}
default: {restart: always}
",
        &expect![[r#"
            error: unknown key `default` in a launch file
             --> launch.yaml:3:1
              = help: did you mean `defaults`?

            error: unknown key `cmd` in component `a`
             --> launch.yaml:2:7
              = help: did you mean `command`?

            error: unknown key `folder` in component `a`
             --> launch.yaml:2:16
              = help: did you mean `working_directory`?

            error: unknown key `depends_on` in component `a`
             --> launch.yaml:2:27
              = help: did you mean `ready_within`?

            error: unknown key `respawn` in component `a`
             --> launch.yaml:2:42
              = help: did you mean `restart`?

            error: unknown key `watchdog` in component `a`
             --> launch.yaml:2:57
              = help: did you mean `alive_within`?

            error: unknown key `env` in component `a`
             --> launch.yaml:2:71
              = help: did you mean `environment`?

            error: unknown key `max_restarts` in component `a`
             --> launch.yaml:2:84
              = help: did you mean `restart_limit`?

            error: unknown key `Grace` in component `a`
             --> launch.yaml:2:101
              = help: did you mean `stop_within`?

        "#]],
    );
}

#[test]
fn a_recording_must_exist() {
    check(
        "components: {a: {replay: flight.mcap}}\n",
        &expect![[r#"
        error: the recording of component `a` does not exist: `FOLDER/flight.mcap`

    "#]],
    );
}

#[test]
fn defaults_are_a_mapping() {
    check(
        "components: {a: {command: ls}}\ndefaults: always\n",
        &expect![[r#"
        error: `defaults` is a mapping, not `always`
         --> launch.yaml:2:1
          = help: write `defaults: {restart: on_failure, stop_within: 3s}`

    "#]],
    );
}
