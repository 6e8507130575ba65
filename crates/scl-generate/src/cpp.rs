//! `--for cpp`: a header with one struct per component, over `scl.hpp` and the headers that protoc writes.

mod enumeration;
mod messages;
mod parameters;
mod plan_text;

use crate::clash::{Declaration, Origin};
use crate::comment;
use crate::identifier;
use crate::output::File;
use crate::system::{Component, Gate, MessageUse, System};
use crate::writer::Writer;
use messages::Messages;
pub(crate) use messages::unwritable;

/// Namespaces that a system must not use: those of the standard library and of SCL itself.
const TAKEN_NAMESPACES: [&str; 2] = ["std", "scl"];

/// The functions of `scl::Component`, which a gate of the same name would hide.
const OF_COMPONENTS: [&str; 6] = ["close", "fd", "handle", "name", "ready", "set_parameter"];

/// The names that the header declares.
pub(crate) fn declarations(system: &System) -> Vec<Declaration> {
    let namespace = namespace(system);
    let inside = format!("the C++ namespace `{namespace}`");
    let component =
        |component: &Component| Declaration::new(&inside, &component.class_name, Origin::component(component));
    let mut declarations = messages::declarations(system, &namespace, &inside);
    declarations.extend(system.components_and_counterparts().map(component));
    declarations.extend(enumeration::declarations(system, &namespace, &inside));
    declarations.extend(parameters::declarations(system, &namespace, &inside));
    for component in system.components_and_counterparts() {
        let scope = format!("the C++ struct `{namespace}::{}`", component.class_name);
        if component.counterpart.is_some() {
            declarations.push(Declaration::new(&scope, "test", Origin::generated("function `test`")));
        }
        if component.is_kind() {
            declarations.push(Declaration::new(&scope, "instance", Origin::generated("function `instance`")));
        }
        if component.has_live_parameters() {
            let function = Origin::generated("function `update_parameters`");
            declarations.push(Declaration::new(&scope, "update_parameters", function));
        }
        let gate = |gate| Declaration::new(&scope, member(gate), Origin::gate(component, gate));
        declarations.extend(component.gates.iter().map(gate));
    }
    declarations
}

/// `<system>.scl.hpp`.
pub(crate) fn files(system: &System) -> Vec<File> {
    let messages = Messages::of(system);
    let namespace = namespace(system);
    let mut out = Writer::default();
    out.line(format!("// {}\n#pragma once\n\n#include <scl.hpp>", system.header()));
    let gates = || system.gates().filter(|gate| carries_messages(gate));
    for codec in ["json", "protobuf"] {
        if gates().any(|gate| gate.plan.codec == codec) {
            out.line(format!("#include <scl/{codec}.hpp>"));
        }
    }
    let headers = messages.headers(gates().flat_map(|gate| &gate.types).filter(|used| used.in_schemas));
    if !headers.is_empty() {
        out.blank();
        headers.iter().for_each(|header| out.line(format!("#include \"{header}\"")));
    }
    out.line(format!("\nnamespace {namespace} {{"));
    enumeration::write_all(system, &mut out);
    parameters::write_all(system, &mut out);
    out.line(
        "\nnamespace scl_generated {\n\n/// What the programs need of the topology file, as `scl plan` prints it.",
    );
    out.line(format!("inline constexpr ::std::string_view plan = {};", plan_text::literal(&system.plan_json())));
    enumeration::write_names(system, &mut out);
    parameters::write_readers(system, &mut out);
    out.line("\n} // namespace scl_generated");
    for component in system.components_and_counterparts() {
        out.blank();
        write_component(&mut out, component, &messages);
    }
    out.line(format!("\n}} // namespace {namespace}"));
    vec![File { name: format!("{}.scl.hpp", system.snake_name()), text: out.finish() }]
}

fn namespace(system: &System) -> String {
    let name = identifier::c_family(&system.snake_name());
    if TAKEN_NAMESPACES.contains(&name.as_str()) { format!("{name}_") } else { name }
}

fn write_component(out: &mut Writer, component: &Component, messages: &Messages) {
    let class = &component.class_name;
    let default = format!("{}.", component.what());
    write_comment(out, component.doc.as_deref().unwrap_or(&default));
    out.block(format!("struct {class} : ::scl::Component {{"), "};", |out| {
        write_opening(out, component);
        parameters::write_member(component, out);
        for gate in &component.gates {
            out.blank();
            write_gate(out, gate, component.counterpart_of.is_some(), messages);
        }
    });
}

