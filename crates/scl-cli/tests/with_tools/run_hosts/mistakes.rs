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
            error: unknown key `prt` in `gateway`
             --> ./launch.yaml:10:11
              = help: did you mean `port`?

            error: `insecure` is `true` or `false`, not `yes`
             --> ./launch.yaml:10:22
              = help: did you mean `insecure: true`?

            error: unknown key `adress` in host `board`
             --> ./launch.yaml:4:11
              = help: did you mean `address`?

            error: unknown key `colour` in host `board`
             --> ./launch.yaml:4:61
              = note: the keys are `address`, `components`, `port`

            error: unknown component `dsplay`
             --> ./launch.yaml:4:31
              = help: did you mean `display`?
              = note: the topology has the components `sensor`, `display`

            error: `address` is an address alone, not `192.0.2.20:7447`
             --> ./launch.yaml:5:12
              = help: write `address: 192.0.2.20, port: 7447`

            error: `port` is a number, 1 to 65535, not `70000`
             --> ./launch.yaml:5:58

            error: host `ground` has no list of `components`
             --> ./launch.yaml:5:38
              = help: write `components: [sensor, controller]`

            error: `a b` cannot be the name of a host
             --> ./launch.yaml:6:3
              = note: it has up to 63 letters, digits, `_` and `-`, and starts with a letter or digit

            error: no host can be called `authority`
             --> ./launch.yaml:7:3
              = note: this is the folder of the authority that signs the certificates

            error: host `x` has no `address`
             --> ./launch.yaml:8:3
              = help: write `address: 192.0.2.10`, as the other hosts reach it

            error: host `x` has no list of `components`
             --> ./launch.yaml:8:3
              = help: write `components: [sensor, controller]`

            error: the entry of host `y` is not a mapping
             --> ./launch.yaml:9:3
              = help: write `y: {address: 192.0.2.10, components: [sensor]}`

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
            error: component `sensor` is on two hosts, `board` and `ground`
             --> ./launch.yaml:5:33
              = help: remove it from one of the lists

            error: component `sensor` is on two hosts, `board` and `ground`
             --> ./launch.yaml:5:33
              = help: remove it from one of the lists

            error: component `display` is on no host
             --> ./launch.yaml:3:1
              = help: add each to `components` of the host that runs it

            error: the hosts `board` and `ground` have the same address, `192.0.2.10:7447`
             --> ./launch.yaml:5:12
              = help: on one machine, give each a `port` of its own

            error: host `board` is not on loopback, and `gateway` has no `certificates`
             --> ./launch.yaml:4:11
              = help: write `gateway: {port: 7447, certificates: ./keys}`, and run `scl gateway keys`
              = note: without certificates everybody on the network could listen and send

        "#]],
    );
    let one = "components: {sensor: {command: ls}}\nhosts: {a: {address: 0.0.0.0, components: [sensor, display]}}\n";
    check(
        &[("launch.yaml", one)],
        &["run"],
        &expect![[r#"
        error: the other hosts cannot connect to `0.0.0.0`
         --> ./launch.yaml:2:13
          = help: write the address of one of the host's network interfaces

        error: `gateway` is missing, which the hosts need
         --> ./launch.yaml:2:1
          = help: write `gateway: {port: 7447, certificates: ./keys}`

    "#]],
    );
    let one = "components: {sensor: {command: ls}}\nhosts: []\ngateway: 7447\n";
    check(
        &[("launch.yaml", one)],
        &["run"],
        &expect![[r#"
        error: `gateway` is a mapping, not `7447`
         --> ./launch.yaml:3:1
          = help: write `gateway: {port: 7447, certificates: ./keys}`

        error: `hosts` is a mapping from names to entries, not a list
         --> ./launch.yaml:2:1
          = help: write `hosts: {board: {address: 192.0.2.10, components: [sensor]}}`

    "#]],
    );
    let one = "components: {sensor: {command: ls}}\ngateway: {port: 7447}\n";
    check(
        &[("launch.yaml", one)],
        &["run"],
        &expect![[r#"
        error: `gateway` has no effect without `hosts`
         --> ./launch.yaml:2:1
          = help: write `hosts: {board: {address: 192.0.2.10, components: [sensor]}}`

    "#]],
    );
}
