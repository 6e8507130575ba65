//! Restarts, limits of time and the like, written wrongly or in the words of other tools.

use super::check;
use expect_test::expect;

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
            error: [SCL1201] unknown key `command` in `defaults`
             --> launch.yaml:1:12
              |
            1 | defaults: {command: ls, restart: sometimes, environment: {}}
              |            ^^^^^^^
              |
              = help: `command` belongs into the entries of components

            error: [SCL1202] `restart` is `never`, `on_abnormal`, `on_failure` or `always`, not `sometimes`
             --> launch.yaml:1:34
              |
            1 | defaults: {command: ls, restart: sometimes, environment: {}}
              |                                  ^^^^^^^^^

            error: [SCL1201] unknown key `environment` in `defaults`
             --> launch.yaml:1:45
              |
            1 | defaults: {command: ls, restart: sometimes, environment: {}}
              |                                             ^^^^^^^^^^^
              |
              = help: `environment` belongs at the top of the file

            error: [SCL1202] `restart` is `never`, `on_abnormal`, `on_failure` or `always`, not `on-failure`
             --> launch.yaml:5:14
              |
            5 |     restart: on-failure
              |              ^^^^^^^^^^
              |
              = help: did you mean `restart: on_failure`?

            error: [SCL1202] `restart_delay` is a range like `100ms..5s`, or one time, not `100ms-5s`
             --> launch.yaml:6:20
              |
            6 |     restart_delay: 100ms-5s
              |                    ^^^^^^^^
              |
              = help: did you mean `restart_delay: 100ms..5s`?

            error: [SCL1202] `restart_limit` is a number of restarts and a time, like `5 in 1m`, not `5/1m`
             --> launch.yaml:7:20
              |
            7 |     restart_limit: 5/1m
              |                    ^^^^
              |
              = help: did you mean `restart_limit: 5 in 1m`?

            error: [SCL1202] `essential` is `true` or `false`, not `yes please`
             --> launch.yaml:8:16
              |
            8 |     essential: yes please
              |                ^^^^^^^^^^

            error: [SCL1202] `stop_within` is a time like `500ms` or `3s`, not `3`
             --> launch.yaml:9:18
              |
            9 |     stop_within: 3
              |                  ^
              |
              = help: did you mean `stop_within: 3s`?

            error: [SCL1202] `ready_within` is a time like `500ms` or `3s`, not `0s`
              --> launch.yaml:10:19
               |
            10 |     ready_within: 0s
               |                   ^^
               |
               = help: without `ready_within`, there is no limit: remove it

            error: [SCL1202] `alive_within` is a time like `500ms` or `3s`, not `soon`
              --> launch.yaml:11:19
               |
            11 |     alive_within: soon
               |                   ^^^^

            error: [SCL1202] `cpu` is a list of processors like `[2, 3]`, counted from 0, or one of them, not `[0, -1]`
              --> launch.yaml:12:10
               |
            12 |     cpu: [0, -1]
               |          ^^^^^^^

            error: [SCL1202] `priority` is `fifo:1` to `fifo:99`, not `80`
              --> launch.yaml:13:15
               |
            13 |     priority: 80
               |               ^^
               |
               = help: did you mean `priority: fifo:80`?

            error: [SCL1202] `working_directory` is a path, not ``
              --> launch.yaml:14:24
               |
            14 |     working_directory: ''
               |                        ^^

            error: [SCL1202] `restart` is `never`, `on_abnormal`, `on_failure` or `always`, not `true`
              --> launch.yaml:15:29
               |
            15 |   b: {command: ls, restart: true, restart_delay: 5s..1s, restart_limit: 5, cpu: [], priority: fifo:100, essential: off}
               |                             ^^^^
               |
               = help: did you mean `restart: always`?

            error: [SCL1202] `restart_delay` is a range like `100ms..5s`, or one time, not `5s..1s`
              --> launch.yaml:15:50
               |
            15 |   b: {command: ls, restart: true, restart_delay: 5s..1s, restart_limit: 5, cpu: [], priority: fifo:100, essential: off}
               |                                                  ^^^^^^
               |
               = help: did you mean `restart_delay: 1s..5s`?
               = help: did you mean `restart_delay: 5s`?
               = note: the second time is the longest delay, so it cannot be shorter than the first

            error: [SCL1202] `restart_limit` is a number of restarts and a time, like `5 in 1m`, not `5`
              --> launch.yaml:15:73
               |
            15 |   b: {command: ls, restart: true, restart_delay: 5s..1s, restart_limit: 5, cpu: [], priority: fifo:100, essential: off}
               |                                                                         ^
               |
               = help: did you mean `restart_limit: 5 in 1m`?

            error: [SCL1202] `cpu` is a list of processors like `[2, 3]`, counted from 0, or one of them, not a list
              --> launch.yaml:15:81
               |
            15 |   b: {command: ls, restart: true, restart_delay: 5s..1s, restart_limit: 5, cpu: [], priority: fifo:100, essential: off}
               |                                                                                 ^^

            error: [SCL1202] `priority` is `fifo:1` to `fifo:99`, not `fifo:100`
              --> launch.yaml:15:95
               |
            15 |   b: {command: ls, restart: true, restart_delay: 5s..1s, restart_limit: 5, cpu: [], priority: fifo:100, essential: off}
               |                                                                                               ^^^^^^^^
               |
               = help: did you mean `priority: fifo:99`?

            error: [SCL1202] `essential` is `true` or `false`, not `off`
              --> launch.yaml:15:116
               |
            15 |   b: {command: ls, restart: true, restart_delay: 5s..1s, restart_limit: 5, cpu: [], priority: fifo:100, essential: off}
               |                                                                                                                    ^^^
               |
               = help: did you mean `essential: false`?

            error: [SCL1206] component `c` has both a `command` and a `replay`
              --> launch.yaml:16:20
               |
            16 |   c: {command: ls, replay: a.mcap}
               |                    ^^^^^^
               |
               = help: play the recording: remove `command`
               = help: run the program: remove `replay`

            error: [SCL1206] a `replay` needs no `build`
              --> launch.yaml:17:23
               |
            17 |   d: {replay: a.mcap, build: make}
               |                       ^^^^^
               |
               = help: remove it

            error: [SCL1202] `replay` is a path, not a list
              --> launch.yaml:18:15
               |
            18 |   e: {replay: [a.mcap]}
               |               ^^^^^^^^
               |
               = help: did you mean `replay: a.mcap`?

            error: [SCL1201] unknown key `repaly` in component `f`
              --> launch.yaml:19:7
               |
            19 |   f: {repaly: a.mcap}
               |       ^^^^^^
               |
               = help: did you mean `replay`?

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
            error: [SCL1201] unknown key `cmd` in component `a`
             --> launch.yaml:2:7
              |
            2 |   a: {cmd: ls, folder: x, depends_on: b, respawn: true, watchdog: 1s, env: {A: 1}, max_restarts: 3, Grace: 1s}
              |       ^^^
              |
              = help: did you mean `command`?

            error: [SCL1201] unknown key `folder` in component `a`
             --> launch.yaml:2:16
              |
            2 |   a: {cmd: ls, folder: x, depends_on: b, respawn: true, watchdog: 1s, env: {A: 1}, max_restarts: 3, Grace: 1s}
              |                ^^^^^^
              |
              = help: did you mean `working_directory`?

            error: [SCL1201] unknown key `depends_on` in component `a`
             --> launch.yaml:2:27
              |
            2 |   a: {cmd: ls, folder: x, depends_on: b, respawn: true, watchdog: 1s, env: {A: 1}, max_restarts: 3, Grace: 1s}
              |                           ^^^^^^^^^^
              |
              = help: remove `depends_on`
              = note: components start in any order: programs wait for their peers

            error: [SCL1201] unknown key `respawn` in component `a`
             --> launch.yaml:2:42
              |
            2 |   a: {cmd: ls, folder: x, depends_on: b, respawn: true, watchdog: 1s, env: {A: 1}, max_restarts: 3, Grace: 1s}
              |                                          ^^^^^^^
              |
              = help: write `restart: always`

            error: [SCL1201] unknown key `watchdog` in component `a`
             --> launch.yaml:2:57
              |
            2 |   a: {cmd: ls, folder: x, depends_on: b, respawn: true, watchdog: 1s, env: {A: 1}, max_restarts: 3, Grace: 1s}
              |                                                         ^^^^^^^^
              |
              = help: did you mean `alive_within`?

            error: [SCL1201] unknown key `env` in component `a`
             --> launch.yaml:2:71
              |
            2 |   a: {cmd: ls, folder: x, depends_on: b, respawn: true, watchdog: 1s, env: {A: 1}, max_restarts: 3, Grace: 1s}
              |                                                                       ^^^
              |
              = help: did you mean `environment`?

            error: [SCL1201] unknown key `max_restarts` in component `a`
             --> launch.yaml:2:84
              |
            2 |   a: {cmd: ls, folder: x, depends_on: b, respawn: true, watchdog: 1s, env: {A: 1}, max_restarts: 3, Grace: 1s}
              |                                                                                    ^^^^^^^^^^^^
              |
              = help: write `restart_limit: 3 in 1m`

            error: [SCL1201] unknown key `Grace` in component `a`
             --> launch.yaml:2:101
              |
            2 |   a: {cmd: ls, folder: x, depends_on: b, respawn: true, watchdog: 1s, env: {A: 1}, max_restarts: 3, Grace: 1s}
              |                                                                                                     ^^^^^
              |
              = help: did you mean `stop_within`?

            error: [SCL1201] unknown key `default` in a launch file
             --> launch.yaml:3:1
              |
            3 | default: {restart: always}
              | ^^^^^^^
              |
              = help: did you mean `defaults`?

        "#]],
    );
}

#[test]
fn defaults_are_a_mapping() {
    check(
        "components: {a: {command: ls}}\ndefaults: always\n",
        &expect![[r#"
            error: [SCL1203] `defaults` is a mapping, not `always`
             --> launch.yaml:2:11
              |
            2 | defaults: always
              |           ^^^^^^
              |
              = help: write `defaults: {restart: always}`

        "#]],
    );
}
