//! The sections of a topology file and the keys of a component.

use super::shape::{Item, Shape};

/// A section of the file, or a key of a component.
#[derive(Debug, PartialEq, Eq)]
pub struct Key {
    /// As in the file.
    pub key: &'static str,
    /// What its value looks like.
    pub shape: Shape,
    /// What holds without it, as text; empty if it is required.
    pub default: &'static str,
    /// What it says, in one sentence.
    pub summary: &'static str,
    /// The rest of what there is to know, as Markdown; may be empty.
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

/// What the keys start with that belong to the users; they are ignored.
pub const OWN_PREFIX: &str = "x-";

/// The sections, in the order in which messages list them.
pub static SECTIONS: [Key; 7] = [
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
        text: "The order of the two ends is free: their kinds say which one sends.",
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
        key: "system",
        shape: Shape::Name,
        default: "the file's name without its ending",
        summary: "The name of the system.",
        text: "It names the folder in which the system's sockets live. Two systems of one name on one machine meet \
               there; `$SCL_SYSTEM` overrides it when a program starts.",
        example: "system: rover\n",
    },
    Key {
        key: "schemas",
        shape: Shape::List(Item::File),
        default: "none",
        summary: "Protobuf files beside this one, from which the macro generates Rust types.",
        text: "A gate names their messages with their package: `rover.Measurement`.",
        example: "schemas: [rover.proto]\n",
    },
    Key {
        key: "schema_roots",
        shape: Shape::List(Item::Folder),
        default: "this folder, and those of the `schemas`",
        summary: "The folders in which the `import` statements of the `schemas` begin, as protoc's `-I`.",
        text: "Paths from this file's folder, `.` for itself. Each of the `schemas` must be in one of them. See \
               [imports](messages.md#imports).",
        example: "schemas: [proto/nav/fix.proto]\nschema_roots: [proto]\n",
    },
    Key {
        key: "codec",
        shape: Shape::Codec,
        default: "`protobuf`",
        summary: "The codec of typed gates that name none.",
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

/// The keys of a component, in the order in which messages list them.
pub static COMPONENT_KEYS: [Key; 4] = [
    Key {
        key: "name",
        shape: Shape::Name,
        default: "",
        summary: "The name, in snake_case: `user_interface` becomes the Rust type `UserInterface`.",
        text: "Names consist of ASCII letters, digits, `_` and `-`, and start with a letter or `_`. The same holds for \
               gates.",
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
        text: "Editors show it when the cursor is on the component's Rust type.",
        example: "components:\n  - name: sensor\n    doc: Reads the inertial unit at 100 Hz.\n    gates: []\n",
    },
    Key {
        key: "optional",
        shape: Shape::Boolean,
        default: "`false`",
        summary: "Peers do not wait for this component when they start.",
        text: "Without it, `ready` in a peer waits until this component runs.",
        example: "components:\n  - name: recorder\n    optional: true\n    gates: []\n",
    },
];

/// The section with this key.
pub fn section(key: &str) -> Option<&'static Key> {
    SECTIONS.iter().find(|section| section.key == key)
}

/// The keys alone.
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
