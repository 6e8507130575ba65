//! Mistakes in `hosts` and `gateway`, with their places.

use super::check;
use expect_test::expect;

#[test]
fn every_mistake_in_hosts_is_reported() {
    check(
        &[(
            "launch.yaml",
            "\
components:
  sensor: {command: ls}
hosts:
  board: {adress: 192.0.2.10, components: [sensor, dsplay], colour: red}
  ground: {address: 192.0.2.20:7447, components: sensor, port: 70000}
  a b: {address: 192.0.2.30, components: [sensor]}
  authority: {address: 192.0.2.40, components: [sensor]}
  x: {}
  y: 192.0.2.50
gateway: {prt: 7447, insecure: yes}
",
        )],
        &["run"],
        &expect![[r#"
            error: [SCL1201] unknown key `adress` in host `board`
             --> ./launch.yaml:4:11
              |
            4 |   board: {adress: 192.0.2.10, components: [sensor, dsplay], colour: red}
              |           ^^^^^^
              |
              = help: did you mean `address`?

            error: [SCL1205] unknown component `dsplay`
             --> ./launch.yaml:4:52
              |
            4 |   board: {adress: 192.0.2.10, components: [sensor, dsplay], colour: red}
              |                                                    ^^^^^^
              |
              = help: did you mean `display`?
              = note: the topology has the components `sensor`, `display`

            error: [SCL1201] unknown key `colour` in host `board`
             --> ./launch.yaml:4:61
              |
            4 |   board: {adress: 192.0.2.10, components: [sensor, dsplay], colour: red}
              |                                                             ^^^^^^
              |
              = note: the keys are `address`, `components`, `port`

            error: [SCL1202] `address` is an address alone, not `192.0.2.20:7447`
             --> ./launch.yaml:5:21
              |
            5 |   ground: {address: 192.0.2.20:7447, components: sensor, port: 70000}
              |                     ^^^^^^^^^^^^^^^
              |
              = help: write `address: 192.0.2.20`

            error: [SCL1202] host `ground` has no list of `components`
             --> ./launch.yaml:5:50
              |
            5 |   ground: {address: 192.0.2.20:7447, components: sensor, port: 70000}
              |                                                  ^^^^^^
              |
              = help: write `components: [sensor]`

            error: [SCL1202] `port` is a number, 1 to 65535, not `70000`
             --> ./launch.yaml:5:64
              |
            5 |   ground: {address: 192.0.2.20:7447, components: sensor, port: 70000}
              |                                                                ^^^^^

            error: [SCL1207] `a b` cannot be the name of a host
             --> ./launch.yaml:6:3
              |
            6 |   a b: {address: 192.0.2.30, components: [sensor]}
              |   ^^^
              |
              = help: write `a-b`
              = note: a host name has up to 63 letters, digits, `_` and `-`, and starts with a letter or digit

            error: [SCL1207] `authority` cannot be the name of a host
             --> ./launch.yaml:7:3
              |
            7 |   authority: {address: 192.0.2.40, components: [sensor]}
              |   ^^^^^^^^^
              |
              = note: this is the folder of the authority that signs the certificates

            error: [SCL1204] host `x` has no `address`
             --> ./launch.yaml:8:3
              |
            8 |   x: {}
              |   ^
              |
              = help: it is the IP address or the DNS name by which the other hosts reach it

            error: [SCL1204] host `x` has no list of `components`
             --> ./launch.yaml:8:3
              |
            8 |   x: {}
              |   ^
              |
              = help: it lists the components that run there

            error: [SCL1203] the entry of host `y` is a mapping, not `192.0.2.50`
             --> ./launch.yaml:9:6
              |
            9 |   y: 192.0.2.50
              |      ^^^^^^^^^^
              |
              = help: it has an `address` and a list of `components`

            error: [SCL1201] unknown key `prt` in `gateway`
              --> ./launch.yaml:10:11
               |
            10 | gateway: {prt: 7447, insecure: yes}
               |           ^^^
               |
               = help: did you mean `port`?

            error: [SCL1202] `insecure` is `true` or `false`, not `yes`
              --> ./launch.yaml:10:32
               |
            10 | gateway: {prt: 7447, insecure: yes}
               |                                ^^^
               |
               = help: did you mean `insecure: true`?

        "#]],
    );
}

#[test]
fn hosts_must_fit_together() {
    check(
        &[(
            "launch.yaml",
            "\
components:
  sensor: {command: ls}
hosts:
  board: {address: 192.0.2.10, components: [sensor]}
  ground: {address: 192.0.2.10, components: [sensor, sensor]}
gateway: {port: 7447}
",
        )],
        &["run"],
        &expect![[r#"
            error: [SCL1208] component `display` is on no host
             --> ./launch.yaml:3:1
              |
            3 | hosts:
              | ^^^^^
              |
              = help: add `display` to `components` of host `board`
              = help: add `display` to `components` of host `ground`

            error: [SCL1208] host `board` is not on loopback, and `gateway` has no `certificates`
             --> ./launch.yaml:4:20
              |
            4 |   board: {address: 192.0.2.10, components: [sensor]}
              |                    ^^^^^^^^^^
              |
              = help: with certificates, which `scl gateway keys` makes: add `certificates: ./keys` to `gateway`
              = help: without certificates, so that everybody on the network can listen and send: add `insecure: true` to `gateway`
              = note: without certificates everybody on the network could listen and send

            error: [SCL1208] the hosts `board` and `ground` have the same address, `192.0.2.10:7447`
             --> ./launch.yaml:5:21
              |
            4 |   board: {address: 192.0.2.10, components: [sensor]}
              |                    ---------- first here
            5 |   ground: {address: 192.0.2.10, components: [sensor, sensor]}
              |                     ^^^^^^^^^^
              |
              = help: on one machine, give each its own `port`

            error: [SCL1208] component `sensor` is on two hosts, `board` and `ground`
             --> ./launch.yaml:5:46
              |
            4 |   board: {address: 192.0.2.10, components: [sensor]}
              |                                             ------ first here
            5 |   ground: {address: 192.0.2.10, components: [sensor, sensor]}
              |                                              ^^^^^^
              |
              = help: remove it from `ground`

            error: [SCL1208] component `sensor` is on two hosts, `board` and `ground`
             --> ./launch.yaml:5:54
              |
            4 |   board: {address: 192.0.2.10, components: [sensor]}
              |                                             ------ first here
            5 |   ground: {address: 192.0.2.10, components: [sensor, sensor]}
              |                                                      ^^^^^^
              |
              = help: remove it from `ground`

        "#]],
    );
    let one = "components: {sensor: {command: ls}}\nhosts: {a: {address: 0.0.0.0, components: [sensor, display]}}\n";
    check(
        &[("launch.yaml", one)],
        &["run"],
        &expect![[r#"
            error: [SCL1204] `gateway` is missing, but `hosts` needs it
             --> ./launch.yaml:2:1
              |
            2 | hosts: {a: {address: 0.0.0.0, components: [sensor, display]}}
              | ^^^^^
              |
              = help: with all hosts on this machine: `gateway: {port: 7447}`
              = help: with certificates, which `scl gateway keys` makes: `gateway: {port: 7447, certificates: ./keys}`
              = help: without certificates, so that everybody on the network can listen and send: `gateway: {port: 7447, insecure: true}`

            error: [SCL1208] the other hosts cannot connect to `0.0.0.0`
             --> ./launch.yaml:2:22
              |
            2 | hosts: {a: {address: 0.0.0.0, components: [sensor, display]}}
              |                      ^^^^^^^
              |
              = help: write the address of one of the host's network interfaces

        "#]],
    );
    let one = "components: {sensor: {command: ls}}\nhosts: []\ngateway: 7447\n";
    check(
        &[("launch.yaml", one)],
        &["run"],
        &expect![[r#"
            error: [SCL1203] `hosts` is a mapping from names to entries, not a list
             --> ./launch.yaml:2:8
              |
            2 | hosts: []
              |        ^^
              |
              = help: each host has an entry with its `address` and its `components`

            error: [SCL1203] `gateway` is a mapping, not `7447`
             --> ./launch.yaml:3:10
              |
            3 | gateway: 7447
              |          ^^^^
              |
              = help: with all hosts on this machine: `gateway: {port: 7447}`
              = help: with certificates, which `scl gateway keys` makes: `gateway: {port: 7447, certificates: ./keys}`
              = help: without certificates, so that everybody on the network can listen and send: `gateway: {port: 7447, insecure: true}`

        "#]],
    );
    let one = "components: {sensor: {command: ls}}\ngateway: {port: 7447}\n";
    check(
        &[("launch.yaml", one)],
        &["run"],
        &expect![[r#"
            error: [SCL1206] `gateway` has no effect without `hosts`
             --> ./launch.yaml:2:1
              |
            2 | gateway: {port: 7447}
              | ^^^^^^^
              |
              = help: remove `gateway`
              = note: `hosts` says which components run on which host

        "#]],
    );
}
