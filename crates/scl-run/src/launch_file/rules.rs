//! The rules about launch files, `SCL12xx`. What is wrong with the YAML itself is found by the rules of topology files.

use scl_topology::diagnostic::{Rule, Severity};

const RULE: Rule = Rule { code: "", severity: Severity::Error, title: "", explanation: "", example: "" };

pub(super) const UNKNOWN_KEY: Rule = Rule {
    code: "SCL1201",
    title: "unknown key in a launch file",
    explanation: "A launch file has no such key there, mostly because it is misspelt, or because another tool calls it so. It \
                  would be ignored silently otherwise. Correct it; keys that start with `x-`, at the top of the file, are yours \
                  to use.",
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
    title: "value that the key cannot have",
    explanation: "The value has another form than the key needs: a time without its unit, a word that the key does not know, a \
                  number out of range. The message says what the key takes.",
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
    explanation: "Something else than a mapping stands where the file needs one, for example a command in the place of the entry \
                  of a component.",
    example: " components:
-  sensor: ./sensor
+  sensor: {command: ./sensor}
",
    ..RULE
};

pub(super) const MISSING: Rule = Rule {
    code: "SCL1204",
    title: "missing key in a launch file",
    explanation: "A launch file names its components, and says of each what runs it; with `hosts` it says where each can be \
                  reached.",
    example: " components:
   sensor:
+    command: ./sensor
     restart: always
",
    ..RULE
};

pub(super) const UNKNOWN_NAME: Rule = Rule {
    code: "SCL1205",
    title: "component or gate that the topology does not have",
    explanation: "A launch file that belongs to a topology starts its components and no others, and names its gates. The message \
                  lists those that there are.",
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
    explanation: "Two keys say different things about one component, or a key has no effect without another. Remove one, or put \
                  one of them into a profile.",
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
    title: "text that cannot be such a name",
    explanation: "Names of hosts stand in certificates and names of folders, names of gates and variables in the environment of \
                  programs, so not every text can be one.",
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
    explanation: "Each component runs on exactly one host, each host has an address of its own, and what is not on loopback is \
                  encrypted.",
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
    explanation: "The topology of the launch file has errors, so it is not known which components and gates there are. Correct \
                  the topology first; `scl run` starts nothing before.",
    ..RULE
};

/// All of them, by their codes.
pub const LAUNCH_RULES: [&Rule; 9] = [
    &UNKNOWN_KEY,
    &WRONG_VALUE,
    &WRONG_SHAPE,
    &MISSING,
    &UNKNOWN_NAME,
    &CONTRADICTION,
    &WRONG_NAME,
    &HOSTS,
    &UNCHECKED,
];
