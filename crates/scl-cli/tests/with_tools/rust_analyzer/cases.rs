//! Programs with a place `$0` at which something is typed, and what is offered there.

/// A program with its topology, and what must be offered: name, part of the detail, part of the documentation.
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) topology: &'static str,
    pub(super) program: &'static str,
    pub(super) offered: &'static [(&'static str, &'static str, &'static str)],
}

pub(super) const ROVER: &str = "\
schemas: [rover.proto]
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement}
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement}
      - setpoint: {pub: rover.Measurement, unconnected: ok, doc: Where to go.}
      - commands: {req: rover.Command -> Status}
      - log: {push: }
  - name: operator
    gates:
      - commands: rep
      - log: pull
connections:
  - [sensor.measurements, controller.sensor]
  - [controller.commands, operator.commands]
  - [controller.log, operator.log]
";

const BROKEN_CONNECTION: &str = "\
schemas: [rover.proto]
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement}
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement}
      - setpoint: {pubb: rover.Measurement}
connections:
  - [sensor.measurements, controller.sensr]
  - [sensor.measurements, controller.sensor]
";

/// Half of a file, as it is while somebody types.
const CUT_OFF: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: {sub: rover.Meas
";

const NO_SCHEMA: &str = "\
schemas: [missing.proto]
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement}
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
";

const RUST_TYPES: &str = "\
components:
  - name: sensor
    gates:
      - measurements: {pub: messages.Measurement, codec: json}
  - name: controller
    gates:
      - sensor: sub
      - plans: {pub: messages.NotWrittenYet, codec: json, unconnected: ok}
connections:
  - [sensor.measurements, controller.sensor]
";

const GATES: &[(&str, &str, &str)] = &[
    ("sensor", "Sub<Measurement>", "`sub`: subscribes to `rover.Measurement` from `sensor.measurements`."),
    ("setpoint", "Pub<Measurement>", "Where to go."),
    ("commands", "Req<Command, Status>", "`req`: requests `rover.Command` -> `Status` from `operator.commands`."),
    ("log", "Push<Bytes>", "`push`: pushes bytes to `operator.log`."),
];

/// A case with the topology above.
macro_rules! rover {
    ($name:ident, $offered:expr, $program:expr) => {
        Case {
            name: stringify!($name),
            topology: ROVER,
            program: concat!("scl::topology!(\"", stringify!($name), ".yaml\");\n\n", $program),
            offered: $offered,
        }
    };
}

