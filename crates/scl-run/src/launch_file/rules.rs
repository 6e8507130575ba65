//! The rules about launch files, `SCL12xx`. Mistakes in the YAML itself are covered by the rules of topology files.

use scl_topology::diagnostic::{Rule, Severity};

const RULE: Rule = Rule { code: "", severity: Severity::Error, title: "", explanation: "", example: "" };

pub(super) const UNKNOWN_KEY: Rule = Rule {
    code: "SCL1201",
    title: "unknown key in a launch file",
    explanation: "A launch file has no such key at this place. It is probably misspelt, or has this name in another \
                  tool; ignoring it would hide the mistake. Correct it; at the top of the file, keys that start with \
                  `x-` are free for your own use.",
    example: " components:
   sensor:
     command: ./sensor
-    cwd: build
+    working_directory: build
",
    ..RULE
};

pub(super) const WRONG_VALUE: Rule = Rule {
    code: "SCL1202",
    title: "value that the key does not accept",
    explanation: "The key does not accept this value: a time without its unit, an unknown word, or a number out of \
                  range. The message says what the key accepts.",
    example: " components:
   sensor:
     command: ./sensor
-    restart: on-failure
+    restart: on_failure
",
    ..RULE
};

pub(super) const WRONG_SHAPE: Rule = Rule {
    code: "SCL1203",
    title: "list, mapping or text in the wrong place",
    explanation: "The file needs a mapping here, but has something else, for example a command in place of a \
                  component's entry. Write a mapping, such as `{command: ./sensor}`.",
    example: " components:
-  sensor: ./sensor
+  sensor: {command: ./sensor}
",
    ..RULE
};

pub(super) const MISSING: Rule = Rule {
    code: "SCL1204",
    title: "missing key in a launch file",
    explanation: "A launch file needs `components`, and each of them a `command` or a `replay`. With `hosts`, it also \
                  needs `gateway`; each host needs an `address`, its `components`, and a `port` of its own or that of \
                  `gateway`. Add the key that the message names.",
    example: " components:
   sensor:
+    command: ./sensor
     restart: always
",
    ..RULE
};

pub(super) const UNKNOWN_NAME: Rule = Rule {
    code: "SCL1205",
    title: "component, gate or parameter that is not in the topology",
    explanation: "A launch file that has a topology can name only that topology's components and gates, and only the \
                  parameters that it declares for a component. The message lists them.",
    example: " hosts:
-  board: {address: 127.0.0.1, port: 7447, components: [sensr]}
+  board: {address: 127.0.0.1, port: 7447, components: [sensor]}
 gateway: {}
 components:
   sensor: {command: ./sensor}
",
    ..RULE
};

pub(super) const CONTRADICTION: Rule = Rule {
    code: "SCL1206",
    title: "keys that exclude each other",
    explanation: "Two keys contradict each other, or a key has no effect without another. Remove one, or move one of \
                  them into a profile.",
    example: " components:
   sensor:
     command: ./sensor
-    replay: flight.mcap
+profiles:
+  flight:
+    sensor: {replay: flight.mcap}
",
    ..RULE
};

pub(super) const WRONG_NAME: Rule = Rule {
    code: "SCL1207",
    title: "text that cannot be used as this name",
    explanation: "This text cannot be the name of a host, a gate, a variable or, with `hosts`, a component: `gateway` \
                  is the program that connects them. Host names are used in certificates and folder names; names of \
                  gates and variables are passed to programs in the environment.",
    example: " components:
   sensor: {command: ./sensor}
 transports:
-  sensor: shm
+  sensor.images: shm
",
    ..RULE
};

pub(super) const HOSTS: Rule = Rule {
    code: "SCL1208",
    title: "hosts that cannot work together",
    explanation: "Each component must run on exactly one host. Each host needs its own address, which the others can \
                  connect to, and, if it is not on loopback, `certificates` or `insecure: true` in `gateway`.",
    example: " components:
   sensor: {command: ./sensor}
   controller: {command: ./controller}
 gateway: {port: 7447}
 hosts:
   board: {address: 127.0.0.1, components: [sensor]}
-  ground: {address: 127.0.0.2, components: [sensor, controller]}
+  ground: {address: 127.0.0.2, components: [controller]}
",
    ..RULE
};

pub(super) const UNCHECKED: Rule = Rule {
    code: "SCL1209",
    severity: Severity::Warning,
    title: "names that could not be checked",
    explanation: "The topology of the launch file has errors, so the names of components and gates cannot be checked. \
                  Correct the topology first; until then, `scl run` starts nothing.",
    ..RULE
};

pub(super) const LIKE_A_KEY: Rule = Rule {
    code: "SCL1210",
    severity: Severity::Warning,
    title: "variable with the name of a key",
    explanation: "A variable in `environment` has the name of a key of the entry and a value that this key accepts. It \
                  is probably the key, indented too far: as a variable it has no effect on the start of the program. \
                  Write it beside `environment`.",
    example: " components:
   sensor:
     command: ./sensor
     environment:
       RUST_LOG: info
-      restart: on_failure
+    restart: on_failure
",
};

pub(super) const UNSET: Rule = Rule {
    code: "SCL1211",
    severity: Severity::Warning,
    title: "parameter without a value",
    explanation: "The topology declares a parameter without a default, and neither `components` nor a profile gives it \
                  a value. `scl run` then starts the component only with a value from `--set` or `SCL_SET`. Write the \
                  value in `parameters` of the component's entry, or a default in the topology.",
    ..RULE
};

/// All rules, in the order of their codes.
pub const LAUNCH_RULES: &[&Rule] = &[
    &UNKNOWN_KEY,
    &WRONG_VALUE,
    &WRONG_SHAPE,
    &MISSING,
    &UNKNOWN_NAME,
    &CONTRADICTION,
    &WRONG_NAME,
    &HOSTS,
    &UNCHECKED,
    &LIKE_A_KEY,
    &UNSET,
];