/// Writes the functions that open the component.
fn write_opening(out: &mut Writer, component: &Component) {
    let (class, name) = (&component.class_name, &component.name);
    let first = component.instances.first().map_or(name, |instance| &instance.name);
    let for_test =
        format!("explicit {class}(::scl::TestEnd&& end) : ::scl::Component(::std::move(end), \"{first}\") {{}}");
    if let Some(tested) = &component.counterpart_of {
        out.line(format!("/// For the function `test` of `{tested}`.\n{for_test}"));
        return;
    }
    match component.is_kind() {
        true => out.line(
            "/// Opens the component of the kind that `SCL_COMPONENT` names. Throws `scl::Error` if it names none of them,\n\
             /// and `scl::Taken` if the component is already running.",
        ),
        false => out.line("/// Opens the component. Throws `scl::Taken` if it is already running."),
    }
    out.line(format!("explicit {class}(const ::scl::Options& options = {{}})"));
    out.line(format!("    : ::scl::Component(scl_generated::plan, \"{name}\", options) {{}}"));
    if component.is_kind() {
        let (enumeration, names) = (enumeration::of_kind(component), enumeration::names_of_kind(component));
        out.line(format!(
            "\n\
             /// Opens this component of the kind. Throws `scl::Taken` if it is already running.\n\
             explicit {class}({enumeration} instance, const ::scl::Options& options = {{}})\n    \
                 : ::scl::Component(scl_generated::plan, ::scl::detail::name_of(instance, scl_generated::{names}), options) {{}}\n\n\
             /// Which component of the kind it is.\n\
             {enumeration} instance() const {{\n    \
                 return ::scl::detail::index_of<{enumeration}>(name(), scl_generated::{names});\n\
             }}"
        ));
    }
    if let Some(peer) = component.counterpart.as_deref().map(|peer| &peer.class_name) {
        let (doc, parameter, argument) = match component.parameters.is_empty() {
            true => ("", "", ""),
            false => (" Only `set` of the options has an effect.", "const ::scl::Options& options = {}", ", options"),
        };
        out.line(format!(
            "\n\
             /// Opens the component for a unit test, together with the other ends of its gates, without processes,\n\
             /// sockets or files.{doc}\n\
             static ::std::pair<{class}, {peer}> test({parameter}) {{\n    \
                 return ::scl::open_test<{class}, {peer}>(scl_generated::plan, \"{name}\"{argument});\n\
             }}\n\n\
             /// For `test`.\n\
             {for_test}"
        ));
    }
}

fn write_gate(out: &mut Writer, gate: &Gate, is_counterpart: bool, messages: &Messages) {
    gate.doc.iter().for_each(|doc| write_comment(out, doc));
    if !is_counterpart {
        write_comment(out, &peers(gate));
    }
    if let Some(note) = bytes_note(gate) {
        write_comment(out, &note);
    }
    out.line(format!("{} {}{{*this, \"{}\"}};", gate_type(gate, messages), member(gate), gate.name));
}

fn member(gate: &Gate) -> String {
    let name = identifier::c_family(&gate.snake_name);
    if OF_COMPONENTS.contains(&name.as_str()) { format!("{name}_") } else { name }
}

/// `::scl::Sub<::rover::Measurement>`.
fn gate_type(gate: &Gate, messages: &Messages) -> String {
    let kind = gate.plan.kind;
    let mut arguments: Vec<String> = gate.types.iter().map(|used| message_type(gate, used, messages)).collect();
    if arguments.is_empty() {
        arguments = vec![BYTES.to_owned(); if kind.exchanges() { 2 } else { 1 }];
    }
    if gate.plan.codec == "json" && carries_messages(gate) {
        arguments.push("::scl::Json".to_owned());
    }
    // `Debug` prints the name of the variant, which is that of the class.
    let plain = format!("::scl::{kind:?}<{}>", arguments.join(", "));
    match &gate.senders {
        Some(senders) => format!("::scl::From<{plain}, scl_generated::{}>", enumeration::senders(senders)),
        None => plain,
    }
}

const BYTES: &str = "::scl::Bytes";

/// The C++ type of a message: protobuf's if there is one, text for other JSON, else bytes.
fn message_type(gate: &Gate, used: &MessageUse, messages: &Messages) -> String {
    match (messages.cpp_type(&used.dotted), gate.plan.codec.as_str()) {
        (Some(cpp_type), "protobuf" | "json") if used.in_schemas => cpp_type.to_owned(),
        (_, "json") => "::std::string".to_owned(),
        _ => BYTES.to_owned(),
    }
}

/// Whether a gate carries protobuf messages as such.
fn carries_messages(gate: &Gate) -> bool {
    matches!(gate.plan.codec.as_str(), "protobuf" | "json") && gate.types.iter().any(|used| used.in_schemas)
}

fn peers(gate: &Gate) -> String {
    match gate.peers.is_empty() {
        true => "Not connected.".to_owned(),
        false => format!("Connected to {}.", gate.quoted_peers()),
    }
}

/// The note that says what the bytes of a gate are, if its type does not exist in C++.
fn bytes_note(gate: &Gate) -> Option<String> {
    let foreign: Vec<_> = gate.types.iter().filter(|used| !used.in_schemas).collect();
    let codec = &gate.plan.codec;
    match foreign.as_slice() {
        [] if carries_messages(gate) || gate.types.is_empty() => None,
        [] => Some(format!("Bytes of the codec `{codec}`, which C++ does not know.")),
        types => {
            let names: Vec<_> = types.iter().map(|used| format!("`{}`", used.dotted)).collect();
            let form = if codec == "json" { "JSON text" } else { "Bytes" };
            Some(format!("{form} of the Rust type {} (codec `{codec}`).", names.join(" and ")))
        }
    }
}

fn write_comment(out: &mut Writer, text: &str) {
    for line in comment::cpp_lines(text) {
        out.line(if line.is_empty() { "///".to_owned() } else { format!("/// {line}") });
    }
}
