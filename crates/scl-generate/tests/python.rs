//! Generated Python modules beside the expected ones. `tests/tests/python_typing.rs` checks what type checkers and
//! `ruff format` say of the expected ones, and `tests/tests/python_generated.rs` runs them.

use crate::fixture::{clashes, generated, repository, testable, text, topology};
use expect_test::{expect, expect_file};
use scl_generate::Target;
use std::path::Path;

/// The module `<system>_scl.py` of a topology file of the repository.
fn module(system: &str, path: impl AsRef<Path>) -> String {
    text(&generated(&repository().join(path), Target::Python), &format!("{system}_scl.py"))
}

#[test]
fn the_quick_start() {
    expect_file!["python/expected/rover_scl.py"].assert_eq(&module("rover", "examples/quickstart/topology.yaml"));
}

#[test]
fn every_kind_codec_and_field() {
    let text = module("everything", "crates/scl-generate/tests/python/everything.yaml");
    expect_file!["python/expected/everything_scl.py"].assert_eq(&text);
}

#[test]
fn the_topologies_of_the_other_languages() {
    expect_file!["python/expected/every_kind_scl.py"].assert_eq(&module("every_kind", topology("every_kind.yaml")));
    expect_file!["python/expected/bytes_scl.py"].assert_eq(&module("bytes", topology("bytes.yaml")));
}

#[test]
fn the_topologies_of_tests_between_processes() {
    expect_file!["python/expected/six_scl.py"].assert_eq(&module("six", "tests/topologies/six_kinds.yaml"));
    expect_file!["python/expected/json_scl.py"].assert_eq(&module("json", "tests/topologies/json.yaml"));
}

#[test]
fn parameters_become_a_dataclass() {
    let text = text(&testable(&topology("controls.yaml"), Target::Python), "controls_scl.py");
    expect_file!["python/expected/controls_scl.py"].assert_eq(&text);
}

#[test]
fn words_that_become_one_member_are_refused() {
    let yaml = "\
components:
  - name: controller
    parameters:
      - mode: {one_of: [slow_mode, SLOW_MODE]}
    gates: []
";
    expect![[r#"
        error: [SCL1102] value `slow_mode` of parameter `controller.mode` and value `SLOW_MODE` of parameter `controller.mode` would both become `SLOW_MODE` in class `ControllerMode`
         --> topology.yaml:4:9
          |
        4 |       - mode: {one_of: [slow_mode, SLOW_MODE]}
          |         ^^^^
          |         |
          |         becomes `SLOW_MODE`
          |         value `slow_mode` of parameter `controller.mode` becomes `SLOW_MODE`
          |
          = help: rename the value `SLOW_MODE` of parameter `controller.mode`
    "#]].assert_eq(&clashes(yaml, SCHEMA, Target::Python));
}

#[test]
fn no_module_depends_on_where_the_topology_lies() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["topology.yaml", "rover.proto"] {
        std::fs::copy(repository().join("examples/quickstart").join(name), folder.path().join(name)).unwrap();
    }
    let here = module("rover", "examples/quickstart/topology.yaml");
    assert_eq!(module("rover", folder.path().join("topology.yaml")), here);
}

const SCHEMA: &str = "syntax = \"proto3\"; package rover; message Status {}";

#[test]
fn a_component_and_a_message_of_one_name_are_refused() {
    let yaml = "\
schemas: [rover.proto]
components:
  - name: status
    gates:
      - out: {pub: rover.Status, unconnected: ok}
";
    assert_eq!(clashes(&yaml.replace("name: status", "name: panel"), SCHEMA, Target::Python), "");
    expect![[r#"
        error: [SCL1101] component `status` and message `rover.Status` would both become `Status` in module `topology_scl`
         --> topology.yaml:3:11
          |
        3 |   - name: status
          |           ^^^^^^ becomes `Status`
        4 |     gates:
        5 |       - out: {pub: rover.Status, unconnected: ok}
          |                    ------------ message `rover.Status` becomes `Status`
          |
          = help: rename the component `status`
    "#]].assert_eq(&clashes(yaml, SCHEMA, Target::Python));
}

#[test]
fn gates_that_become_one_attribute_are_refused() {
    let yaml = "\
components:
  - name: x
    gates:
      - close: {pub: , unconnected: ok}
      - close_: {pub: , unconnected: ok}
";
    expect![[r#"
        error: [SCL1102] gate `x.close` and gate `x.close_` would both become `close_` in class `X`
         --> topology.yaml:5:9
          |
        4 |       - close: {pub: , unconnected: ok}
          |         ----- gate `x.close` becomes `close_`
        5 |       - close_: {pub: , unconnected: ok}
          |         ^^^^^^ becomes `close_`
          |
          = help: rename the gate `x.close_`
    "#]]
    .assert_eq(&clashes(yaml, SCHEMA, Target::Python));
}

#[test]
fn messages_with_names_of_the_module_are_refused() {
    let yaml = "\
schemas: [rover.proto]
components:
  - name: x
    gates:
      - out: {pub: rover.Status, unconnected: ok}
";
    let schema = format!("{SCHEMA} message _PLAN {{}}");
    expect![[r#"
        error: [SCL1102] `_PLAN` of the module and message `rover._PLAN` would both become `_PLAN` in module `topology_scl`
         |
         = help: rename the message `rover._PLAN`
    "#]].assert_eq(&clashes(yaml, &schema, Target::Python));
}

/// mypy takes a name that the module declares further down for the one that Python has.
#[test]
fn messages_called_like_something_of_python_have_another_name_in_annotations() {
    let yaml = "\
schemas: [rover.proto]
components:
  - name: sensor
    gates:
      - alarm: {pub: rover.Warning, unconnected: ok}
      - values: {pub: rover.list, unconnected: ok}
      - fix: {pub: rover.Fix, unconnected: ok}
";
    let folder = tempfile::tempdir().unwrap();
    let schema = "syntax = \"proto3\"; package rover; message Warning {} message list {} message Fix {}";
    std::fs::write(folder.path().join("topology.yaml"), yaml).unwrap();
    std::fs::write(folder.path().join("rover.proto"), schema).unwrap();
    let text = module("topology", folder.path().join("topology.yaml"));
    for line in ["alarm: _scl.Pub[_type_Warning]", "values: _scl.Pub[_type_list]", "fix: _scl.Pub[Fix]"] {
        assert!(text.contains(line), "{line} is not in\n{text}");
    }
}
