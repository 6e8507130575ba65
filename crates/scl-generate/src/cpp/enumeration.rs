//! Enums, and the names that their values stand for: the components of a kind, and the senders of a gate.

use super::write_comment;
use crate::clash::{Declaration, Origin};
use crate::identifier;
use crate::system::{Component, Instance, Senders, System};
use crate::writer::Writer;

/// `MotorInstance`.
pub(super) fn of_kind(kind: &Component) -> String {
    format!("{}Instance", kind.class_name)
}

/// The constant with the names of a kind's components.
pub(super) fn names_of_kind(kind: &Component) -> String {
    format!("{}Names", kind.class_name)
}

/// The struct that says how the senders of a gate are told apart: `ControllerStatesSenders`.
pub(super) fn senders(senders: &Senders) -> String {
    format!("{}s", senders.class_name)
}

/// The names of all enums and of their values.
pub(super) fn declarations(system: &System, namespace: &str, inside: &str) -> Vec<Declaration> {
    let mut found = Vec::new();
    for kind in system.kinds() {
        let scope = format!("the C++ enum `{namespace}::{}`", of_kind(kind));
        let instance =
            |of: &Instance| Declaration::new(&scope, identifier::c_family(&of.class_name), Origin::instance(of));
        found.extend(kind.instances.iter().map(instance));
        found.push(Declaration::new(inside, of_kind(kind), Origin::component(kind)));
    }
    for (component, gate, senders) in system.own_senders() {
        found.push(Declaration::new(inside, &senders.class_name, Origin::gate(component, gate)));
    }
    found
}

/// Writes all enums, which components need before they are declared.
pub(super) fn write_all(system: &System, out: &mut Writer) {
    for kind in system.kinds() {
        let values = kind.instances.iter().map(|it| (it.class_name.as_str(), it.doc.as_deref()));
        write_enum(out, &format!("The components of the kind `{}`.", kind.name), &of_kind(kind), values);
    }
    for (component, gate, senders) in system.own_senders() {
        let values = senders.values.iter().map(|it| (it.class_name.as_str(), it.path.as_deref()));
        let comment = format!("The gates that send to `{}.{}`.", component.name, gate.name);
        write_enum(out, &comment, &senders.class_name, values);
    }
}

/// Writes an enum, whose values are given as name and documentation.
pub(super) fn write_enum<'a>(
    out: &mut Writer,
    comment: &str,
    name: &str,
    values: impl Iterator<Item = (&'a str, Option<&'a str>)>,
) {
    out.blank();
    write_comment(out, comment);
    out.block(format!("enum class {name} {{"), "};", |out| {
        for (value, doc) in values {
            doc.iter().for_each(|doc| write_comment(out, doc));
            out.line(format!("{},", identifier::c_family(value)));
        }
    });
}

/// Writes what the values of all enums stand for.
pub(super) fn write_names(system: &System, out: &mut Writer) {
    for kind in system.kinds() {
        write_names_of(&names_of_kind(kind), kind.instances.iter().map(|it| it.name.as_str()), out);
    }
    let gates = system.components.iter().flat_map(|component| &component.gates);
    for of in gates.filter_map(|gate| gate.senders.as_ref()) {
        let sender = match of.kind.as_ref().and_then(|kind| system.kind(kind)) {
            Some(kind) => of_kind(kind),
            None => of.class_name.clone(),
        };
        out.blank();
        out.block(format!("struct {} {{", senders(of)), "};", |out| {
            out.line(format!("using Sender = {sender};\nstatic constexpr const char* names[] = {{"));
            // No sender has the name of a component alone.
            write_list(of.values.iter().map(|it| it.path.as_deref().unwrap_or(&it.snake_name)), out);
            out.line("};");
        });
    }
}

/// Writes a constant with the names that the values of an enum stand for.
pub(super) fn write_names_of<'a>(constant: &str, names: impl Iterator<Item = &'a str>, out: &mut Writer) {
    out.line(format!("\ninline constexpr const char* {constant}[] = {{"));
    write_list(names, out);
    out.line("};");
}

fn write_list<'a>(names: impl Iterator<Item = &'a str>, out: &mut Writer) {
    out.indented(|out| names.for_each(|name| out.line(format!("\"{name}\","))));
}
