//! The documentation of generated items, which editors show on hover.

use super::context::Context;
use scl_text::list::listed;
use scl_topology::grammar::OPTIONS;
use scl_topology::model::{ComponentModel, GateModel};
use scl_topology::source::Span;
use scl_topology::topology::{Codec, ComponentType, Gate, GateId, GateKind, Payload, Topology};

/// What the documentation says about a gate.
pub(super) struct GateDoc {
    name: String,
    /// The word in the file.
    kind: String,
    /// `bytes`, `rover.Measurement` or `rover.Command -> rover.Status`.
    payload: String,
    /// Paths such as `controller.sensor`.
    peers: Vec<String>,
    words: Option<String>,
    /// The options that differ from their defaults, as in the file.
    options: Vec<String>,
    location: String,
}

impl GateDoc {
    /// Describes a gate of a file without errors.
    pub(super) fn new(context: &Context<'_>, topology: &Topology, id: GateId) -> Self {
        let gate = topology.gate(id);
        Self {
            name: gate.name().to_owned(),
            kind: gate.kind().word().to_owned(),
            payload: gate.payload().to_string(),
            peers: topology.peers_of_type(id).into_iter().map(|peer| topology.gate_path(peer)).collect(),
            words: gate.doc().map(str::to_owned),
            options: options(gate),
            location: context.location(gate.span()),
        }
    }

    /// Describes a gate as it is written in a file with errors.
    pub(super) fn unchecked(
        context: &Context<'_>,
        gate: &GateModel,
        payload: Option<&str>,
        peers: Vec<String>,
    ) -> Self {
        let option = |key| gate.options.iter().find(|option| option.key.value == key);
        let shown = gate.options.iter().filter(|option| option.key.value != "doc");
        Self {
            name: gate.name.value.clone(),
            kind: gate.kind.value.clone(),
            payload: payload.unwrap_or("bytes").to_owned(),
            peers,
            words: option("doc").map(|doc| doc.value.value.clone()),
            options: shown.map(|option| format!("`{}: {}`", option.key.value, option.value.value)).collect(),
            location: context.location(gate.name.span),
        }
    }

    /// The documentation of a field: kind, type, peers, the gate's `doc`, unusual options, and where it is declared.
    pub(super) fn text(&self) -> String {
        let message = match self.payload.split_once(" -> ") {
            Some((request, reply)) => format!("`{request}` -> `{reply}`"),
            None if self.payload == "bytes" => self.payload.clone(),
            None => format!("`{}`", self.payload),
        };
        let mut doc = match GateKind::of(&self.kind) {
            Some(kind) => format!("`{}`: {}.", self.kind, kind.sentence(&message, &self.peers())),
            None => format!("`{}`: {message}; connected to {}.", self.kind, self.peers()),
        };
        if let Some(words) = &self.words {
            doc.push_str(&format!("\n\n{words}"));
        }
        if !self.options.is_empty() {
            doc.push_str(&format!("\n\nOptions: {}.", self.options.join(", ")));
        }
        format!("{doc}\n\nDeclared at `{}`.", self.location)
    }

    fn peers(&self) -> String {
        if self.peers.is_empty() { "no peer".to_owned() } else { listed(&self.peers) }
    }
}

/// The documentation of a struct: the component's `doc`, its gates as a table, and where it is declared.
pub(super) fn of_component(context: &Context<'_>, topology: &Topology, component: ComponentType<'_>) -> String {
    let gates = component.component.gates().iter().map(|&id| GateDoc::new(context, topology, id));
    let gates: Vec<GateDoc> = gates.collect();
    let (name, system) = (component.name(), topology.system());
    let what = match component.kind {
        None => format!("The component `{name}` of `{system}`"),
        Some(kind) => {
            let names = kind.components().iter().map(|id| topology.component(*id).name());
            format!("A component of the kind `{name}` of `{system}`: {}", listed(names))
        }
    };
    let location = context.location(component.span());
    format!("{}\n{what}, declared at `{location}`.", summary(component.doc(), &gates))
}

/// The documentation of a component of a kind.
pub(super) fn of_instance(context: &Context<'_>, name: &str, doc: Option<&str>, span: Span) -> String {
    let doc = doc.map(|doc| format!("{doc}\n\n")).unwrap_or_default();
    format!("{doc}The component `{name}`, declared at `{}`.", context.location(span))
}

/// The documentation of a struct from a file with errors.
pub(super) fn of_unchecked_component(context: &Context<'_>, component: &ComponentModel, gates: &[GateDoc]) -> String {
    let doc = component.doc.as_ref().map(|doc| doc.value.as_str());
    let (name, location) = (&component.name.value, context.location(component.name.span));
    format!("{}\nThe component `{name}`, declared at `{location}`.", summary(doc, gates))
}

/// The documentation of the struct of a component's counterpart.
pub(super) fn of_counterpart(component: &str) -> String {
    format!("The other ends of all gates of `{component}`, for its unit tests.")
}

/// The documentation of a gate of the counterpart.
pub(super) fn of_other_end(gate: &str) -> String {
    format!("The other end of `{gate}`.")
}

fn summary(doc: Option<&str>, gates: &[GateDoc]) -> String {
    let mut text = doc.map(|doc| format!("{doc}\n\n")).unwrap_or_default();
    if gates.is_empty() {
        text.push_str("It has no gates.\n");
    } else {
        text.push_str("| gate | kind | type | peers |\n|---|---|---|---|\n");
    }
    for gate in gates {
        let GateDoc { name, kind, payload, .. } = gate;
        text.push_str(&format!("| `{name}` | `{kind}` | `{payload}` | {} |\n", gate.peers()));
    }
    text
}

fn options(gate: &Gate) -> Vec<String> {
    let default_codec = if *gate.payload() == Payload::Bytes { Codec::RAW } else { Codec::DEFAULT };
    let codec = (*gate.codec() != default_codec).then(|| ("codec", gate.codec().word().to_owned()));
    let others = OPTIONS.iter().filter_map(|option| {
        let value = option.get(gate.options()).filter(|value| option.default().as_ref() != Some(value))?;
        Some((option.key, value))
    });
    codec.into_iter().chain(others).map(|(key, value)| format!("`{key}: {value}`")).collect()
}
