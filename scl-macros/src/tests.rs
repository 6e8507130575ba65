//! What whole calls expand to.

mod mutations;

use crate::expand::expand_topology;
use crate::locate::Surroundings;
use expect_test::expect;
use proc_macro2::TokenStream;
use std::fs;
use tempfile::TempDir;

/// A fresh folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Expands `topology!("t.yaml")` with more arguments, called in a folder with these files.
fn expand_with(files: &[(&str, &str)], more: &str) -> TokenStream {
    let folder = folder(files);
    let surroundings = Surroundings {
        source_file: Some("main.rs".into()),
        package: Some(folder.path().into()),
        workspace: None,
        working: folder.path().into(),
    };
    expand_topology(format!("scl, \"t.yaml\" {more}").parse().unwrap(), &surroundings)
}

fn expand(yaml: &str) -> TokenStream {
    expand_with(&[("t.yaml", yaml)], "")
}

#[track_caller]
fn parsed(tokens: &TokenStream) -> syn::File {
    syn::parse2(tokens.clone()).unwrap_or_else(|error| panic!("{error}:\n{tokens}"))
}

/// The names of the structs, each with its fields, but for those of unit tests.
fn structs(file: &syn::File) -> Vec<String> {
    structs_if(file, |item| !is_for_tests(item))
}

fn is_for_tests(item: &syn::ItemStruct) -> bool {
    item.attrs.iter().any(|attribute| attribute.path().is_ident("cfg"))
}

fn structs_if(file: &syn::File, wanted: fn(&syn::ItemStruct) -> bool) -> Vec<String> {
    let structs = file.items.iter().filter_map(|item| match item {
        syn::Item::Struct(item) if wanted(item) => Some(item),
        _ => None,
    });
    let described = structs.map(|item| {
        let fields: Vec<String> =
            item.fields.iter().filter_map(|field| Some(field.ident.as_ref()?.to_string())).collect();
        format!("{} {}", item.ident, fields.join(" "))
    });
    described.collect()
}

fn errors(tokens: &TokenStream) -> usize {
    tokens.to_string().matches("compile_error").count()
}

/// One item or field a line, so that the text can be read and compared.
fn in_lines(tokens: &TokenStream) -> String {
    let text = tokens.to_string();
    [("{ ", "{\n"), ("; ", ";\n"), ("} ", "}\n"), (", pub ", ",\npub "), ("] pub", "]\npub"), ("] const", "]\nconst")]
        .iter()
        .fold(text, |text, (from, to)| text.replace(from, to))
}

const LISTING_1: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: actuator
    gates:
      - setpoint: sub
  - name: controller
    gates:
      - sensor: sub
      - actuator: pub
      - events: pub
      - commands: rep
  - name: user_interface
    gates:
      - events: sub
      - commands: req
connections:
  - [sensor.measurements, controller.sensor]
  - [actuator.setpoint, controller.actuator]
  - [controller.events, user_interface.events]
  - [controller.commands, user_interface.commands]
";

#[test]
fn listing_1_becomes_four_structs() {
    let tokens = expand(LISTING_1);
    assert_eq!(errors(&tokens), 0, "{tokens}");
    assert!(!tokens.to_string().contains("deprecated"), "lints are not shown: {tokens}");
    let expected = [
        "Sensor measurements",
        "Actuator setpoint",
        "Controller sensor actuator events commands",
        "UserInterface events commands",
    ];
    assert_eq!(structs(&parsed(&tokens)), expected);
    let for_tests = structs_if(&parsed(&tokens), is_for_tests);
    assert_eq!(for_tests[2], "ControllerPeer sensor actuator events commands");
}

#[test]
fn only_some_components_are_generated() {
    let tokens = expand_with(&[("t.yaml", LISTING_1)], ", only = [sensor, user_interface]");
    assert_eq!(structs(&parsed(&tokens)), ["Sensor measurements", "UserInterface events commands"]);
    let tokens = expand_with(&[("t.yaml", LISTING_1)], ", only = [sensr]");
    parsed(&tokens);
    assert!(tokens.to_string().contains("did you mean `sensor`?"), "{tokens}");
}

#[test]
fn every_prefix_of_a_file_expands() {
    for end in (0..LISTING_1.len()).step_by(3) {
        let tokens = expand(&LISTING_1[..end]);
        parsed(&tokens);
    }
}

#[test]
fn broken_files_keep_the_structs_that_can_be_read() {
    let cases = [
        ("components: [", 1, ""),
        ("components:\n  - name: a\n    gates:\n      - x: pubb\n", 1, "A x"),
        (
            "components:\n  - name: a\n    gates:\n      - x: pub\n  - name: b\n    gates:\n      - z: sub\nconnections:\n  - [a.x, b.u]\n",
            1,
            "A x/B z",
        ),
        (
            "components:\n  - name: a\n    gates:\n      - type: {req: P -> Q}\nconnections:\n  - [a.type, b.z]\n",
            1,
            "A r#type",
        ),
    ];
    for (yaml, at_least, expected) in cases {
        let tokens = expand(yaml);
        assert!(errors(&tokens) >= at_least, "{tokens}");
        assert_eq!(structs(&parsed(&tokens)).join("/"), expected, "{yaml}");
    }
}

