//! Whole files, loaded from disk.

use crate::testing::{folder, load_from};
use crate::{Loaded, LookedIn, Request, load, load_bytes};
use expect_test::{Expect, expect};
use scl_topology::diagnostic::{Severity, render};
use std::fs;
use std::process::Command;

mod groups;
#[cfg(feature = "protobuf")]
mod imports;
mod includes;
#[cfg(feature = "protobuf")]
mod schemas;
#[cfg(feature = "protobuf")]
mod ways_out;

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

#[cfg(feature = "protobuf")]
const PROTO: &str = "syntax = \"proto3\";\npackage rover;\nmessage Measurement { double data = 1; }\n";

/// A file with these `schemas`, whose gates carry `message`.
#[cfg(feature = "protobuf")]
fn typed(schemas: &str, message: &str) -> String {
    format!("schemas: {schemas}\n{}", GOOD.replace("measurements: pub", &format!("measurements: {{pub: {message}}}")))
}

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
          = note: 0xFF 0xFE is the byte order mark of UTF-16, which Windows Notepad calls "Unicode"
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
        (path("round"), "is a symbolic link that cannot be followed"),
        (path("dangling"), "is a symbolic link that cannot be followed"),
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
              |           ^^^^^^^^^^^ this build of SCL does not compile schemas
              |
              = help: switch it on in Cargo.toml: scl = { package = "scl-gates", version = "..", features = ["protobuf"] }
              = note: without `schemas`, types are looked up in your Rust code
        "#]],
    );
}
