//! The sections of a topology file and the keys of a component.

use super::parameter::PARAMETERS;
use super::shape::{self, Item, OutOfRange, Shape};

/// A section of the file, or a key of a component.
#[derive(Debug, PartialEq, Eq)]
pub struct Key {
    /// The key as written in the file.
    pub key: &'static str,
    /// What its value looks like.
    pub shape: Shape,
    /// The default, in words; empty if the key is required.
    pub default: &'static str,
    /// What the key means, in one sentence.
    pub summary: &'static str,
    /// The rest of its documentation, as Markdown; may be empty.
    pub text: &'static str,
    /// Lines of a topology file that show it.
    pub example: &'static str,
}

impl Key {
    /// Whether a file or component without it is an error.
    pub fn is_required(&self) -> bool {
        self.default.is_empty()
    }
}

/// The only version of the format so far.
pub const FORMAT: u32 = 1;

/// Prefix of the keys that belong to users and are ignored.
pub const OWN_PREFIX: &str = "x-";

/// The sections, in the order in which messages list them.
pub static SECTIONS: [Key; 11] = [
    Key {
        key: "components",
        shape: Shape::List(Item::Component),
        default: "",
        summary: "The components, each with its gates.",
        text: "A component is one program, or a part of one. At least one is needed.",
        example: "components:\n  - name: sensor\n    gates:\n      - measurements: pub\n",
    },
    Key {
        key: "connections",
        shape: Shape::List(Item::Connection),
        default: "none",
        summary: "Which gates are connected: pairs `[component.gate, component.gate]`.",
        text: "The two ends may be in either order: their kinds say which one sends.",
        example: "components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
",
    },
    Key {
        key: "kinds",
        shape: Shape::List(Item::Kind),
        default: "none",
        summary: "The kinds of components that exist several times, each with its gates.",
        text: "A component with `kind: motor` has the gates of the kind `motor`. See [kinds](#kinds).",
        example: "kinds:
  - name: motor
    gates:
      - state: {pub: rover.MotorState}
components:
  - {name: left_motor, kind: motor}
  - {name: right_motor, kind: motor}
  - name: controller
    gates:
      - motors: {sub: rover.MotorState}
connections:
  - [each motor.state, controller.motors]
",
    },
    Key {
        key: EVERYONE,
        shape: Shape::List(Item::SharedGate),
        default: "none",
        summary: "Gates that every component has, each connected to the same gate: a log, for example.",
        text: "`to` names that other gate, whose component does not get one. See [everyone](#everyone).",
        example: "components:
  - name: sensor
    gates: []
  - name: logger
    gates:
      - records: {pull: rover.Record}
everyone:
  - log: {push: rover.Record, to: logger.records}
",
    },
    Key {
        key: INCLUDE,
        shape: Shape::List(Item::Topology),
        default: "none",
        summary: "Other topology files, whose components, kinds and connections belong to the same system.",
        text: "Paths are relative to the folder of the file that contains them. With `as`, a file becomes a group. See \
               [several files](#several-files) and [groups](#groups).",
        example: "include:\n  - sensors.yaml\n  - {file: arm.yaml, as: left_arm}\n",
    },
    Key {
        key: EXPORTS,
        shape: Shape::List(Item::Export),
        default: "none",
        summary: "The gates that can be connected from outside if the file is a group, each with its name there.",
        text: "See [groups](#groups).",
        example: "components:
  - name: planner
    gates:
      - command: {sub: rover.Command}
exports: {command: planner.command}
",
    },
    Key {
        key: "system",
        shape: Shape::Name,
        default: "the file's name without its extension",
        summary: "The name of the system.",
        text: "It names the folder in which the system's sockets live. Two systems with the same name on one machine \
               share that folder; `$SCL_SYSTEM` overrides the name when a program starts.",
        example: "system: rover\n",
    },
    Key {
        key: "schemas",
        shape: Shape::List(Item::File),
        default: "none",
        summary: "Protobuf files beside this one, from which the macro generates Rust types.",
        text: "A gate names one of their messages with its package: `rover.Measurement`.",
        example: "schemas: [rover.proto]\n",
    },
    Key {
        key: "schema_roots",
        shape: Shape::List(Item::Folder),
        default: "this folder, and those of the `schemas`",
        summary: "The folders in which `import` statements of the `schemas` are looked up, like protoc's `-I`.",
        text: "Paths are relative to this file's folder, which is `.`. Each of the `schemas` must be in one of the \
               folders. See [imports](messages.md#imports).",
        example: "schemas: [proto/nav/fix.proto]\nschema_roots: [proto]\n",
    },
    Key {
        key: "codec",
        shape: Shape::Codec,
        default: "`protobuf`",
        summary: "The codec of gates that have a type but name no codec.",
        text: "A gate without a type carries bytes as they are. See [codecs](#codecs).",
        example: "codec: json\n",
    },
    Key {
        key: "scl",
        shape: Shape::Number { least: FORMAT, most: FORMAT },
        default: "`1`",
        summary: "The version of the file's format.",
        text: "There is one version so far.",
        example: "scl: 1\n",
    },
];

/// The section that names other files of the same system.
pub const INCLUDE: &str = "include";