#[test]
fn a_missing_file_is_one_error() {
    let tokens = expand_with(&[("t.yml", "")], "");
    parsed(&tokens);
    assert_eq!(errors(&tokens), 1);
    assert!(tokens.to_string().contains("a file with a similar name exists: `t.yml`"), "{tokens}");
}

#[test]
fn twenty_errors_are_shown_and_the_rest_is_counted() {
    let gates: String = (0..25).map(|at| format!("      - x{at}: pubb\n")).collect();
    let tokens = expand(&format!("components:\n  - name: a\n    gates:\n{gates}"));
    parsed(&tokens);
    assert_eq!(errors(&tokens), 21);
    assert!(tokens.to_string().contains("more problems"), "{tokens}");
}

#[test]
fn one_small_component_in_full() {
    let yaml = "\
components:
  - name: sensor
    doc: Reads the unit.
    gates:
      - measurements: {pub: rover.Measurement, doc: One reading per period.}
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement, queue: 1}
connections:
  - [sensor.measurements, controller.sensor]
";
    let tokens = expand_with(&[("t.yaml", yaml)], ", only = [sensor]");
    let text = in_lines(&tokens);
    let (text, tracking) = text.split_once("const _ : & [u8]").unwrap();
    assert!(tracking.contains("include_bytes"), "{tracking}");
    expect![[r##"
        # [doc = "Reads the unit.\n\n| gate | kind | type | peers |\n|---|---|---|---|\n| `measurements` | `pub` | `rover.Measurement` | `controller.sensor` |\n\nThe component `sensor` of `t`, declared at `t.yaml:2:11`."] # [allow (dead_code , non_camel_case_types , non_snake_case)]
        pub struct Sensor {
        # [doc = "`pub`: publishes `rover.Measurement` to `controller.sensor`.\n\nOne reading per period.\n\nDeclared at `t.yaml:5:9`."]
        pub measurements : scl :: private :: Pub < rover :: Measurement > }
        # [cfg (test)] # [doc = "The other ends of all gates of `sensor`, for its unit tests."] # [allow (dead_code , non_camel_case_types , non_snake_case)]
        pub struct SensorPeer {
        # [doc = "The other end of `sensor.measurements`."]
        pub measurements : scl :: private :: Sub < rover :: Measurement > }
        # [allow (dead_code , non_camel_case_types , non_snake_case , clippy :: all , clippy :: pedantic)]
        const _ : () = {
        # [diagnostic :: on_unimplemented (message = "[SCL0606] `{Self}` is used as a message, but the codec `protobuf` does not carry it" , label = "gate `sensor.measurements` sends `rover::Measurement`" , note = "derive `prost::Message` for it, or name a `.proto` file in `schemas:`" , note = "the gate is declared here\n --> t.yaml:5:9\n  |\n5 |       - measurements: {{pub: rover.Measurement, doc: One reading per period.}}\n  |         ^^^^^^^^^^^^")] trait RoverMeasurementCarriedByProtobuf_0 < > : :: core :: marker :: Sized {
        fn publisher (__opener : & mut scl :: private :: Opener , __index : usize ,) -> :: core :: result :: Result < scl :: private :: Pub < Self > , scl :: private :: OpenError > ;
        fn subscriber (__opener : & mut scl :: private :: Opener , __index : usize ,) -> :: core :: result :: Result < scl :: private :: Sub < Self > , scl :: private :: OpenError > ;
        }
        # [diagnostic :: do_not_recommend] impl < Message : 'static , > RoverMeasurementCarriedByProtobuf_0 < > for Message where scl :: private :: codec :: Protobuf : scl :: private :: Codec < Message > , {
        fn publisher (__opener : & mut scl :: private :: Opener , __index : usize ,) -> :: core :: result :: Result < scl :: private :: Pub < Self > , scl :: private :: OpenError > {
        __opener . publisher :: < Message , scl :: private :: codec :: Protobuf > (__index) }
        fn subscriber (__opener : & mut scl :: private :: Opener , __index : usize ,) -> :: core :: result :: Result < scl :: private :: Sub < Self > , scl :: private :: OpenError > {
        __opener . subscriber :: < Message , scl :: private :: codec :: Protobuf > (__index) }
        }
        impl scl :: private :: Component for Sensor {
        const SPEC : & 'static scl :: private :: ComponentSpec = & scl :: private :: ComponentSpec {
        system : "t" , name : "sensor" , place : "t.yaml:2:11" , gates : & [scl :: private :: GateSpec {
        name : "measurements" , kind : scl :: private :: GateKind :: Pub , payload : "rover.Measurement" , codec : "protobuf" , place : "t.yaml:5:9" , endpoint : "sensor.measurements.tap" , queue : 100u32 , when_full : scl :: private :: WhenFull :: DropOldest , backpressure : false , timeout : scl :: private :: Duration :: new (1u64 , 0u32) , links : & [scl :: private :: LinkSpec {
        peer_component : "controller" , peer_gate : "sensor" , endpoint : "sensor.measurements--controller.sensor.hl75aqsl" , contract : "hl75aqsl" , required : true , queue : 1u32 , when_full : scl :: private :: WhenFull :: DropOldest , }] , }] }
        ;
        fn assemble (__opener : & mut scl :: private :: Opener) -> :: core :: result :: Result < Self , scl :: private :: OpenError > {
        :: core :: result :: Result :: Ok (Self {
        measurements : RoverMeasurementCarriedByProtobuf_0 :: publisher (__opener , 0usize) ? }) }
        fn gates (& self) -> :: std :: vec :: Vec < & dyn scl :: private :: AnyGate > {
        :: std :: vec :: Vec :: from ([& self . measurements as & dyn scl :: private :: AnyGate]) }
        }
        scl :: private :: component_methods ! (Sensor) ;
        # [cfg (test)] impl scl :: private :: Component for SensorPeer {
        const SPEC : & 'static scl :: private :: ComponentSpec = & scl :: private :: ComponentSpec {
        system : "t" , name : "sensor's peers" , place : "" , gates : & [scl :: private :: GateSpec {
        name : "measurements" , kind : scl :: private :: GateKind :: Sub , payload : "rover.Measurement" , codec : "protobuf" , place : "t.yaml:5:9" , endpoint : "sensor.measurements.peer" , queue : :: core :: primitive :: u32 :: MAX , when_full : scl :: private :: WhenFull :: Wait , backpressure : true , timeout : scl :: private :: Duration :: from_secs (10) , links : & [scl :: private :: LinkSpec {
        peer_component : "sensor" , peer_gate : "measurements" , endpoint : "sensor.measurements--controller.sensor.hl75aqsl" , contract : "" , required : true , queue : 100u32 , when_full : scl :: private :: WhenFull :: DropOldest , }] , }] }
        ;
        fn assemble (__opener : & mut scl :: private :: Opener) -> :: core :: result :: Result < Self , scl :: private :: OpenError > {
        :: core :: result :: Result :: Ok (Self {
        measurements : RoverMeasurementCarriedByProtobuf_0 :: subscriber (__opener , 0usize) ? }) }
        fn gates (& self) -> :: std :: vec :: Vec < & dyn scl :: private :: AnyGate > {
        :: std :: vec :: Vec :: from ([& self . measurements as & dyn scl :: private :: AnyGate]) }
        }
        # [cfg (test)] scl :: private :: component_test_methods ! (Sensor , SensorPeer) ;
        }
        ;
    "##]].assert_eq(text);
}

