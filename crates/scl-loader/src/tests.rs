//! Whole files, loaded from disk.

use crate::testing::{folder, load_from};
use crate::{Loaded, LookedIn, Request, load, load_bytes};
use expect_test::{Expect, expect};
use scl_topology::diagnostic::{Severity, render};
use std::fs;
use std::process::Command;

const GOOD: &str = "\
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

fn rendered(loaded: &Loaded) -> String {
    let told = loaded.diagnostics.iter().filter(|problem| problem.severity != Severity::Lint);
    told.map(|problem| render(problem, &loaded.sources) + "\n").collect()
}

fn errors(loaded: &Loaded) -> Vec<&'static str> {
    let errors = loaded.diagnostics.iter().filter(|problem| problem.severity == Severity::Error);
    errors.map(|problem| problem.code()).collect()
}

/// What loading `name` from a folder with these files says, with the folder's own path left out.
#[track_caller]
fn says(files: &[(&str, &str)], name: &str, expected: Expect) {
    let folder = folder(files);
    let loaded = load_from(&folder, name);
    expected.assert_eq(&rendered(&loaded).replace(&folder.path().display().to_string(), "<folder>"));
}

#[test]
fn a_good_file_gives_a_topology() {
    let folder = folder(&[("rover.yaml", GOOD)]);
    let loaded = load_from(&folder, "rover.yaml");
    assert_eq!(rendered(&loaded), "");
    assert_eq!(loaded.topology.unwrap().system(), "rover");
    assert_eq!(loaded.files_read, [folder.path().join("rover.yaml")]);
}

#[test]
fn bytes_from_elsewhere_are_checked_like_a_file() {
    let folder = folder(&[]);
    let request =
        Request { max_size: 1000, shown_as: "<stdin>".into(), ..Request::new(folder.path().join("rover.yaml")) };
    let loaded = load_bytes(&request, GOOD.into());
    assert_eq!((rendered(&loaded).as_str(), loaded.files_read.len()), ("", 0));
    assert_eq!(loaded.topology.unwrap().system(), "rover");
    for (bytes, code) in [(vec![b' '; 1001], "SCL0004"), (vec![0xff], "SCL0003"), (vec![], "SCL0115")] {
        assert_eq!(errors(&load_bytes(&request, bytes)), [code]);
    }
}

#[test]
fn a_broken_file_leaves_its_model() {
    let folder = folder(&[("rover.yaml", &GOOD.replace("controller.sensor]", "controller.nothing]"))]);
    let loaded = load_from(&folder, "rover.yaml");
    assert_eq!(errors(&loaded), ["SCL0502"]);
    assert!(loaded.topology.is_none());
    assert_eq!(loaded.model.components.len(), 2);
}

#[test]
fn an_empty_file_is_an_error() {
    let folder = folder(&[("t.yaml", "")]);
    assert_eq!(errors(&load_from(&folder, "t.yaml")), ["SCL0115"]);
}

