//! The schema of a gate: six kinds, each with its options.

use super::file::codec_schema;
use super::names::{NAME, Names};
use scl_topology::size;
use scl_topology::topology::{GateKind, GateOptions, WhenFull};
use serde_json::{Map, Value, json};

/// A gate: `name: kind`, or `name: {kind: type, option: value}`.
pub(super) fn gate_schema(names: &Names) -> Value {
    let long = GateKind::ALL.map(|kind| long_schema(kind, names));
    let short = json!({
        "type": "string",
        "enum": GateKind::ALL.map(GateKind::word),
        "enumDescriptions": GateKind::ALL.map(description),
        "description": "The kind of the gate. Its type is taken from the other end, or it carries bytes.",
    });
    json!({
        "type": "object",
        "description": "A gate: `name: kind`, or `name: {kind: type, option: value}`.",
        "propertyNames": { "pattern": NAME },
        "minProperties": 1,
        "maxProperties": 1,
        "additionalProperties": { "anyOf": std::iter::once(short).chain(long).collect::<Vec<_>>() },
    })
}

/// `{sub: rover.Measurement, queue: 1}`.
fn long_schema(kind: GateKind, names: &Names) -> Value {
    let payload = match kind {
        GateKind::Req | GateKind::Rep => names.exchange_schema(description(kind)),
        _ => names.message_schema(description(kind)),
    };
    let mut properties = Map::from_iter([(kind.word().to_owned(), payload)]);
    for (key, schema) in options(kind) {
        properties.insert(key.to_owned(), schema);
    }
    json!({
        "type": "object",
        "title": format!("{} gate", kind.word()),
        "description": description(kind),
        "required": [kind.word()],
        "properties": properties,
        "additionalProperties": false,
    })
}

fn description(kind: GateKind) -> &'static str {
    match kind {
        GateKind::Pub => {
            "Sends messages to any number of subscribers. Value: the type, for example `rover.Measurement`."
        }
        GateKind::Sub => "Receives from one or several publishers. Value: the type, for example `rover.Measurement`.",
        GateKind::Req => "Asks one replier. Value: request and reply, for example `rover.Command -> rover.Status`.",
        GateKind::Rep => {
            "Answers any number of requesters. Value: request and reply, for example `rover.Command -> rover.Status`."
        }
        GateKind::Push => "Hands work to a puller. Value: the type, for example `rover.Job`.",
        GateKind::Pull => "Takes work from any number of pushers. Value: the type, for example `rover.Job`.",
    }
}

fn options(kind: GateKind) -> Vec<(&'static str, Value)> {
    let mut options = vec![
        ("doc", json!({ "type": "string", "description": "One paragraph for the generated documentation." })),
        ("codec", codec_schema("How messages become bytes. Default: the codec of the file.")),
        ("unconnected", words(&["ok"], "`ok`: this gate is meant to have no peer, so nothing warns.")),
    ];
    if !matches!(kind, GateKind::Pub | GateKind::Push) {
        options.push(("max_size", size_schema()));
    }
    match kind {
        GateKind::Sub | GateKind::Pull => options.extend(queue_options()),
        GateKind::Pub => options.push(("backpressure", backpressure())),
        GateKind::Push => options.extend([
            ("backpressure", backpressure()),
            ("share", switch("Several pullers share the work, each message goes to one of them.")),
        ]),
        GateKind::Req => options.push((
            "timeout",
            json!({
                "type": "string", "pattern": "^[0-9]+(\\.[0-9]+)? *(us|ms|s)$", "default": "1s",
                "description": "How long a call may take: a number and a unit (`us`, `ms`, `s`), at most a day.",
            }),
        )),
        GateKind::Rep => {}
    }
    options
}

fn queue_options() -> [(&'static str, Value); 2] {
    [
        (
            "queue",
            json!({
                "type": "integer", "minimum": 1, "maximum": 1_000_000, "default": 100,
                "description": "How many messages may wait for this gate; 1 means: only the newest.",
            }),
        ),
        (
            "when_full",
            words(
                &WhenFull::WORDS,
                "What a full queue does; `wait` needs `backpressure: true` at the sender. Default: `drop_oldest`.",
            ),
        ),
    ]
}

fn size_schema() -> Value {
    let units = size::UNITS.map(|(unit, _)| unit).join("|");
    let largest = size::text(GateOptions::LARGEST_MAX_SIZE);
    json!({
        "type": "string",
        "pattern": format!("^[0-9]+ *({units})$"),
        "default": size::text(GateOptions::default().max_size),
        "description": format!(
            "The longest message that this gate accepts: a whole number and a unit ({}), at most {largest}.",
            size::UNITS.map(|(unit, _)| format!("`{unit}`")).join(", ")
        ),
    })
}

fn backpressure() -> Value {
    switch("Allows a peer with `when_full: wait` to make this gate wait.")
}

fn switch(description: &str) -> Value {
    json!({ "type": "boolean", "default": false, "description": description })
}

fn words(words: &[&str], description: &str) -> Value {
    json!({ "type": "string", "enum": words, "description": description })
}