#[test]
fn types_that_may_be_aliases_are_compared_by_rustc() {
    let yaml = LISTING_1
        .replace("measurements: pub", "measurements: {pub: nav.Pose}")
        .replace("sensor: sub", "sensor: {sub: log.Pose}");
    let tokens = expand(&yaml);
    parsed(&tokens);
    let text = tokens.to_string();
    assert!(text.contains("connection :: < nav :: Pose , log :: Pose > ()"), "{text}");
    let alone = expand_with(&[("t.yaml", &yaml)], ", only = [sensor]").to_string();
    assert!(!alone.contains("SameTypeAs"), "{alone}");
}

#[cfg(feature = "protobuf")]
mod schemas {
    use super::*;

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
        assert!(tokens.to_string().contains("pub use __scl_messages_t_yaml :: *"), "{tokens}");
    }
}

/// The time is printed, not judged: `cargo test -p scl-macros many -- --nocapture`.
#[test]
fn many_components_expand() {
    for count in [40, 1_000] {
        let yaml = ring(count);
        let start = std::time::Instant::now();
        let tokens = expand(&yaml);
        println!("{count} components, {} gates: {:?}", 3 * count, start.elapsed());
        assert_eq!(errors(&tokens), 0);
        assert_eq!(structs(&parsed(&tokens)).len(), count);
    }
}

/// Components that each publish to the one before, and have a gate to spare.
fn ring(count: usize) -> String {
    let component = |at: usize| {
        let next = (at + 1) % count;
        let gates = format!(
            "      - out{at}: {{pub: rover.M{at}}}\n      - in{at}: {{sub: rover.M{next}}}\n      - spare{at}: {{pub: rover.S{at}, unconnected: ok}}\n"
        );
        format!("  - name: c{at}\n    gates:\n{gates}")
    };
    let connection = |at: usize| format!("  - [c{0}.out{0}, c{1}.in{1}]\n", (at + 1) % count, at);
    let components: String = (0..count).map(component).collect();
    let connections: String = (0..count).map(connection).collect();
    format!("components:\n{components}connections:\n{connections}")
}