#[test]
fn a_missing_file_names_its_neighbour_and_the_places() {
    let folder = folder(&[("topology.yml", GOOD)]);
    let looked_in = ["topology.yaml", "uav/topology.yaml"].map(|name| LookedIn {
        path: folder.path().join(name),
        shown_as: name.into(),
        what: "place".into(),
    });
    let shown_as = "topology.yaml".to_owned();
    let request =
        Request { shown_as, looked_in: looked_in.into(), ..Request::new(folder.path().join("topology.yaml")) };
    let text = rendered(&load(&request)).replace(&folder.path().display().to_string(), "<folder>");
    expect![[r#"
        error: [SCL0001] cannot find the topology file `topology.yaml`
         |
         = help: a file with a similar name exists: `topology.yml`
         = note: looked in:
                 `topology.yaml` (place)
                 `uav/topology.yaml` (place)
    "#]]
    .assert_eq(&text);
}

#[test]
fn a_folder_is_no_file() {
    says(
        &[("config/topology.yaml", GOOD)],
        "config",
        expect![[r#"
        error: [SCL0002] the topology path `config` is a directory, not a file
         |
         = help: did you mean `config/topology.yaml`?
    "#]],
    );
}

#[test]
fn bytes_that_are_no_text_are_named() {
    let folder = folder(&[]);
    fs::write(folder.path().join("t.yaml"), b"\xff\xfec\0").unwrap();
    expect![[r#"
        error: [SCL0003] the topology file `t.yaml` is not valid UTF-8
         --> t.yaml:1:1
          |
        1 | ��c␀
          | ^ invalid byte 0xFF
          |
          = help: save the file as UTF-8 (without or with a BOM)
          = note: the first invalid byte is byte 0 of the file, counted from 0
          = note: 0xFF 0xFE is the mark of UTF-16; Windows Notepad writes it as "Unicode"
    "#]]
    .assert_eq(&rendered(&load_from(&folder, "t.yaml")));
}

#[test]
fn the_first_bad_byte_is_shown() {
    let folder = folder(&[]);
    let latin_1 = [b"\xef\xbb\xbf# \xc3\xa9\nsystem: caf".as_slice(), b"\xe9\n", GOOD.as_bytes()].concat();
    fs::write(folder.path().join("t.yaml"), latin_1).unwrap();
    expect![[r#"
        error: [SCL0003] the topology file `t.yaml` is not valid UTF-8
         --> t.yaml:2:12
          |
        2 | system: caf�
          |            ^ invalid byte 0xE9
          |
          = help: save the file as UTF-8 (without or with a BOM)
          = note: the first invalid byte is byte 19 of the file, counted from 0
    "#]]
    .assert_eq(&rendered(&load_from(&folder, "t.yaml")));
}

#[test]
fn a_large_file_is_not_read() {
    let folder = folder(&[("t.yaml", GOOD)]);
    let request = Request { max_size: 100, shown_as: "t.yaml".into(), ..Request::new(folder.path().join("t.yaml")) };
    expect![[r#"
        error: [SCL0004] the topology file `t.yaml` is 176 bytes; the limit is 100 bytes
         |
         = help: is this the right file? a topology of 1000 components is about 200 KiB
         = note: the limit protects the compiler process, in which this macro runs; raise it with `scl::topology!("t.yaml", max_size = "8MiB")` and `scl check --max-size 8MiB`
    "#]].assert_eq(&rendered(&load(&request)));
}

#[test]
#[cfg(unix)]
fn what_is_no_regular_file_is_never_opened() {
    let folder = folder(&[]);
    let path = |name: &str| folder.path().join(name);
    assert!(Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
    std::os::unix::fs::symlink(path("round"), path("round")).unwrap();
    std::os::unix::fs::symlink(path("nowhere"), path("dangling")).unwrap();
    let cases = [
        (path("pipe"), "is a named pipe, not a file"),
        ("/dev/zero".into(), "is a device, not a file"),
        (path("round"), "is a symbolic link that leads to no file"),
        (path("dangling"), "is a symbolic link that leads to no file"),
    ];
    for (path, words) in cases {
        let loaded = load(&Request::new(&path));
        assert_eq!(loaded.diagnostics.len(), 1, "{path:?}");
        assert_eq!(loaded.diagnostics[0].code(), "SCL0002", "{path:?}");
        assert!(loaded.diagnostics[0].message.ends_with(words), "{}", loaded.diagnostics[0].message);
        assert!(loaded.files_read.is_empty(), "{path:?}");
    }
}

#[cfg(not(feature = "protobuf"))]
#[test]
fn schemas_need_their_feature() {
    says(
        &[("t.yaml", &format!("schemas: [rover.proto]\n{GOOD}"))],
        "t.yaml",
        expect![[r#"
            error: [SCL0406] the schema file `rover.proto` needs the feature `protobuf`
             --> t.yaml:1:11
              |
            1 | schemas: [rover.proto]
              |           ^^^^^^^^^^^ this build of SCL compiles no schemas
              |
              = help: switch it on in Cargo.toml: scl = { package = "scl-gates", version = "..", features = ["protobuf"] }
              = note: without `schemas`, types are looked up in your Rust code
        "#]],
    );
}

#[cfg(feature = "protobuf")]
mod schemas {
    use super::*;
    use prost::Message;
    use prost_types::FileDescriptorSet;
    use std::collections::BTreeSet;

    const PROTO: &str = "syntax = \"proto3\";\npackage rover;\nmessage Measurement { double data = 1; }\n";

    fn typed(schemas: &str, message: &str) -> String {
        format!(
            "schemas: {schemas}\n{}",
            GOOD.replace("measurements: pub", &format!("measurements: {{pub: {message}}}"))
        )
    }

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
                  = help: a file with a similar name exists: `rover.proto`
                  = note: schemas are looked for beside the topology file
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
                error: [SCL0406] the schema file `rover.proto` does not compile: import `nowhere.proto` not found
                 --> rover.proto:4:1
                  |
                4 | import "nowhere.proto";
                  | ^^^^^^^^^^^^^^^^^^^^^^^ imported here
                  |
                 ::: t.yaml:1:11
                  |
                1 | schemas: [rover.proto]
                  |           ----------- compiled because of this line
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
    fn embedded(message: &str, base: &str) -> crate::Descriptors {
        let a = "syntax = \"proto3\";\npackage a;\nimport \"base.proto\";\nimport \"google/protobuf/timestamp.proto\";\n\
                 // A comment.\nmessage Outer { message Inner { base.Pose pose = 1; } google.protobuf.Timestamp at = 1; }\n";
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
            let set = FileDescriptorSet::decode(embedded(message, BASE).bytes.as_slice()).unwrap();
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
        assert!(
            same.hash.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit()),
            "{}",
            same.hash
        );
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
            error: [SCL0406] the schema file `proto/rover.proto` does not compile: `base.proto` and `proto/base.proto` are the same file; use one of the two names everywhere
             --> t.yaml:1:29
              |
            1 | schemas: [proto/base.proto, proto/rover.proto]
              |                             ^^^^^^^^^^^^^^^^^ named here
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
}
