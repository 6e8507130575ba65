//! What is advised about schemas that are wrong, or not where they are looked for.

use super::imports::{base, importer, told, with_schemas};
use super::*;
use scl_topology::diagnostic::Diagnostic;

/// The root is the folder from which another schema imports the entry.
#[test]
fn an_entry_outside_of_the_roots_is_told_once() {
    let (text, nav) = (base("x"), importer("nav", "common/header.proto"));
    for (lines, fixed) in [
        ("schema_roots: [proto]", "schema_roots: [proto, shared]"),
        ("schema_roots:\n  - proto", "schema_roots:\n  - proto\n  - shared"),
    ] {
        let schemas = "schemas: [proto/nav/fix.proto, shared/common/header.proto]\n";
        let yaml = with_schemas(&format!("{schemas}{lines}"));
        let files = [("t.yaml", &*yaml), ("proto/nav/fix.proto", &nav), ("shared/common/header.proto", &text)];
        let expected = "the schema `shared/common/header.proto` is in none of the folders of `schema_roots`\n\
                        name the folder in which imports begin: `schema_roots: [proto, shared]`";
        assert_eq!(told(&files, "t.yaml"), expected);
        let edits = proposals(&files);
        assert_eq!(edits, [yaml.replace(lines, fixed)]);
    }
}

/// The topology file after each proposal, without those of lints.
fn proposals(files: &[(&str, &str)]) -> Vec<String> {
    let loaded = load_from(&folder(files), "t.yaml");
    let text = files[0].1;
    let told = loaded.diagnostics.iter().filter(|problem| problem.severity != Severity::Lint);
    let all = told.flat_map(Diagnostic::proposals);
    all.map(|way| scl_topology::advice::apply(text, &way.edits.iter().collect::<Vec<_>>()).unwrap()).collect()
}

#[test]
fn copies_that_differ_are_told_once() {
    let (nav, arm) = (importer("nav", "common.proto"), importer("arm", "common.proto"));
    let yaml = with_schemas("schemas: [nav/fix.proto, arm/joint.proto]");
    let (one, two) = (base("x"), base("x").replace(" }", " double y = 2; }"));
    let files = [
        ("t.yaml", &*yaml),
        ("nav/fix.proto", &nav),
        ("arm/joint.proto", &arm),
        ("nav/common.proto", &one),
        ("arm/common.proto", &two),
    ];
    expect![[r#"
        the import `common.proto` in `nav/fix.proto` can mean two files: `nav/common.proto` and `arm/common.proto`
        both declare the same messages, and differ in line 3: make them equal, or keep only one"#]]
    .assert_eq(&told(&files, "t.yaml"));
}

#[test]
fn a_schema_that_is_not_named_is_found() {
    let (text, nav) = (base("x"), "syntax = \"proto3\";\npackage nav;\nmessage Main {}\n");
    let yaml = with_schemas("schemas:\n  - nav/fix.proto");
    let files = [("t.yaml", &*yaml), ("nav/fix.proto", nav), ("nav/base.proto", &*text)];
    let expected = "`base.Header` is declared by `nav/base.proto`, which is not one of the `schemas`\n\
                    add `- nav/base.proto` to `schemas`";
    assert_eq!(told(&files, "t.yaml"), expected);
    assert_eq!(proposals(&files), [yaml.replace("fix.proto", "fix.proto\n  - nav/base.proto")]);
    let read = load_from(&folder(&files), "t.yaml").files_read;
    assert!(read.last().unwrap().ends_with("nav/base.proto"), "{read:?}");
}

#[test]
fn entries_that_are_no_schemas_lead_to_one() {
    let text = base("x");
    let told = |entry: &str| {
        let yaml = with_schemas(&format!("schemas: [{entry}]"));
        let files = [("t.yaml", &*yaml), ("proto/base.proto", &*text), ("proto/Base.msg", "float64 x\n")];
        format!("{entry}: {}\n", told(&files, "t.yaml").replace('\n', " | "))
    };
    let entries = ["proto/base_pb2.py", "proto/base.pb.h", "proto/Base.msg", "proto", "proto/bse.proto", "other.py"];
    expect![[r#"
        proto/base_pb2.py: cannot find the schema file `proto/base_pb2.py` | did you mean `proto/base.proto`?
        proto/base.pb.h: cannot find the schema file `proto/base.pb.h` | did you mean `proto/base.proto`?
        proto/Base.msg: `proto/Base.msg` is not a `.proto` file | did you mean `proto/base.proto`?
        proto: the schema file `proto` is a directory, not a file | did you mean `proto/base.proto`?
        proto/bse.proto: cannot find the schema file `proto/bse.proto` | did you mean `proto/base.proto`?
        other.py: cannot find the schema file `other.py`
    "#]]
    .assert_eq(&entries.map(told).concat());
}

/// What is said about a schema `a.proto` with this text, in a folder with `base.proto`.
#[test]
fn errors_of_the_compiler_have_ways_out() {
    let text = base("x");
    let told = |rest: &str| {
        let yaml = with_schemas("schemas: [a.proto]");
        let schema = format!("syntax = \"proto3\";\npackage a;\n{rest}\n");
        let told = told(&[("t.yaml", &yaml), ("a.proto", &schema), ("base.proto", &text)], "t.yaml");
        format!("{}\n", told.replace("the schema file `a.proto` does not compile: ", "").replace('\n', " | "))
    };
    let schemas = [
        "enum Mode { MODE_AUTO = 1; }",
        "enum FlightMode { AUTO = 1; OFF = 0; }",
        "message A { repeated float64 x = 1; float64 y = 2; }",
        "message A { str x = 1; }",
        "message A { google.protobuf.Timestamp at = 1; }",
        "message A { Duration at = 1; }",
        "message A { base.Header header = 1; }",
        "message Pose {} message A { Pos pose = 1; doubel x = 2; }",
        "message A { some.Other x = 1; }",
    ];
    expect![[r#"
        the first value for proto3 enums must be 0 | add `MODE_UNSPECIFIED = 0;` as the first value; the others keep their numbers
        the first value for proto3 enums must be 0 | move `OFF = 0;` to the first place; the order has no other meaning
        name `float64` is not defined | did you mean `double`?
        name `str` is not defined | did you mean `string`?
        name `google.protobuf.Timestamp` is not defined | add `import "google/protobuf/timestamp.proto";`
        name `Duration` is not defined | write `google.protobuf.Duration`, and add `import "google/protobuf/duration.proto";`
        name `base.Header` is not defined | add `import "base.proto";`
        name `Pos` is not defined | did you mean `Pose`?
        name `some.Other` is not defined | a type is one of protobuf's own, or declared in this file or in one that it imports
    "#]].assert_eq(&schemas.map(told).concat());
}
