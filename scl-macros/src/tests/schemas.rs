//! Expansions of files with `schemas:`.

use super::{errors, expand_with, parsed, structs};

const YAML: &str = "\
schemas: [a.proto]
components:
  - name: sensor
    gates:
      - pose: {pub: a.b.IMUPose.Axis, unconnected: ok}
";
const PROTO: &str = "\
syntax = \"proto3\";
package a.b;
// A comment.
message IMUPose { message Axis { double x = 1; } Axis axis = 1; }
";

#[test]
fn packages_become_modules_that_import_prost_by_its_crate() {
    let tokens = expand_with(&[("t.yaml", YAML), ("a.proto", PROTO)], "");
    assert_eq!(errors(&tokens), 0, "{tokens}");
    let text = tokens.to_string();
    parsed(&tokens);
    assert!(text.contains("pub pose : scl :: private :: Pub < a :: b :: imu_pose :: Axis >"), "{text}");
    assert!(text.contains("pub mod a { use scl :: private :: prost as scl_private_prost"), "{text}");
    assert!(!text.contains(":: prost ::"), "{text}");
    assert_eq!(text.matches("include_bytes").count(), 2, "{text}");
}

/// The embedded schemas, and which of them each component has; its counterpart follows each component.
fn embedded(yaml: &str, proto: &str) -> (Vec<String>, Vec<String>) {
    let tokens = expand_with(&[("t.yaml", yaml), ("a.proto", proto)], "");
    assert_eq!(errors(&tokens), 0, "{tokens}");
    let text = tokens.to_string();
    let between = |start: &str, end: &str| -> Vec<String> {
        let parts = text.split(start).skip(1);
        parts.map(|rest| rest.split_once(end).unwrap().0.to_owned()).collect()
    };
    (between("= scl :: private :: Schema {", "} ;"), between(" , schema : :: core :: option :: Option :: ", " , }"))
}

#[test]
fn components_embed_the_descriptors_of_their_messages() {
    let yaml = "\
schemas: [a.proto]
components:
  - name: sensor
    gates:
      - pose: {pub: a.b.IMUPose.Axis, codec: json, unconnected: ok}
  - name: logger
    gates:
      - text: {pull: , unconnected: ok}
  - name: idle
    gates: []
  - name: asking
    gates:
      - ask: {rep: a.b.IMUPose -> a.b.IMUPose, unconnected: ok}
";
    let (constants, uses) = embedded(yaml, PROTO);
    let [constant] = constants.as_slice() else { panic!("{constants:?}") };
    assert!(constant.contains("hash : \"") && constant.contains("descriptors : b\""), "{constant}");
    assert!(constant.contains("IMUPose") && !constant.contains("A comment"), "{constant}");
    assert_eq!(uses, ["Some (SCHEMA_0)", "None", "None", "None", "None", "None", "Some (SCHEMA_0)", "None"]);
    // Building again without a change gives the same program.
    assert_eq!(embedded(yaml, PROTO).0, constants);
    assert_ne!(embedded(yaml, &PROTO.replace("double x", "double y")).0, constants);
}

#[test]
fn components_of_different_schema_files_embed_different_descriptors() {
    let yaml = "\
schemas: [a.proto, b.proto]
components:
  - name: sensor
    gates:
      - pose: {pub: a.b.IMUPose, unconnected: ok}
  - name: clock
    gates:
      - time: {pub: Time, unconnected: ok}
";
    let time = "syntax = \"proto3\";\nmessage Time { uint64 seconds = 1; }\n";
    let tokens = expand_with(&[("t.yaml", yaml), ("a.proto", PROTO), ("b.proto", time)], "");
    assert_eq!(errors(&tokens), 0, "{tokens}");
    let text = tokens.to_string();
    let constants: Vec<&str> = text.split("= scl :: private :: Schema {").skip(1).collect();
    assert_eq!(constants.len(), 2);
    let literal = |constant: &str| constant.split("} ;").next().unwrap().to_owned();
    assert!(literal(constants[0]).contains("IMUPose") && !literal(constants[0]).contains("Time"));
    assert!(literal(constants[1]).contains("Time") && !literal(constants[1]).contains("IMUPose"));
    assert!(text.contains("Option :: Some (SCHEMA_1)"), "{text}");
}

#[test]
fn a_wrong_schema_leaves_the_gates() {
    let tokens = expand_with(&[("t.yaml", YAML), ("a.proto", "message")], "");
    assert_eq!(errors(&tokens), 1, "{tokens}");
    assert_eq!(structs(&parsed(&tokens)), ["Sensor pose"]);
    assert!(tokens.to_string().contains("Pub < __scl_unknown_t_yaml >"), "{tokens}");
}

#[test]
fn messages_without_a_package_stand_beside_the_components() {
    let yaml = YAML.replace("a.b.IMUPose.Axis", "IMUPose");
    let tokens = expand_with(&[("t.yaml", &yaml), ("a.proto", &PROTO.replace("package a.b;", ""))], "");
    assert_eq!(errors(&tokens), 0, "{tokens}");
    parsed(&tokens);
    assert!(tokens.to_string().contains("pub use messages_of_t_yaml :: *"), "{tokens}");
}
