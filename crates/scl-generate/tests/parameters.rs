//! Parameters in C and C++, and their names. Those in Python are in `python`.

use crate::fixture::{clashes, testable, text, topology};
use expect_test::{expect, expect_file};
use scl_generate::Target;

const SCHEMA: &str = "syntax = \"proto3\"; package rover; message Status {}";

#[test]
fn parameters_become_a_struct_of_c() {
    let files = testable(&topology("controls.yaml"), Target::C);
    expect_file!["expected/controls_scl.h"].assert_eq(&text(&files, "controls_scl.h"));
    expect_file!["expected/controls_scl.c"].assert_eq(&text(&files, "controls_scl.c"));
}

#[test]
fn parameters_become_a_struct_of_cpp() {
    let header = text(&testable(&topology("controls.yaml"), Target::Cpp), "controls.scl.hpp");
    expect_file!["expected/controls.scl.hpp"].assert_eq(&header);
}

#[test]
fn members_of_one_name_are_refused() {
    let yaml = "\
components:
  - name: controller
    parameters:
      - period: duration
      - period_ns: u64
    gates: []
";
    expect![[r#"
        error: [SCL1102] parameter `controller.period` and parameter `controller.period_ns` would both become `period_ns` in the C struct `topology_controller_parameters`
         --> topology.yaml:5:9
          |
        4 |       - period: duration
          |         ------ parameter `controller.period` becomes `period_ns`
        5 |       - period_ns: u64
          |         ^^^^^^^^^ becomes `period_ns`
          |
          = help: rename the parameter `controller.period_ns`
    "#]].assert_eq(&clashes(yaml, SCHEMA, Target::C));
}

#[test]
fn a_choice_with_the_name_of_a_function_is_refused() {
    let yaml = "\
components:
  - name: controller
    parameters:
      - close: {one_of: [slowly, at-once]}
    gates: []
";
    expect![[r#"
        error: [SCL1102] component `controller` and parameter `controller.close` would both become `topology_controller_close` in C
         --> topology.yaml:4:9
          |
        2 |   - name: controller
          |           ---------- component `controller` becomes `topology_controller_close`
        3 |     parameters:
        4 |       - close: {one_of: [slowly, at-once]}
          |         ^^^^^ becomes `topology_controller_close`
          |
          = help: rename the parameter `controller.close`
    "#]].assert_eq(&clashes(yaml, SCHEMA, Target::C));
}
