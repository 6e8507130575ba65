//! Rules that are checked elsewhere: by the loader that reads the files, by the macro, by `scl generate`, and by rustc.
//! They are declared here, so that every code is explained in one place.

use crate::diagnostic::{Rule, Severity};

/// All of them, by their codes.
pub(crate) const RULES: &[&Rule] = &[
    &FILE_NOT_FOUND,
    &UNREADABLE_FILE,
    &NOT_UTF8,
    &FILE_TOO_LARGE,
    &BAD_ARGUMENTS,
    &PATH_OF_ONE_MACHINE,
    &GENERATED_TWICE,
    &SCHEMA,
    &SCHEMA_ELSEWHERE,
    &SCHEMA_TWICE,
    &SCHEMA_NAME,
    &HIDDEN_CRATE,
    &DIFFERENT_RUST_TYPES,
    &NOT_A_MESSAGE,
    &TYPE_NOT_FOUND,
    &WRONG_DIRECTION,
    &WRONG_TYPE_IN_CODE,
    &UNKNOWN_IN_CODE,
    &MESSAGE_CLASH,
    &NAME_CLASH,
    &UNWRITABLE_NAME,
];

/// SCL0001.
pub const FILE_NOT_FOUND: Rule = Rule {
    code: "SCL0001",
    severity: Severity::Error,
    title: "topology file not found",
    explanation: "The file in the macro call does not exist. The macro looks for it beside the source file that \
                  contains the call, then in the package's folder, then in the workspace's. Correct the path; the \
                  message lists each place that was tried and files with similar names.",
    example: "-scl::topology!(\"topolgy.yaml\");
+scl::topology!(\"topology.yaml\");
",
};

/// SCL0002.
pub const UNREADABLE_FILE: Rule = Rule {
    code: "SCL0002",
    severity: Severity::Error,
    title: "path is a directory or cannot be read",
    explanation: "The path exists, but it is a folder, a broken link, or a file that this user may not read. Name a \
                  readable file; the message ends with the operating system's error.",
    example: "-scl::topology!(\"config/\");
+scl::topology!(\"config/topology.yaml\");
",
};

/// SCL0003.
pub const NOT_UTF8: Rule = Rule {
    code: "SCL0003",
    severity: Severity::Error,
    title: "file is not UTF-8",
    explanation: "A topology file is UTF-8, so that every tool in every language reads the same names. Save it as \
                  UTF-8. A file that starts with 0xFF 0xFE is UTF-16, which some editors on Windows write.",
    example: "",
};

/// SCL0004.
pub const FILE_TOO_LARGE: Rule = Rule {
    code: "SCL0004",
    severity: Severity::Error,
    title: "file too large",
    explanation: "The file is larger than a topology usually is, so it is probably the wrong file. The limit protects \
                  the compiler, in which the macro runs. A topology of 1000 components has about 200 KiB; for larger, \
                  generated ones, raise the limit with `max_size`.",
    example: "",
};

/// SCL0005.
pub const BAD_ARGUMENTS: Rule = Rule {
    code: "SCL0005",
    severity: Severity::Error,
    title: "macro argument is not one string literal",
    explanation: "The macro reads its file before the program exists, so the path has to be one plain string in the \
                  call. `concat!` and `env!` are not expanded before a macro sees them. Write \
                  `scl::topology!(\"topology.yaml\")`.",
    example: "-scl::topology!(topology.yaml);
+scl::topology!(\"topology.yaml\");
",
};

/// SCL0006.
pub const PATH_OF_ONE_MACHINE: Rule = Rule {
    code: "SCL0006",
    severity: Severity::Warning,
    title: "path works on this machine only",
    explanation: "An absolute path, or one that leaves the package, exists on this machine only: the crate will not \
                  build elsewhere, and `cargo package` does not include the file. Write the path relative to the \
                  source file or to Cargo.toml.",
    example: "-scl::topology!(\"/home/u/uav/topology.yaml\");
+scl::topology!(\"topology.yaml\");
",
};

/// SCL0007.
pub const GENERATED_TWICE: Rule = Rule {
    code: "SCL0007",
    severity: Severity::Error,
    title: "the same names are generated twice",
    explanation: "Two calls of the macro in one module generate the same names. The macro cannot see the other call, \
                  so rustc reports E0428. Move one of the calls into a separate module.",
    example: " scl::topology!(\"a.yaml\");
-scl::topology!(\"b.yaml\");
+mod ground_station {
+    scl::topology!(\"b.yaml\");
+}
",
};

/// SCL0406.
pub const SCHEMA: Rule = Rule {
    code: "SCL0406",
    severity: Severity::Error,
    title: "schema file cannot be read or compiled",
    explanation: "A file in `schemas` does not exist, cannot be read, or contains a mistake. Its path starts at the \
                  folder of the topology file. Its imports are searched for in that folder and beside each of the \
                  schemas, or, with `schema_roots`, only in the folders listed there. An import that could mean two \
                  different files is an error. A mistake in a schema is shown in that schema.",
    example: "-schemas: [uav.prot]
+schemas: [uav.proto]
 components:
   - name: sensor
     gates:
       - measurements: {pub: uav.Measurement}
",
};

/// SCL0415.
pub const SCHEMA_ELSEWHERE: Rule = Rule {
    code: "SCL0415",
    severity: Severity::Warning,
    title: "schema path works on this machine only",
    explanation: "An absolute path of a schema, or one that leaves the folder of the topology file, exists on this \
                  machine only: the file will not be found elsewhere, and `cargo package` does not include it. Keep \
                  the schemas beside the topology file or below it.",
    example: "",
};

/// SCL0416.
pub const SCHEMA_TWICE: Rule = Rule {
    code: "SCL0416",
    severity: Severity::Error,
    title: "schema named twice",
    explanation: "Two entries of `schemas` lead to the same file, perhaps in two spellings such as `rover.proto` and \
                  `./rover.proto`. Each message would be declared twice. Remove one of them.",
    example: "",
};

/// SCL0417.
pub const SCHEMA_NAME: Rule = Rule {
    code: "SCL0417",
    severity: Severity::Error,
    title: "schema declaration without a unique Rust name",
    explanation: "Rust names follow other rules than protobuf names, so two declarations of the schemas can become the \
                  same name: the messages `GPSFix` and `GpsFix` both become `GpsFix`, and the enum values `MODE_AUTO` \
                  and `AUTO` of `Mode` both become `Mode::Auto`. Declarations inside a message, including oneofs, go \
                  into a module: in package `rover`, those of message `Status` go into `rover::status`, like those of \
                  a package `rover.status`. A message without a package can collide with a component. A name that \
                  consists only of underscores leaves no Rust name. Rename one; the protobuf bytes of messages contain \
                  no names. docs/messages.md has the rules.",
    example: "",
};

/// SCL0418.
pub const HIDDEN_CRATE: Rule = Rule {
    code: "SCL0418",
    severity: Severity::Warning,
    title: "package of a schema hides a crate",
    explanation: "The first part of a package becomes a Rust module where the macro is called. If the program uses a \
                  crate with this name, such as `log` or `std`, code in the module that calls the macro gets the \
                  package instead, or the name is ambiguous. Call the macro in a separate module that contains nothing \
                  else, such as `mod wiring { ::scl::topology!(\"..\"); }`, and allow this warning. `scl check` knows \
                  the crates `std`, `core`, `alloc` and `scl`; the macro knows all dependencies of the program.",
    example: "",
};

/// SCL0605.
pub const DIFFERENT_RUST_TYPES: Rule = Rule {
    code: "SCL0605",
    severity: Severity::Error,
    title: "same name, different Rust types",
    explanation: "The two ends name types that may be the same, such as `nav.Attitude` and `log.Attitude`, but are \
                  different Rust types. Only rustc can tell: the macro generates an assertion for each such \
                  connection, and the error shows the connection.",
    example: "",
};

/// SCL0606.
pub const NOT_A_MESSAGE: Rule = Rule {
    code: "SCL0606",
    severity: Severity::Error,
    title: "type is not a message",
    explanation: "A type that the file names exists in Rust, but the gate's codec cannot carry it: `protobuf` needs a \
                  prost message, `raw` a type with zerocopy's traits, and the other built-in codecs a serde type. \
                  rustc reports it at an assertion that names the gate.",
    example: "",
};

/// SCL0609.
pub const TYPE_NOT_FOUND: Rule = Rule {
    code: "SCL0609",
    severity: Severity::Error,
    title: "Rust type not found",
    explanation: "A type or codec that the file names as a Rust path, such as `camera.Image`, cannot be found where \
                  the macro is called. Only programs that open the component need it, so rustc reports it only there. \
                  Add the crate to the program's dependencies, bring the module into scope with `use`, or correct the \
                  path.",
    example: "",
};

/// SCL1001.
pub const WRONG_DIRECTION: Rule = Rule {
    code: "SCL1001",
    severity: Severity::Error,
    title: "wrong direction",
    explanation: "A gate can only do what its kind does: a `sub` gate has no `send`. Direction is part of the gate's \
                  Rust type, so rustc reports this. The documentation of the field names the kind and the place in the \
                  file.",
    example: "-controller.sensor.send(&measurement).await?;
+let measurement = controller.sensor.recv().await?;
",
};

/// SCL1002.
pub const WRONG_TYPE_IN_CODE: Rule = Rule {
    code: "SCL1002",
    severity: Severity::Error,
    title: "wrong message type in code",
    explanation: "A program sends or expects a different type than the file declares for the gate. rustc reports it as \
                  E0308; the documentation of the field says where the type is declared.",
    example: "-sensor.measurements.send(&status).await?;
+sensor.measurements.send(&measurement).await?;
",
};

/// SCL1003.
pub const UNKNOWN_IN_CODE: Rule = Rule {
    code: "SCL1003",
    severity: Severity::Error,
    title: "gate or component does not exist in code",
    explanation: "A program names a gate or component that the file does not declare. Gates are fields of a struct, so \
                  rustc reports E0609 and suggests similar names. Correct the program, or declare the gate.",
    example: "-sensor.measurement.send(&measurement).await?;
+sensor.measurements.send(&measurement).await?;
",
};

/// SCL1101.
pub const MESSAGE_CLASH: Rule = Rule {
    code: "SCL1101",
    severity: Severity::Error,
    title: "component and message get the same name in another language",
    explanation: "In generated code of some languages, components and messages share the namespace of the system: the \
                  component `sensor` and the message `rover.Sensor` would both become `rover::Sensor` in C++. Only \
                  `scl generate` and `scl check --for` report it; Rust keeps the two apart. Rename one of them.",
    example: "",
};

/// SCL1102.
pub const NAME_CLASH: Rule = Rule {
    code: "SCL1102",
    severity: Severity::Error,
    title: "two names become the same in another language",
    explanation: "Different names of the topology become the same name in generated code: C joins the names of system, \
                  component and gate with `_`, so gate `b_c` of component `a` and gate `c` of component `a_b` become \
                  the same functions. Only `scl generate` and `scl check --for` report it. Rename one of them.",
    example: "",
};

/// SCL1103.
pub const UNWRITABLE_NAME: Rule = Rule {
    code: "SCL1103",
    severity: Severity::Error,
    title: "C++ name of a message is unknown or unusable",
    explanation: "A gate carries a message whose C++ name SCL cannot determine or use. protoc does not escape keywords \
                  in packages, so `package export;` gives a header that no compiler accepts. Keywords that are new in \
                  C++20, such as `concept`, get an underscore only from newer versions of protoc. Only `scl generate` \
                  and `scl check --for` report it. Rename the package or the message.",
    example: "",
};
