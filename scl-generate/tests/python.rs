//! Generated Python modules beside the expected ones. `tests/tests/python_typing.rs` checks what type checkers and
//! `ruff format` say about the expected ones, and runs them.

use expect_test::expect_file;
use scl_generate::{System, Target, generate};
use scl_loader::{Request, load};
use std::path::{Path, PathBuf};

fn system(topology: &str) -> System {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(topology);
    let loaded = load(&Request::new(path));
    System::of(&loaded).unwrap_or_else(|| panic!("{topology}: {:?}", loaded.diagnostics))
}

fn module(topology: &str) -> String {
    let files = generate(&system(topology), Target::Python).unwrap();
    let [file] = files.try_into().unwrap();
    assert!(file.name.ends_with("_scl.py"), "{}", file.name);
    file.text
}

#[test]
fn the_quick_start() {
    expect_file!["python/expected/rover_scl.py"].assert_eq(&module("../examples/quickstart/topology.yaml"));
}

#[test]
fn every_kind_codec_and_field() {
    expect_file!["python/expected/everything_scl.py"].assert_eq(&module("tests/python/everything.yaml"));
}

#[test]
fn topologies_of_the_tests_between_processes() {
    expect_file!["python/expected/six_scl.py"].assert_eq(&module("../tests/topologies/six_kinds.yaml"));
    expect_file!["python/expected/json_scl.py"].assert_eq(&module("../tests/topologies/json.yaml"));
}

#[test]
fn no_file_depends_on_where_the_topology_lies() {
    let folder = tempfile::tempdir().unwrap();
    let from =
        |name: &str| -> PathBuf { Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/quickstart").join(name) };
    for name in ["topology.yaml", "rover.proto"] {
        std::fs::copy(from(name), folder.path().join(name)).unwrap();
    }
    let elsewhere = folder.path().join("topology.yaml");
    assert_eq!(module(elsewhere.to_str().unwrap()), module("../examples/quickstart/topology.yaml"));
}

/// The texts of clashes in a topology with these components and this schema.
fn clashes(components: &str, proto: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("topology.yaml");
    std::fs::write(&path, format!("schemas: [a.proto]\ncomponents:\n{components}")).unwrap();
    std::fs::write(folder.path().join("a.proto"), format!("syntax = \"proto3\";\npackage a;\n{proto}")).unwrap();
    let loaded = load(&Request::new(path));
    let system = System::of(&loaded).unwrap_or_else(|| panic!("{:?}", loaded.diagnostics));
    let found = generate(&system, Target::Python).unwrap_err();
    found.iter().map(|it| format!("{}: {}\n", it.code(), it.message)).collect()
}

#[test]
fn names_that_would_be_one_are_refused() {
    let gate = "    gates: [{out: {pub: a.Status, unconnected: ok}}]\n";
    let found = clashes(&format!("  - name: status\n{gate}"), "message Status {}");
    expect_test::expect![[r#"
        SCL1101: component `status` and message `a.Status` would both become `Status` in module `topology_scl`
    "#]]
    .assert_eq(&found);
    let gates = "    gates: [{close: {pub: a.Status, unconnected: ok}}, {close_: {pub: a.Status, unconnected: ok}}]\n";
    let found = clashes(&format!("  - name: x\n{gates}"), "message Status {}");
    expect_test::expect![[r#"
        SCL1102: gate `x.close` and gate `x.close_` would both become `close_` in class `X`
    "#]]
    .assert_eq(&found);
    let found = clashes(&format!("  - name: x\n{gate}"), "message Status {}\nmessage _PLAN {}");
    expect_test::expect![[r#"
        SCL1102: `_PLAN` of the module and message `a._PLAN` would both become `_PLAN` in module `topology_scl`
    "#]]
    .assert_eq(&found);
}
