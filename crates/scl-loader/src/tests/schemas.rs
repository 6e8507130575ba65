//! Topologies with schemas.

use super::*;
use prost::Message;
use prost_types::FileDescriptorSet;
use std::collections::BTreeSet;

#[test]
fn messages_of_several_files_and_folders_are_known() {
    let base = "syntax = \"proto3\";\npackage base;\nmessage Pose { message Axis { double x = 1; } }\n";
    let rover = "syntax = \"proto3\";\npackage rover;\nimport \"base.proto\";\nimport \"google/protobuf/timestamp.proto\";\n\
                 message Measurement { base.Pose pose = 1; google.protobuf.Timestamp at = 2; }\n";
    let yaml = typed("[proto/rover.proto]", "base.Pose.Axis");
    let folder = folder(&[("t.yaml", &yaml), ("proto/rover.proto", rover), ("proto/base.proto", base)]);
    let loaded = load_from(&folder, "t.yaml");
    assert_eq!(rendered(&loaded), "");
    assert!(loaded.schemas.is_some());
    let names: Vec<String> =
        loaded.files_read.iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(names, ["t.yaml", "rover.proto", "base.proto"]);
}

#[test]
fn an_unknown_message_is_an_error() {
    let folder = folder(&[("t.yaml", &typed("[rover.proto]", "rover.Mesurement")), ("rover.proto", PROTO)]);
    assert_eq!(errors(&load_from(&folder, "t.yaml")), ["SCL0405"]);
}

