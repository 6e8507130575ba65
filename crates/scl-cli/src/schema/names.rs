//! The names of one file, as values that editors offer.

use scl_topology::model::Model;
use serde_json::{Value, json};
use std::collections::HashMap;

/// A word of letters, digits, `_` and single `-`.
pub(super) const NAME: &str = "^[A-Za-z_](-?[A-Za-z0-9_])*-?$";

/// A name, perhaps with those of groups before it: `left_arm.planner`.
pub(super) const FULL_NAME: &str = "^[A-Za-z_](-?[A-Za-z0-9_])*-?(\\.[A-Za-z_](-?[A-Za-z0-9_])*-?)*$";

/// `component.gate`.
pub(super) const PATH: &str = "^[A-Za-z_](-?[A-Za-z0-9_])*-?(\\.[A-Za-z_](-?[A-Za-z0-9_])*-?)+$";

/// A word of a dotted type.
const WORD: &str = "([A-Za-z][A-Za-z0-9_]*|_[A-Za-z0-9_]+)";

/// The names that editors offer; empty for a schema that belongs to no file.
#[derive(Debug, Default)]
pub(super) struct Names {
    /// `component.gate` and `each kind.gate`, with the kind of the gate and its type.
    ends: Vec<(String, String)>,
    kinds: Vec<String>,
    messages: Vec<String>,
    exchanges: Vec<String>,
}

impl Names {
    /// The names of a file as it is written; it may have errors.
    pub(super) fn of(model: &Model) -> Self {
        // What is in groups cannot be named from outside.
        let own_kinds = || model.kinds.iter().filter(|kind| kind.group == 0);
        let kinds = own_kinds().map(|kind| kind.name.value.clone()).collect();
        let mut names = Self { kinds, ..Self::default() };
        let exports = exports(model);
        let kinds = own_kinds().map(|kind| (format!("each {}", kind.name.value), kind));
        let components = model.components.iter().map(|component| (component.name.value.clone(), component));
        for (owner, entry) in kinds.chain(components) {
            for gate in &entry.gates {
                let payload = gate.payload.as_ref().map_or("", |payload| payload.value.as_str());
                let words = format!("{} {payload}", gate.kind.value).trim().to_owned();
                let end = format!("{owner}.{}", gate.name.value);
                let end = if entry.group == 0 { Some(end) } else { exports.get(&*end).cloned() };
                names.ends.extend(end.map(|end| (end, words)));
                let types = if payload.contains("->") { &mut names.exchanges } else { &mut names.messages };
                if !payload.is_empty() && !types.iter().any(|known| known == payload) {
                    types.push(payload.to_owned());
                }
            }
        }
        names
    }

    /// One end of a connection.
    pub(super) fn end_schema(&self) -> Value {
        let (names, words): (Vec<_>, Vec<_>) = self.ends.iter().map(|(name, words)| (name, words)).unzip();
        let known = json!({ "type": "string", "enum": names, "enumDescriptions": words });
        offered(
            known,
            self.ends.is_empty(),
            &json!({ "type": "string", "pattern": PATH.replacen('^', "^(each\\s+)?", 1) }),
            "One end of a connection: `component.gate` or `each kind.gate`.",
        )
    }

    /// The kind of a component.
    pub(super) fn kind_schema(&self) -> Value {
        let known = json!({ "type": "string", "enum": self.kinds });
        offered(known, self.kinds.is_empty(), &json!({ "type": "string", "pattern": FULL_NAME }), "One of the `kinds`.")
    }

    /// The type of `pub`, `sub`, `push` and `pull`.
    pub(super) fn message_schema(&self, description: &str) -> Value {
        offered_types(&self.messages, &dotted(), description)
    }

    /// The types of `req` and `rep`.
    pub(super) fn exchange_schema(&self, description: &str) -> Value {
        offered_types(&self.exchanges, &format!("{}\\s*->\\s*{}", dotted(), dotted()), description)
    }
}

/// What the groups of the file export: by the gates, their names for the outside.
fn exports(model: &Model) -> HashMap<&str, String> {
    let outermost = model.groups.iter().skip(1).filter(|group| group.parent == 0);
    let exports = outermost.flat_map(|group| {
        let name = |name: &str| format!("{}.{name}", group.name);
        group.exports.iter().map(move |export| (export.gate.value.as_str(), name(&export.name.value)))
    });
    exports.collect()
}

/// The pattern of a dotted type.
fn dotted() -> String {
    format!("{WORD}(\\.{WORD})*")
}

/// A type of this pattern, or nothing, as in `{pub: , queue: 1}`.
fn offered_types(known: &[String], pattern: &str, description: &str) -> Value {
    let any = json!({ "type": ["string", "null"], "pattern": format!("^\\s*{pattern}\\s*$") });
    offered(json!({ "type": "string", "enum": known }), known.is_empty(), &any, description)
}

/// Returns the schema of a value of the shape `any`. Editors offer the known values, but others are just as valid.
fn offered(known: Value, none: bool, any: &Value, description: &str) -> Value {
    let mut schema = if none { any.clone() } else { json!({ "anyOf": [known, any] }) };
    schema["description"] = json!(description);
    schema
}