/// The keys of an entry of `include`: the file, and the name of the group that it becomes.
pub const INCLUDE_KEYS: [&str; 2] = ["file", "as"];

/// The section of the gates of a group that can be connected from outside.
pub const EXPORTS: &str = "exports";

/// The section of the gates that every component has.
pub const EVERYONE: &str = "everyone";

/// The keys of a gate in the section `everyone`, beside its options: the gate at the other end, and the components that
/// do not get one.
pub const SHARED_GATE_KEYS: [&str; 2] = ["to", "except"];

/// The key that gives a component the gates of a kind.
pub const KIND: &str = "kind";

/// The key that bounds what the gates of a component may hold.
pub const MEMORY: &str = "memory";

/// The largest bound, in bytes: 1024 GiB.
const LARGEST_MEMORY: u64 = 1 << 40;

/// What the value of [`MEMORY`] looks like.
pub const MEMORY_SHAPE: Shape = Shape::Size { most: LARGEST_MEMORY };

/// The keys of a component, in the order in which messages list them. A kind has all but the last.
pub static COMPONENT_KEYS: [Key; 7] = [
    Key {
        key: "name",
        shape: Shape::Name,
        default: "",
        summary: "The name, in snake_case: `user_interface` becomes the Rust type `UserInterface`.",
        text: "Names consist of ASCII letters, digits, `_` and `-`, and start with a letter or `_`. The same holds for \
               gates. The name of a component may begin with that of a group: `left_arm.planner`. See \
               [groups](#groups).",
        example: "components:\n  - name: user_interface\n    gates: []\n",
    },
    Key {
        key: "gates",
        shape: Shape::List(Item::Gate),
        default: "none",
        summary: "The gates, each a field of the component's Rust type.",
        text: "A component without gates is a warning. See [gates](#gates).",
        example: "components:
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement, queue: 1}
      - actuator: pub
",
    },
    Key {
        key: "doc",
        shape: Shape::Text,
        default: "none",
        summary: "A paragraph for the generated documentation.",
        text: "Editors show it when the cursor is on the component's Rust type. At a kind, it holds for those of its \
               components that have none.",
        example: "components:\n  - name: sensor\n    doc: Reads the inertial unit at 100 Hz.\n    gates: []\n",
    },
    Key {
        key: "optional",
        shape: Shape::Boolean,
        default: "`false`",
        summary: "Peers do not wait for this component when they start.",
        text: "Without it, `ready` in a peer waits until this component runs. At a kind, it holds for those of its \
               components that do not say otherwise.",
        example: "components:\n  - name: recorder\n    optional: true\n    gates: []\n",
    },
    Key {
        key: MEMORY,
        shape: MEMORY_SHAPE,
        default: "no bound",
        summary: "The most memory that messages may take in the component's gates; more is an error.",
        text: "`scl plan --memory` prints what they may take. At a kind, it holds for each of its components that has no \
               bound of its own. See [memory](#memory).",
        example: "components:
  - name: camera
    memory: 64MiB
    gates:
      - frames: {pub: rover.Image}
  - name: detector
    gates:
      - frames: {sub: rover.Image, queue: 10, max_size: 4MiB}
connections:
  - [camera.frames, detector.frames]
",
    },
    Key {
        key: PARAMETERS,
        shape: Shape::List(Item::Parameter),
        default: "none",
        summary: "The parameters: values that are set when the program starts, each a field in the program.",
        text: "The launch file, `scl run --set` or the environment gives their values. See [parameters](#parameters).",
        example: "components:
  - name: controller
    parameters:
      - gain: {f64: 0.8, range: [0, 10], unit: 1/s, doc: Proportional gain.}
      - period: {duration: 10ms}
      - mode: {one_of: [manual, auto], default: manual}
      - offsets: {list: f64, length: 3, default: [0, 0, 0]}
      - pin: u8
    gates: []
",
    },
    Key {
        key: KIND,
        shape: Shape::Name,
        default: "none",
        summary: "The kind that the component is of: its gates are those of the kind.",
        text: "Such a component has no `gates` of its own. See [kinds](#kinds).",
        example: "kinds:
  - name: motor
    gates:
      - setpoint: sub
components:
  - {name: left_motor, kind: motor}
  - {name: right_motor, kind: motor}
",
    },
];

/// Reads the value of [`MEMORY`], in bytes.
///
/// # Errors
///
/// The value is out of its range.
pub fn memory(text: &str) -> Result<u64, OutOfRange> {
    shape::size(text, LARGEST_MEMORY).map_err(|range| OutOfRange { reason: None, ..range })
}

/// The section with this key.
pub fn section(key: &str) -> Option<&'static Key> {
    SECTIONS.iter().find(|section| section.key == key)
}

/// The keys without their documentation.
pub const fn words<const N: usize>(keys: &[Key; N]) -> [&'static str; N] {
    let mut words = [""; N];
    let mut at = 0;
    while at < N {
        words[at] = keys[at].key;
        at += 1;
    }
    words
}

#[cfg(test)]
mod tests {
    use super::section;
    use crate::grammar::Codec;

    #[test]
    fn the_default_codec_is_told_once() {
        assert_eq!(section("codec").map(|key| key.default), Some(format!("`{}`", Codec::DEFAULT.word()).as_str()));
    }
}
