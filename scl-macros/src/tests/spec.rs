//! Specifications and documentation in the generated code.

use super::{expand, expand_with, is_for_tests, parsed, structs, structs_if};
use expect_test::expect;
use proc_macro2::TokenStream;

#[test]
fn an_included_file_is_tracked_and_named() {
    let main = "include: [sensors.yaml]\ncomponents: []\nconnections: []\n";
    let sensors = "components:\n  - name: sensor\n    gates:\n      - measurements: {pub: T, unconnected: ok}\n";
    let text = expand_with(&[("t.yaml", main), ("sensors.yaml", sensors)], "").to_string();
    assert_eq!(text.matches("include_bytes").count(), 2, "{text}");
    assert!(text.contains("declared at `sensors.yaml:2:11`"), "{text}");
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
        # [doc = "Reads the unit.\n\n| gate | kind | type | peers |\n|---|---|---|---|\n| `measurements` | `pub` | `rover.Measurement` | `controller.sensor` |\n\nThe component `sensor` of `t`, declared at `t.yaml:2:11`."] # [allow (dead_code , non_camel_case_types , non_snake_case , private_interfaces)]
        pub struct Sensor {
        # [doc = "`pub`: publishes `rover.Measurement` to `controller.sensor`.\n\nOne reading per period.\n\nDeclared at `t.yaml:5:9`."]
        pub measurements : scl :: private :: Pub < < __scl_types_t_yaml_sensor as scl :: private :: NamedType < 0usize >> :: Type > , __scl : scl :: private :: ComponentHandle }
        # [cfg (test)] # [doc = "The other ends of all gates of `sensor`, for its unit tests."] # [allow (dead_code , non_camel_case_types , non_snake_case , private_interfaces)]
        pub struct SensorPeer {
        # [doc = "The other end of `sensor.measurements`."]
        pub measurements : scl :: private :: Sub < < __scl_types_t_yaml_sensor as scl :: private :: NamedType < 0usize >> :: Type > , __scl : scl :: private :: ComponentHandle }
        # [allow (dead_code , non_camel_case_types , non_snake_case , private_bounds , private_interfaces , clippy :: all , clippy :: pedantic)]
        const _ : () = {
        # [diagnostic :: on_unimplemented (message = "[SCL0606] `{Self}` is used as a message, but the codec `protobuf` does not support it" , label = "gate `sensor.measurements` sends `rover::Measurement`" , note = "derive `prost::Message` for it, or name a `.proto` file in `schemas:`" , note = "the gate is declared here\n --> t.yaml:5:9\n  |\n5 |       - measurements: {{pub: rover.Measurement, doc: One reading per period.}}\n  |         ^^^^^^^^^^^^")] trait RoverMeasurementSupportedByProtobuf_0 < > : :: core :: marker :: Sized {
        fn publisher (__opener : & mut scl :: private :: Opener , __index : usize ,) -> :: core :: result :: Result < scl :: private :: Pub < Self > , scl :: private :: OpenError > ;
        fn subscriber (__opener : & mut scl :: private :: Opener , __index : usize ,) -> :: core :: result :: Result < scl :: private :: Sub < Self > , scl :: private :: OpenError > ;
        }
        # [diagnostic :: do_not_recommend] impl < Message : 'static , > RoverMeasurementSupportedByProtobuf_0 < > for Message where scl :: private :: codecs :: Protobuf : scl :: private :: Codec < Message > , {
        fn publisher (__opener : & mut scl :: private :: Opener , __index : usize ,) -> :: core :: result :: Result < scl :: private :: Pub < Self > , scl :: private :: OpenError > {
        __opener . publisher :: < Message , scl :: private :: codecs :: Protobuf > (__index) }
        fn subscriber (__opener : & mut scl :: private :: Opener , __index : usize ,) -> :: core :: result :: Result < scl :: private :: Sub < Self > , scl :: private :: OpenError > {
        __opener . subscriber :: < Message , scl :: private :: codecs :: Protobuf > (__index) }
        }
        scl :: private :: codecs :: protobuf :: stand_in ! (scl :: private :: codecs :: Protobuf , __scl_type_not_found_t_yaml_sensor) ;
        const _ : () = scl :: private :: codecs :: protobuf :: is_on () ;
        # [diagnostic :: on_unimplemented (message = "[SCL0609] cannot find the Rust type `rover::Measurement`" , label = "used by the gate `sensor.measurements`" , note = "add the crate `rover` to the dependencies, or bring a module `rover` into scope with `use`" , note = "the type is named here\n --> t.yaml:5:29\n  |\n5 |       - measurements: {{pub: rover.Measurement, doc: One reading per period.}}\n  |                             ^^^^^^^^^^^^^^^^^")] trait TypeIsFound_0 {
        }
        # [diagnostic :: do_not_recommend] impl < Type : :: core :: marker :: Unpin > TypeIsFound_0 for (Type ,) {
        }
        impl scl :: private :: Component for Sensor {
        const SPEC : & 'static scl :: private :: ComponentSpec = & scl :: private :: ComponentSpec {
        system : "t" , name : "sensor" , declared_at : "t.yaml:2:11" , parameters : & [] , gates : & [scl :: private :: GateSpec {
        name : "measurements" , kind : scl :: private :: GateKind :: Pub , payload : "rover.Measurement" , codec : "protobuf" , declared_at : "t.yaml:5:9" , endpoint : "" , tap : "sensor.measurements.tap" , contract : "hl75aqsl" , options : scl :: private :: GateOptions {
        .. scl :: private :: GateOptions :: DEFAULT }
        , connections : & [scl :: private :: ConnectionSpec {
        peer_component : "controller" , peer_gate : "sensor" , endpoint : "sensor.measurements--controller.sensor.hl75aqsl" , contract : "hl75aqsl" , required : true , queue : 1u32 , when_full : scl :: private :: WhenFull :: DropOldest , max_size : 67108864u64 , max_age : :: core :: option :: Option :: None , }] , }] , schema : :: core :: option :: Option :: None , }
        ;
        fn assemble (__opener : & mut scl :: private :: Opener) -> :: core :: result :: Result < Self , scl :: private :: OpenError > {
        :: core :: result :: Result :: Ok (Self {
        measurements : RoverMeasurementSupportedByProtobuf_0 :: publisher (__opener , 0usize) ? , __scl : __opener . handle () }) }
        fn gates (& self) -> :: std :: vec :: Vec < & dyn scl :: private :: AnyGate > {
        :: std :: vec :: Vec :: from ([& self . measurements as & dyn scl :: private :: AnyGate]) }
        fn handle (& self) -> & scl :: private :: ComponentHandle {
        & self . __scl }
        }
        scl :: private :: component_methods ! (Sensor where for < '__any > (< __scl_types_t_yaml_sensor as scl :: private :: NamedType < 0usize >> :: Type ,) : TypeIsFound_0) ;
        scl :: private :: component_main_functions ! (Sensor where for < '__any > (< __scl_types_t_yaml_sensor as scl :: private :: NamedType < 0usize >> :: Type ,) : TypeIsFound_0) ;
        # [cfg (test)] impl scl :: private :: Component for SensorPeer {
        const SPEC : & 'static scl :: private :: ComponentSpec = & scl :: private :: ComponentSpec {
        system : "t" , name : "sensor's peers" , declared_at : "" , parameters : & [] , gates : & [scl :: private :: GateSpec {
        name : "measurements" , kind : scl :: private :: GateKind :: Sub , payload : "rover.Measurement" , codec : "protobuf" , declared_at : "t.yaml:5:9" , endpoint : "" , tap : "" , contract : "hl75aqsl" , options : scl :: private :: GateOptions {
        max_size : 18446744073709551615u64 , queue : 4294967295u32 , when_full : scl :: private :: WhenFull :: Wait , backpressure : true , timeout : scl :: private :: Duration :: new (10u64 , 0u32) , in_flight : 64u32 , undecodable : scl :: private :: Undecodable :: Fail , .. scl :: private :: GateOptions :: DEFAULT }
        , connections : & [scl :: private :: ConnectionSpec {
        peer_component : "sensor" , peer_gate : "measurements" , endpoint : "sensor.measurements--controller.sensor.hl75aqsl" , contract : "hl75aqsl" , required : true , queue : 100u32 , when_full : scl :: private :: WhenFull :: DropOldest , max_size : 18446744073709551615u64 , max_age : :: core :: option :: Option :: None , }] , }] , schema : :: core :: option :: Option :: None , }
        ;
        fn assemble (__opener : & mut scl :: private :: Opener) -> :: core :: result :: Result < Self , scl :: private :: OpenError > {
        :: core :: result :: Result :: Ok (Self {
        measurements : RoverMeasurementSupportedByProtobuf_0 :: subscriber (__opener , 0usize) ? , __scl : __opener . handle () }) }
        fn gates (& self) -> :: std :: vec :: Vec < & dyn scl :: private :: AnyGate > {
        :: std :: vec :: Vec :: from ([& self . measurements as & dyn scl :: private :: AnyGate]) }
        fn handle (& self) -> & scl :: private :: ComponentHandle {
        & self . __scl }
        }
        # [cfg (test)] scl :: private :: component_test_methods ! (Sensor , SensorPeer where for < '__any > (< __scl_types_t_yaml_sensor as scl :: private :: NamedType < 0usize >> :: Type ,) : TypeIsFound_0) ;
        }
        ;
        # [doc (hidden)] # [allow (dead_code , non_camel_case_types)]
        pub struct __scl_type_not_found_t_yaml_sensor (scl :: private :: PhantomPinned) ;
        # [doc (hidden)] # [allow (dead_code , non_camel_case_types)] struct __scl_types_t_yaml_sensor ;
        # [allow (dead_code , unused_imports , non_camel_case_types , non_snake_case , clippy :: all , clippy :: pedantic)]
        const _ : () = {
        const _ : () = {
        pub mod rover {
        pub type Measurement = super :: __scl_type_not_found_t_yaml_sensor ;
        }
        const _ : () = {
        use self :: * ;
        macro_rules ! type_of_gate_sensor_measurements {
        () => {
        rover :: Measurement }
        }
        impl scl :: private :: NamedType < 0usize > for __scl_types_t_yaml_sensor {
        type Type = type_of_gate_sensor_measurements ! () ;
        }
        }
        ;
        }
        ;
        }
        ;
    "##]].assert_eq(text);
}

