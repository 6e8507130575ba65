//! Enums: the components of a kind, and the senders of a gate.

use super::docs;
use crate::clash::{Declaration, Origin};
use crate::system::{Component, Senders, System};
use crate::writer::Writer;

/// The enum of the components of a kind: `MotorInstance`.
pub(super) fn of_kind(kind: &Component) -> String {
    format!("{}Instance", kind.class_name)
}

/// The enum of a gate's senders.
pub(super) fn of_senders(system: &System, senders: &Senders) -> String {
    match senders.kind.as_ref().and_then(|kind| system.kind(kind)) {
        Some(kind) => of_kind(kind),
        None => senders.class_name.clone(),
    }
}

/// A member of an enum: `LEFT_MOTOR`.
fn member(snake_name: &str) -> String {
    let name = snake_name.to_ascii_uppercase();
    // Python treats members with a leading underscore in a way of its own.
    if name.starts_with('_') { format!("INSTANCE{name}") } else { name }
}

/// The names of all enums and of their members.
pub(super) fn declarations(system: &System, module: &str) -> Vec<Declaration> {
    let mut found = Vec::new();
    for kind in system.kinds() {
        let inside = format!("class `{}`", of_kind(kind));
        let members = kind.instances.iter();
        found.extend(members.map(|it| Declaration::new(&inside, member(&it.snake_name), Origin::instance(it))));
        found.push(Declaration::new(module, of_kind(kind), Origin::component(kind)));
    }
    for (component, gate, senders) in system.own_senders() {
        let inside = format!("class `{}`", senders.class_name);
        let origin = |it| Origin::sender(component, gate, it);
        let members = senders.values.iter();
        found.extend(members.map(|it| Declaration::new(&inside, member(&it.snake_name), origin(it))));
        found.push(Declaration::new(module, &senders.class_name, Origin::gate(component, gate)));
    }
    found
}

/// The names of all enums.
pub(super) fn classes(system: &System) -> impl Iterator<Item = String> {
    system.kinds().map(of_kind).chain(system.own_senders().map(|(_, _, senders)| senders.class_name.clone()))
}

/// Writes all enums, before the components that need them.
pub(super) fn write_all(system: &System, out: &mut Writer) {
    for kind in system.kinds() {
        let members = kind.instances.iter().map(|it| (member(&it.snake_name), &*it.name, it.doc.as_deref()));
        write("Instance", &of_kind(kind), &format!("The components of the kind `{}`.", kind.name), members, out);
    }
    for (component, gate, senders) in system.own_senders() {
        let members =
            senders.values.iter().map(|it| (member(&it.snake_name), it.path.as_deref().unwrap_or_default(), None));
        let doc = format!("The gates that send to `{}.{}`.", component.name, gate.name);
        write("Sender", &senders.class_name, &doc, members, out);
    }
}

/// Writes an enum. Its members are given as name, value and documentation.
pub(super) fn write<'a>(
    base: &str,
    class: &str,
    doc: &str,
    members: impl Iterator<Item = (String, &'a str, Option<&'a str>)>,
    out: &mut Writer,
) {
    out.line(format!("\n\nclass {class}(_scl.{base}):"));
    out.indented(|out| {
        docs::write(doc, out);
        out.blank();
        for (name, value, doc) in members {
            out.line(format!("{name} = \"{value}\""));
            doc.iter().for_each(|doc| docs::write(doc, out));
        }
    });
}