pub(super) const CASES: [Case; 23] = [
    rover!(
        main_async,
        GATES,
        "#[scl::main]\nasync fn main(mut controller: Controller) -> scl::Result<()> {\n    controller.$0;\n    let _ = 1;\n    Ok(())\n}\n"
    ),
    rover!(
        main_blocking,
        GATES,
        "#[scl::main]\nfn main(mut controller: Controller) -> scl::Result<()> {\n    controller.$0\n}\n"
    ),
    rover!(
        outside_of_main,
        GATES,
        "#[scl::main]\nasync fn main(controller: Controller) {\n    steer(controller).await;\n}\n\nasync fn steer(mut c: Controller) {\n    c.$0\n}\n"
    ),
    rover!(
        behind_a_reference,
        GATES,
        "#[scl::main]\nfn main(mut controller: Controller) {\n    steer(&mut controller);\n}\n\nfn steer(c: &mut Controller) {\n    c.$0;\n}\n"
    ),
    rover!(
        half_a_name,
        GATES,
        "#[scl::main]\nasync fn main(mut controller: Controller) -> scl::Result<()> {\n    controller.s$0\n    Ok(())\n}\n"
    ),
    rover!(
        in_nested_closures,
        GATES,
        "#[scl::main]\nasync fn main(mut controller: Controller) -> scl::Result<()> {\n    let mut run = || {\n        let mut again = move || { controller.$0 };\n        again();\n    };\n    run();\n    Ok(())\n}\n"
    ),
    rover!(
        in_select,
        GATES,
        "#[scl::main]\nasync fn main(mut controller: Controller) -> scl::Result<()> {\n    loop {\n        tokio::select! {\n            read = controller.s$0 => drop(read),\n            _ = scl::stop_requested() => return Ok(()),\n        }\n    }\n}\n"
    ),
    rover!(
        in_a_body_of_wrong_types,
        GATES,
        "#[scl::main]\nasync fn main(mut controller: Controller) -> scl::Result<()> {\n    let number: u32 = \"text\";\n    missing(number, controller.$0\n}\n"
    ),
    rover!(
        behind_unfinished_code,
        GATES,
        "#[scl::main]\nasync fn main(mut controller: Controller) -> scl::Result<()> {\n    let reading = if number > { controller.$0\n    for it in\n}\n"
    ),
    rover!(
        in_a_helper_of_main,
        GATES,
        "#[scl::main]\nfn main(controller: Controller) {\n    struct Holder { inner: Controller }\n    fn steer(holder: &mut Holder) {\n        holder.inner.$0\n    }\n    steer(&mut Holder { inner: controller });\n}\n"
    ),
    rover!(
        in_a_pattern,
        &[("sensor", "", ""), ("log", "", "")],
        "#[scl::main]\nasync fn main(controller: Controller) {\n    let Controller { $0 } = controller;\n}\n"
    ),
    rover!(of_an_alias, GATES, "type Me = Controller;\n\n#[scl::main]\nasync fn main(mut me: Me) {\n    me.$0\n}\n"),
    rover!(
        in_an_unknown_main,
        GATES,
        "#[scl::main]\nasync fn main(mut radar: Radar) {\n    let helper = |c: Controller| { c.$0 };\n}\n"
    ),
    rover!(
        in_a_test,
        &[("sensor", "Pub<Measurement>", "The other end of `controller.sensor`.")],
        "fn main() {}\n\n#[cfg(test)]\nmod tests {\n    use super::*;\n\n    async fn steers() {\n        let (controller, mut peer): (Controller, ControllerPeer) = Controller::test().await.unwrap();\n        peer.$0\n    }\n}\n"
    ),
    rover!(
        functions,
        &[
            ("open", "async fn() -> Result<Controller, OpenError>", ""),
            ("open_blocking", "", "Opens the component for a program without async")
        ],
        "fn main() {\n    Controller::$0\n}\n"
    ),
    rover!(
        methods,
        &[("recv", "async fn", "Waits for the next message.")],
        "#[scl::main]\nasync fn main(mut controller: Controller) {\n    controller.sensor.$0\n}\n"
    ),
    rover!(messages, &[("Measurement", "", "")], "fn main() {\n    rover::$0\n}\n"),
    rover!(messages_without_package, &[("Status", "", "")], "fn main() {\n    Sta$0\n}\n"),
    rover!(names_in_scope, &[("Controller", "", "`req`"), ("Status", "", "")], "fn main() {\n    $0\n}\n"),
    rover!(names_of_scl, &[("Sub", "Sub<T>", "")], "fn main() {\n    scl::$0\n}\n"),
    Case {
        name: "in_a_module",
        topology: ROVER,
        program: "mod nav {\n    scl::topology!(\"in_a_module.yaml\");\n}\n\n#[scl::main]\nasync fn main(mut controller: nav::Controller) {\n    controller.$0\n}\n",
        offered: GATES,
    },
    Case {
        name: "renamed_dependency",
        topology: ROVER,
        program: "wires::topology!(\"renamed_dependency.yaml\");\n\n#[wires::main]\nasync fn main(mut controller: Controller) {\n    controller.$0\n}\n",
        offered: GATES,
    },
    Case {
        name: "rust_types",
        topology: RUST_TYPES,
        program: "scl::topology!(\"rust_types.yaml\");\n\nmod messages {\n    pub struct Measurement;\n}\n\n#[scl::main]\nasync fn main(mut controller: Controller) {\n    controller.$0\n}\n",
        offered: &[
            ("sensor", "Sub<Measurement>", "from `sensor.measurements`."),
            ("plans", "Pub<", "`pub`: publishes `messages.NotWrittenYet` to no peer."),
        ],
    },
];

pub(super) const BROKEN: [Case; 4] = [
    Case {
        name: "broken_connection",
        topology: BROKEN_CONNECTION,
        program: "scl::topology!(\"broken_connection.yaml\");\n\n#[scl::main]\nasync fn main(mut controller: Controller) -> scl::Result<()> {\n    controller.$0;\n    Ok(())\n}\n",
        offered: &[
            ("sensor", "Sub<Measurement>", "`sub`: subscribes to `rover.Measurement` from `sensor.measurements`."),
            ("setpoint", "", "`pubb`: `rover.Measurement`; connected to no peer."),
        ],
    },
    Case {
        name: "broken_outside_of_main",
        topology: BROKEN_CONNECTION,
        program: "scl::topology!(\"broken_outside_of_main.yaml\");\n\n#[scl::main]\nfn main(mut controller: Controller) {\n    steer(&mut controller);\n}\n\nfn steer(controller: &mut Controller) {\n    controller.$0;\n}\n",
        offered: &[("sensor", "Sub<Measurement>", "from `sensor.measurements`.")],
    },
    Case {
        name: "cut_off",
        topology: CUT_OFF,
        program: "scl::topology!(\"cut_off.yaml\");\n\n#[scl::main]\nasync fn main(mut controller: Controller) {\n    controller.$0;\n}\n",
        offered: &[("sensor", "Sub<", "Declared at `cut_off.yaml:7:9`.")],
    },
    Case {
        name: "no_schema",
        topology: NO_SCHEMA,
        program: "scl::topology!(\"no_schema.yaml\");\n\n#[scl::main]\nasync fn main(mut controller: Controller) {\n    controller.$0;\n}\n",
        offered: &[("sensor", "Sub<", "subscribes to `rover.Measurement` from `sensor.measurements`.")],
    },
];

/// A program whose topology the test changes.
pub(super) const CHANGED: Case =
    rover!(changed, &[], "#[scl::main]\nasync fn main(mut controller: Controller) {\n    controller.$0;\n}\n");

pub(super) fn all() -> impl Iterator<Item = &'static Case> {
    CASES.iter().chain(&BROKEN).chain([&CHANGED])
}

pub(super) fn program(name: &str) -> &'static str {
    all().find(|case| case.name == name).unwrap().program
}