#[test]
fn each_kind_of_gate_is_specified() {
    let yaml = "\
components:
  - name: a
    gates:
      - out: {pub: T}
      - work: {push: T}
      - ask: {req: A -> B, max_size: 1B}
  - name: b
    gates:
      - in: {sub: T, max_size: 2B}
      - jobs: {pull: T, max_size: 3B}
      - answer: {rep: A -> B, max_size: 4B}
connections:
  - [a.out, b.in]
  - [a.work, b.jobs]
  - [a.ask, b.answer]
";
    let text = expand(yaml).to_string();
    let specs: String = text.split("private :: GateSpec {").skip(1).map(described).collect();
    expect![[r#"
        "out" scl::private::GateKind::Pub endpoints "" "a.out--b.in.qud4qwa4" tap "a.out.tap" max_sizes 2u64
        "work" scl::private::GateKind::Push endpoints "" "b.jobs.7zodneik" tap "" max_sizes 3u64
        "ask" "a'speers" scl::private::GateKind::Req endpoints "" "b.answer.yrvcf33f" tap "" max_sizes 1u64 4u64
        "out" scl::private::GateKind::Sub endpoints "" "a.out--b.in.qud4qwa4" tap "" max_sizes 18446744073709551615u64 18446744073709551615u64
        "work" scl::private::GateKind::Pull endpoints "b.jobs.7zodneik" "b.jobs.7zodneik" tap "a.work.peer" max_sizes 18446744073709551615u64 18446744073709551615u64
        "ask" "b" scl::private::GateKind::Rep endpoints "b.answer.yrvcf33f" "b.answer.yrvcf33f" tap "a.ask.peer" max_sizes 18446744073709551615u64 1u64
        "in" scl::private::GateKind::Sub endpoints "" "a.out--b.in.qud4qwa4" tap "" max_sizes 2u64 2u64
        "jobs" scl::private::GateKind::Pull endpoints "b.jobs.7zodneik" "b.jobs.7zodneik" tap "b.jobs.tap" max_sizes 3u64 3u64
        "answer" "b'speers" scl::private::GateKind::Rep endpoints "b.answer.yrvcf33f" "b.answer.yrvcf33f" tap "b.answer.tap" max_sizes 4u64 1u64
        "in" scl::private::GateKind::Pub endpoints "" "a.out--b.in.qud4qwa4" tap "b.in.peer" max_sizes 18446744073709551615u64 2u64
        "jobs" scl::private::GateKind::Push endpoints "" "b.jobs.7zodneik" tap "" max_sizes 18446744073709551615u64 3u64
        "answer" scl::private::GateKind::Req endpoints "" "b.answer.yrvcf33f" tap "" max_sizes 18446744073709551615u64 4u64
    "#]].assert_eq(&specs);
}

/// Sockets and sizes in the specification of a gate and its connections, as one line.
fn described(spec: &str) -> String {
    let values = |key: &str| {
        let key = format!(" {key} : ");
        let values = spec.split(&key).skip(1).filter_map(|rest| rest.split(" ,").next());
        values.map(|value| value.replace(' ', "")).collect::<Vec<_>>().join(" ")
    };
    let [names, kind, endpoints, tap, max_sizes] = ["name", "kind", "endpoint", "tap", "max_size"].map(values);
    format!("{names} {kind} endpoints {endpoints} tap {tap} max_sizes {max_sizes}\n")
}

#[test]
fn a_component_without_gates_is_like_any_other() {
    let tokens = expand("components:\n  - name: sensor\n    gates: []\n");
    assert_eq!(structs(&parsed(&tokens)), ["Sensor "]);
    assert_eq!(structs_if(&parsed(&tokens), is_for_tests), ["SensorPeer "]);
    let text = tokens.to_string();
    assert!(text.contains("Ok (Self { __scl : __opener . handle () })"), "{text}");
    assert!(text.contains("component_test_methods ! (Sensor , SensorPeer)"), "{text}");
}

#[test]
fn unusual_options_are_documented() {
    let yaml = "\
components:
  - name: a
    gates:
      - plain: {sub: T, max_size: 64MiB, unconnected: ok}
      - ask: {req: A -> B, codec: json, max_size: 1536KiB, timeout: 500ms, unconnected: ok}
      - jobs: {pull: T, queue: 7, when_full: drop_newest, max_size: 1 GiB, unconnected: ok}
";
    let text = expand(yaml).to_string();
    let options: Vec<&str> = text.split("Options: ").skip(1).filter_map(|rest| rest.split(".\\n").next()).collect();
    let expected = [
        "`unconnected: ok`",
        "`codec: json`, `max_size: 1536KiB`, `timeout: 500ms`, `unconnected: ok`",
        "`queue: 7`, `when_full: drop_newest`, `max_size: 1GiB`, `unconnected: ok`",
    ];
    assert_eq!(options, expected);
}

/// One item or field per line, so that the text is readable.
fn in_lines(tokens: &TokenStream) -> String {
    let text = tokens.to_string();
    [("{ ", "{\n"), ("; ", ";\n"), ("} ", "}\n"), (", pub ", ",\npub "), ("] pub", "]\npub"), ("] const", "]\nconst")]
        .iter()
        .fold(text, |text, (from, to)| text.replace(from, to))
}
