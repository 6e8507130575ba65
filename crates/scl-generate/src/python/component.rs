//! The class of a component.

use super::Imports;
use super::docs;
use super::enumeration;
use super::layout::{Doc, Layout};
use super::names::{self, Names};
use crate::system::{Component, Gate, MessageUse, System};
use crate::writer::Writer;
use scl_plan::GateKind;

/// Writes the class with its gates.
pub(super) fn write(system: &System, component: &Component, names: &Names, imports: &Imports, out: &mut Writer) {
    let class = Doc::text(format!("class {}", names::class(component)));
    let head = Doc::concat([class, Doc::group("(", arguments(system, component), ")"), Doc::text(":")]);
    out.line(format!("\n\n{}", Layout::at(0).print(&head)));
    out.indented(|out| {
        docs::write(&docs::of_component(system, component, names::gate), out);
        for gate in &component.gates {
            let annotation = annotation(system, gate, names, imports);
            let line = Doc::concat([Doc::text(format!("{}: ", names::gate(gate))), annotation]);
            out.line(format!("\n{}", Layout::at(1).print(&line)));
            docs::write(&docs::of_gate(component, gate, unsupported(gate).as_deref()), out);
        }
    });
}

/// The bases of the class, and the arguments that its base takes.
fn arguments(system: &System, component: &Component) -> Vec<Doc> {
    if component.counterpart_of.is_some() {
        return vec![Doc::text("_scl.Counterpart")];
    }
    let generic = |base: &str, of: &str| {
        Doc::concat([Doc::text(format!("_scl.{base}")), Doc::group("[", vec![Doc::text(of.to_owned())], "]")])
    };
    let instance = component.is_kind().then(|| enumeration::of_kind(component));
    let peer = component.counterpart.as_deref().map(names::class);
    let mut arguments = Vec::new();
    arguments.extend(instance.as_ref().map(|instance| generic("ComponentOfKind", instance)));
    arguments.extend(peer.as_ref().map(|peer| generic("TestableComponent", peer)));
    let parameters = component.parameters_class();
    arguments.extend(parameters.as_ref().map(|class| generic("ComponentWithParameters", class)));
    if arguments.is_empty() {
        arguments.push(Doc::text("_scl.GeneratedComponent"));
    }
    arguments.extend([Doc::text("plan=_PLAN"), Doc::text(format!("component=\"{}\"", component.name))]);
    arguments.extend(instance.map(|instance| Doc::text(format!("instances={instance}"))));
    arguments.extend(parameters.map(|class| Doc::text(format!("parameters={class}"))));
    let senders = component.gates.iter().filter_map(|gate| {
        let enumeration = enumeration::of_senders(system, gate.senders.as_ref()?);
        Some(Doc::text(format!("\"{}\": {enumeration}", names::gate(gate))))
    });
    let senders: Vec<Doc> = senders.collect();
    if !senders.is_empty() {
        arguments.push(Doc::concat([Doc::text("senders="), Doc::group("{", senders, "}")]));
    }
    arguments.extend(peer.map(|peer| Doc::text(format!("counterpart={peer}"))));
    arguments
}

fn annotation(system: &System, gate: &Gate, names: &Names, imports: &Imports) -> Doc {
    let kind = gate.plan.kind;
    // `Debug` prints the name of the variant, which is that of the class.
    let mut class = format!("_scl.{kind:?}");
    let types: Vec<String> = match gate.types.as_slice() {
        [] => bytes(kind, names, imports),
        types => types.iter().map(|used| message(gate, used, names, imports)).collect(),
    };
    let senders = gate.senders.as_ref().map(|senders| enumeration::of_senders(system, senders));
    if senders.is_some() {
        class.push_str("From");
    }
    let arguments = senders.into_iter().chain(types).map(Doc::Text).collect();
    Doc::concat([Doc::text(class), Doc::group("[", arguments, "]")])
}

/// The type arguments of a gate for bytes: sent from any buffer, received as `bytes`.
fn bytes(kind: GateKind, names: &Names, imports: &Imports) -> Vec<String> {
    let sent = || "_scl.Buffer".to_owned();
    let received = || names.builtin("bytes", imports);
    match kind {
        GateKind::Pub | GateKind::Push => vec![sent()],
        GateKind::Sub | GateKind::Pull => vec![received()],
        GateKind::Req => vec![sent(), received()],
        GateKind::Rep => vec![received(), sent()],
    }
}

fn message(gate: &Gate, used: &MessageUse, names: &Names, imports: &Imports) -> String {
    if unsupported(gate).is_some() {
        imports.of("typing", "Never")
    } else if used.in_schemas {
        names.reference(&format!(".{}", used.dotted), imports)
    } else {
        imports.of("typing", "Any")
    }
}

/// Why Python cannot read the messages of a gate; `None` if it can. The package says the same when such a component is
/// opened.
fn unsupported(gate: &Gate) -> Option<String> {
    let codec = gate.plan.codec.as_str();
    let in_schemas = gate.types.first()?.in_schemas;
    match (in_schemas, codec) {
        (true, "protobuf" | "json") | (false, "json" | "cbor" | "msgpack") => None,
        (true, _) => Some(format!("the codec `{codec}` does not carry messages of schemas")),
        (false, "protobuf") => Some(format!("the type `{}` is not in `schemas`", gate.types.first()?.dotted)),
        (false, _) => Some(format!("the codec `{codec}` is for Rust programs")),
    }
}