#[test]
fn a_missing_schema_names_its_neighbour() {
    says(
        &[("t.yaml", &typed("[rover.prot]", "rover.Measurement")), ("rover.proto", PROTO)],
        "t.yaml",
        expect![[r#"
            error: [SCL0406] cannot find the schema file `rover.prot`
             --> t.yaml:1:11
              |
            1 | schemas: [rover.prot]
              |           ^^^^^^^^^^
              |
              = help: did you mean `rover.proto`?
              = note: `schemas` names the `.proto` files that declare the messages
        "#]],
    );
}

#[test]
fn a_wrong_schema_is_shown_at_its_own_line() {
    let wrong = PROTO.replace("double data", "double");
    says(
        &[("t.yaml", &typed("[rover.proto]", "rover.Measurement")), ("rover.proto", &wrong)],
        "t.yaml",
        expect![[r#"
            error: [SCL0406] the schema file `rover.proto` does not compile: expected an identifier, but found `=`
             --> rover.proto:3:30
              |
            3 | message Measurement { double = 1; }
              |                              ^ found here
              |
             ::: t.yaml:1:11
              |
            1 | schemas: [rover.proto]
              |           ----------- compiled because of this line
        "#]],
    );
}

#[test]
fn a_missing_import_is_shown_where_it_is_written() {
    let wrong = format!("{PROTO}import \"nowhere.proto\";\n");
    says(
        &[("t.yaml", &typed("[rover.proto]", "rover.Measurement")), ("rover.proto", &wrong)],
        "t.yaml",
        expect![[r#"
            error: [SCL0406] cannot find `nowhere.proto`, which `rover.proto` imports
             --> rover.proto:4:1
              |
            4 | import "nowhere.proto";
              | ^^^^^^^^^^^^^^^^^^^^^^^ imported here
              |
             ::: t.yaml:1:11
              |
            1 | schemas: [rover.proto]
              |           ----------- compiled because of this line
              |
              = note: imports are looked for beside the topology file and beside each of its `schemas`
        "#]],
    );
}

#[test]
fn each_wrong_schema_is_reported() {
    let files = [
        ("t.yaml", typed("[a.proto, b.proto, c.proto]", "rover.Measurement")),
        ("a.proto", "message {".into()),
        ("b.proto", "package".into()),
    ];
    let folder = folder(&files.each_ref().map(|(name, text)| (*name, text.as_str())));
    assert_eq!(errors(&load_from(&folder, "t.yaml")), ["SCL0406"; 3]);
}

/// What a program embeds for a gate that carries `message`, from the schemas `a.proto` and `other.proto`.
fn embedded(message: &str, base: &str) -> scl_plan::Schema {
    let a = r#"syntax = "proto3";
package a;
import "base.proto";
import "google/protobuf/timestamp.proto";
/* A comment. */
message Outer { message Inner { base.Pose pose = 1; } google.protobuf.Timestamp at = 1; }
"#;
    let other = "syntax = \"proto3\";\nmessage Other { double x = 1; }\n";
    let yaml = typed("[other.proto, a.proto]", message);
    let folder = folder(&[("t.yaml", &yaml), ("a.proto", a), ("base.proto", base), ("other.proto", other)]);
    let loaded = load_from(&folder, "t.yaml");
    assert_eq!(rendered(&loaded), "");
    loaded.schemas.unwrap().descriptors_of(&[message].into()).unwrap()
}

const BASE: &str = "syntax = \"proto3\";\npackage base;\nmessage Pose { double x = 1; }\n";

#[test]
fn a_program_embeds_the_files_of_its_messages_and_their_imports() {
    let names = |message: &str| {
        let set = FileDescriptorSet::decode(embedded(message, BASE).descriptors.as_ref()).unwrap();
        assert!(set.file.iter().all(|file| file.source_code_info.is_none()));
        set.file.into_iter().map(|file| file.name.unwrap()).collect::<Vec<_>>()
    };
    let with_imports = ["base.proto", "google/protobuf/timestamp.proto", "a.proto"];
    assert_eq!(names("a.Outer"), with_imports);
    assert_eq!(names("a.Outer.Inner"), with_imports);
    assert_eq!(names("base.Pose"), ["base.proto"]);
    assert_eq!(names("Other"), ["other.proto"]);
}

#[test]
fn embedded_descriptors_change_with_what_they_describe_only() {
    let same = embedded("a.Outer", BASE);
    assert_eq!(embedded("a.Outer", BASE), same);
    assert_eq!(embedded("a.Outer", &BASE.replace("double", "// In metres.\n double")), same);
    assert_eq!(embedded("a.Outer.Inner", BASE).hash, same.hash);
    assert_ne!(embedded("a.Outer", &BASE.replace("double x", "float x")).hash, same.hash);
    assert_ne!(embedded("a.Outer", &BASE.replace("x = 1", "y = 1")).hash, same.hash);
    assert!(same.hash.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit()), "{}", same.hash);
}

#[test]
fn no_message_needs_no_descriptors() {
    let folder = folder(&[("t.yaml", &typed("[rover.proto]", "rover.Measurement")), ("rover.proto", PROTO)]);
    let schemas = load_from(&folder, "t.yaml").schemas.unwrap();
    assert_eq!(schemas.descriptors_of(&BTreeSet::new()), None);
    assert_eq!(schemas.descriptors_of(&["rover.Unknown"].into()), None);
}

#[test]
fn a_schema_named_twice_is_told() {
    let yaml = typed("[rover.proto, ./rover.proto, rover.proto]", "rover.Measurement");
    says(
        &[("t.yaml", &yaml), ("rover.proto", PROTO)],
        "t.yaml",
        expect![[r#"
        error: [SCL0416] the schemas `rover.proto` and `./rover.proto` are the same file
         --> t.yaml:1:24
          |
        1 | schemas: [rover.proto, ./rover.proto, rover.proto]
          |           -----------  ^^^^^^^^^^^^^ second time
          |           |
          |           first time
          |
          = help: remove one of them
        error: [SCL0416] the schema `rover.proto` is named twice
         --> t.yaml:1:39
          |
        1 | schemas: [rover.proto, ./rover.proto, rover.proto]
          |           ----------- first time      ^^^^^^^^^^^ second time
          |
          = help: remove one of them
    "#]],
    );
}

#[test]
fn a_schema_outside_of_the_folder_is_told() {
    let yaml = typed("[../rover.proto]", "rover.Measurement");
    says(
        &[("below/t.yaml", &yaml), ("rover.proto", PROTO)],
        "below/t.yaml",
        expect![[r#"
        warning: [SCL0415] the schema path leaves the folder of the topology file; it will not be found if only that folder is copied
         --> below/t.yaml:1:11
          |
        1 | schemas: [../rover.proto]
          |           ^^^^^^^^^^^^^^
          |
          = help: keep the schema beside the topology file, or in a folder below it
    "#]],
    );
    let folder = folder(&[("rover.proto", PROTO)]);
    let absolute = folder.path().join("rover.proto").display().to_string();
    let file = super::folder(&[("t.yaml", &typed(&format!("[{absolute}]"), "rover.Measurement"))]);
    let loaded = load_from(&file, "t.yaml");
    assert!(rendered(&loaded).contains("warning: [SCL0415] the schema path is absolute"), "{}", rendered(&loaded));
    assert!(loaded.topology.is_some());
}

#[test]
fn a_schema_that_is_imported_under_another_name_is_told() {
    let base = "syntax = \"proto3\";\npackage rover;\nmessage Base {}\n";
    let rover = format!("{PROTO}import \"base.proto\";\n");
    let yaml = typed("[proto/base.proto, proto/rover.proto]", "rover.Measurement");
    says(
        &[("t.yaml", &yaml), ("proto/base.proto", base), ("proto/rover.proto", &rover)],
        "t.yaml",
        expect![[r#"
            error: [SCL0406] `base.proto`, which `proto/rover.proto` imports, is the schema `proto/base.proto` under another name
             --> proto/rover.proto:4:1
              |
            4 | import "base.proto";
              | ^^^^^^^^^^^^^^^^^^^^ imported here
              |
             ::: t.yaml:1:29
              |
            1 | schemas: [proto/base.proto, proto/rover.proto]
              |                             ----------------- compiled because of this line
              |
              = help: name the folder in which imports begin: `schema_roots: [proto]`
              = note: protobuf knows a file by its name: its messages would be declared twice
        "#]],
    );
}

/// What is said about one broken schema, without its excerpt.
fn headline(files: &[(&str, &[u8])]) -> String {
    let folder = folder(&[("t.yaml", &typed("[rover.proto]", "rover.Measurement"))]);
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let loaded = load_from(&folder, "t.yaml");
    assert_eq!(loaded.topology.is_none(), !errors(&loaded).is_empty());
    let found = loaded.diagnostics.iter().filter(|problem| problem.severity == Severity::Error);
    let told: Vec<String> = found.map(|problem| format!("{} {}", problem.code(), problem.message)).collect();
    told.join("; ").replace(&folder.path().display().to_string(), "<folder>")
}

#[test]
fn bad_schemas_are_errors_and_never_more() {
    let head = "syntax = \"proto3\";\npackage rover;\n";
    let huge = vec![b'\n'; 2 << 20];
    let nested = |inner: &str, depth: usize, close: &str| {
        format!("{head}{}{}", inner.repeat(depth), close.repeat(depth)).into_bytes()
    };
    let cycle = format!("{head}import \"rover.proto\";\n");
    let round = format!("{head}import \"other.proto\";\nmessage Measurement {{}}\n");
    let long_name = format!("{head}message {} {{}}\n", "A".repeat(900_000));
    let many_fields: String = (1..40_000).map(|at| format!("int32 a{at}={at};")).collect();
    let one_number: String = (1..1_500).map(|at| format!("int32 a{at}=1;")).collect();
    let cases: [(&str, Vec<u8>); 16] = [
        ("empty", Vec::new()),
        ("a package without messages", head.as_bytes().to_vec()),
        ("huge", huge),
        ("not UTF-8", b"syntax = \"proto3\";\xff".to_vec()),
        ("zero bytes", vec![0; 10_000]),
        ("deep messages", nested("message A {", 80_000, "}")),
        ("deep messages that are never closed", nested("message A {", 90_000, "")),
        ("deep options", [format!("{head}option a = {{").into_bytes(), nested("a {", 50_000, "}")].concat()),
        ("deep groups", nested("message A { oneof b {", 40_000, "}}")),
        ("itself", cycle.into_bytes()),
        ("round", round.into_bytes()),
        ("long name", long_name.into_bytes()),
        ("one number many times", format!("{head}message Measurement {{ {one_number} }}").into_bytes()),
        ("many fields", format!("{head}message Measurement {{ {many_fields} }}").into_bytes()),
        ("a comment without end", format!("{head}/* {}", "*".repeat(900_000)).into_bytes()),
        ("a string without end", format!("{head}import \"{}", "a".repeat(900_000)).into_bytes()),
    ];
    let told: String = cases
        .iter()
        .map(|(case, bytes)| {
            let back = format!("{head}import \"rover.proto\";\n");
            let told = headline(&[("rover.proto", bytes), ("other.proto", back.as_bytes())]);
            let shown: String = told.chars().take(150).collect();
            format!("{case}: {shown}\n")
        })
        .collect();
    expect![[r#"
        empty: 
        a package without messages: SCL0405 unknown message type `rover.Measurement`
        huge: SCL0406 the schema file `rover.proto` has 2097152 bytes, more than the limit
        not UTF-8: SCL0406 the schema file `rover.proto` is not valid UTF-8 (line 1, column 19)
        zero bytes: SCL0406 the schema file `rover.proto` does not compile: invalid token
        deep messages: SCL0406 the schema file `rover.proto` does not compile: it has more than 20000 declarations
        deep messages that are never closed: SCL0406 the schema file `rover.proto` does not compile: it has more than 20000 declarations
        deep options: SCL0406 the schema file `rover.proto` does not compile: it has more than 20000 declarations
        deep groups: SCL0406 the schema file `rover.proto` does not compile: it has more than 20000 declarations
        itself: SCL0406 the schema file `rover.proto` does not compile: import cycle detected: rover.proto -> rover.proto
        round: SCL0406 the schema file `rover.proto` does not compile: import cycle detected: rover.proto -> other.proto -> rover.proto
        long name: SCL0405 unknown message type `rover.Measurement`
        one number many times: SCL0406 the schema file `rover.proto` does not compile: field number `1` is already used
        many fields: SCL0406 the schema file `rover.proto` does not compile: one message or enum of it has more than 2500 declarations
        a comment without end: SCL0406 the schema file `rover.proto` does not compile: expected comment terminator, but reached end of file
        a string without end: SCL0406 the schema file `rover.proto` does not compile: expected string terminator, but reached end of file
    "#]].assert_eq(&told);
}

#[test]
fn editions_and_their_features_are_refused() {
    let edition = PROTO.replace("syntax = \"proto3\"", "edition = \"2023\"");
    says(
        &[("t.yaml", &typed("[rover.proto]", "rover.Measurement")), ("rover.proto", &edition)],
        "t.yaml",
        expect![[r#"
            error: [SCL0406] `rover.proto` uses an edition of protobuf, which SCL does not read yet
             --> rover.proto:1:1
              |
            1 | edition = "2023";
              | ^^^^^^^^^^^^^^^^ only `proto2` and `proto3` are read
              |
             ::: t.yaml:1:11
              |
            1 | schemas: [rover.proto]
              |           ----------- compiled because of this line
              |
              = help: write `syntax = "proto3";`, and `optional` before each field that has presence
              = note: the bytes of messages stay the same unless the file sets features
        "#]],
    );
    let feature = PROTO.replace("data = 1", "data = 1 [features.field_presence = EXPLICIT]");
    says(
        &[("t.yaml", &typed("[rover.proto]", "rover.Measurement")), ("rover.proto", &feature)],
        "t.yaml",
        expect![[r#"
        error: [SCL0406] `rover.proto` sets a feature, which has no effect without an edition
         --> rover.proto:3:40
          |
        3 | message Measurement { double data = 1 [features.field_presence = EXPLICIT]; }
          |                                        ^^^^^^^^^^^^^^^^^^^^^^^ a feature of an edition of protobuf
          |
         ::: t.yaml:1:11
          |
        1 | schemas: [rover.proto]
          |           ----------- compiled because of this line
          |
          = help: remove it, and write `optional` before each field that has presence
          = note: SCL reads `proto2` and `proto3`, and no editions yet
    "#]],
    );
    for text in [
        PROTO.replace("message", "option features.enum_type = CLOSED;\nmessage"),
        PROTO
            .replace("proto3", "proto2")
            .replace("double", "optional double")
            .replace(" }", " option features = {}; }"),
        format!("// edition = \"2023\";\n{}", edition.replace("2023", "2024")),
        edition.replace("package", "import \"nowhere.proto\";\npackage"),
    ] {
        let told = headline(&[("rover.proto", text.as_bytes())]);
        assert!(
            told.contains("`rover.proto` uses an edition") || told.contains("`rover.proto` sets a feature"),
            "{told}"
        );
    }
}
