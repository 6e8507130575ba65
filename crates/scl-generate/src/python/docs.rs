//! Docstrings, which editors show when the cursor is on a name.

use crate::comment;
use crate::system::{Component, Gate, Parameter, System};
use crate::writer::Writer;
use scl_plan::{GateOptions, OptionAccess, Payload};
use std::time::Duration;

/// Writes a docstring.
pub(super) fn write(text: &str, out: &mut Writer) {
    let mut lines: Vec<String> = comment::lines(text.trim()).map(|line| escape(&line)).collect();
    remove_common_indentation(lines.get_mut(1..).unwrap_or_default());
    // A quote next to the docstring's triple quotes would be taken for one of them; ruff inserts a space there.
    if let Some(first) = lines.first_mut().filter(|line| line.starts_with('"')) {
        first.insert(0, ' ');
    }
    match lines.as_slice() {
        [] => {}
        [line] if line.ends_with('"') => out.line(format!("\"\"\"{line} \"\"\"")),
        [line] => out.line(format!("\"\"\"{line}\"\"\"")),
        [first, rest @ ..] => {
            out.line(format!("\"\"\"{first}"));
            rest.iter().for_each(|line| out.line(line));
            out.line("\"\"\"");
        }
    }
}

/// Removes the indentation that all lines share, as docstrings are displayed, and as ruff formats them.
fn remove_common_indentation(lines: &mut [String]) {
    let indentation = |line: &String| line.len() - line.trim_start_matches(' ').len();
    let common = lines.iter().filter(|line| !line.is_empty()).map(indentation).min().unwrap_or(0);
    lines.iter_mut().filter(|line| !line.is_empty()).for_each(|line| drop(line.drain(..common)));
}

/// Escapes a text for the inside of a docstring.
pub(super) fn escape(text: &str) -> String {
    text.replace('\\', "\\\\").replace("\"\"\"", "'''")
}

/// The docstring of a class. It lists the gates, which `help` would not show: they are attributes of instances.
pub(super) fn of_component(system: &System, component: &Component, attribute: impl Fn(&Gate) -> String) -> String {
    let mut parts: Vec<String> = component.doc.iter().map(|doc| doc.trim().to_owned()).collect();
    if component.counterpart_of.is_none() {
        parts.push(format!("{} of `{}`, declared at `{}`.", component.what(), system.name, component.declared_at));
    }
    let gates = component.gates.iter();
    let gates = gates.map(|gate| format!("    {}: `{}` {}", attribute(gate), gate.plan.kind.word(), sentence(gate)));
    let gates: Vec<String> = gates.collect();
    if !gates.is_empty() {
        parts.push(format!("Gates:\n{}", gates.join("\n")));
    }
    parts.join("\n\n")
}

/// The docstring of an attribute: the gate's `doc`, what it carries, between which gates, and unusual options.
pub(super) fn of_gate(component: &Component, gate: &Gate, unsupported: Option<&str>) -> String {
    let mut parts: Vec<String> = gate.doc.iter().map(|doc| doc.trim().to_owned()).collect();
    parts.push(format!("`{}`: {}.", gate.plan.kind.word(), sentence(gate)));
    let options = options(gate);
    // A counterpart does not use the options of the topology file: it drops and rejects nothing.
    if !options.is_empty() && component.counterpart_of.is_none() {
        parts.push(format!("Options: {}.", options.join(", ")));
    }
    parts.extend(unsupported.map(|reason| format!("Python cannot open this gate: {reason}.")));
    parts.push(format!("Declared at `{}`.", gate.plan.declared_at));
    parts.join("\n\n")
}

/// The docstring of a parameter's field: its `doc`, type, range, unit and default.
pub(super) fn of_parameter(parameter: &Parameter) -> String {
    let doc = parameter.plan.doc.as_ref().map(|doc| doc.trim().to_owned());
    let facts = format!("Parameter: {}.", parameter.plan.described());
    let place = format!("Declared at `{}`.", parameter.plan.declared_at);
    doc.into_iter().chain([facts, place]).collect::<Vec<_>>().join("\n\n")
}

fn sentence(gate: &Gate) -> String {
    let message = match &gate.plan.payload {
        Payload::Bytes => "bytes".to_owned(),
        Payload::Message(name) => format!("`{name}`"),
        Payload::Exchange { request, reply } => format!("`{request}` -> `{reply}`"),
    };
    let peers = if gate.peers.is_empty() { "no peer".to_owned() } else { gate.quoted_peers() };
    gate.plan.kind.sentence(&message, &peers)
}

/// The options that differ from their defaults.
fn options(gate: &Gate) -> Vec<String> {
    let (mut options, mut default) = (gate.plan.options.clone(), GateOptions::DEFAULT);
    let is_typed = gate.plan.payload != Payload::Bytes;
    let codec = (is_typed && gate.plan.codec != "protobuf").then(|| format!("`codec: {}`", gate.plan.codec));
    let changed = GateOptions::ALL.iter().filter_map(|option| {
        let value = value_of(&option.access, &mut options);
        (value != value_of(&option.access, &mut default)).then(|| format!("`{}: {value}`", option.key))
    });
    codec.into_iter().chain(changed).collect()
}

fn in_words(duration: Duration) -> String {
    format!("{duration:?}").replace('µ', "u")
}

fn value_of(access: &OptionAccess, options: &mut GateOptions) -> String {
    match access {
        OptionAccess::Number(number) => number(options).to_string(),
        OptionAccess::Size(size) => format!("{}B", size(options)),
        OptionAccess::Duration(duration) => in_words(*duration(options)),
        OptionAccess::Interval(interval) => interval(options).map_or("none".to_owned(), in_words),
        OptionAccess::Flag(flag) => flag(options).to_string(),
        OptionAccess::Policy(policy) => policy(options).word().to_owned(),
        OptionAccess::Undecodable(choice) => choice(options).word().to_owned(),
    }
}
