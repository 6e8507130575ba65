//! Enums, and the names that their values stand for: the components of a kind, and the senders of a gate.

use super::literal::literal;
use super::prefix;
use crate::clash::{Declaration, Origin};
use crate::system::{Component, Gate, System};
use crate::writer::Writer;

/// `rover_motor_instance`; `None` for a component of no kind.
pub(super) fn of_kind(system: &System, component: &Component) -> Option<String> {
    component.is_kind().then(|| format!("{}_instance", prefix(system, component)))
}

/// The enum of a gate's senders: that of a kind, or `rover_controller_states_sender`.
pub(super) fn of_senders(system: &System, prefix: &str, gate: &Gate) -> Option<String> {
    let senders = gate.senders.as_ref()?;
    match &senders.kind {
        Some(kind) => of_kind(system, system.kind(kind)?),
        None => Some(own_of(prefix, gate)),
    }
}

/// `rover_controller_states_sender`.
fn own_of(prefix: &str, gate: &Gate) -> String {
    format!("{prefix}_{}_sender", gate.snake_name)
}

/// The array of the names of a kind's components.
pub(super) fn names_of_kind(enumeration: &str) -> String {
    format!("{enumeration}_names")
}

/// The array of the gates that send to a gate.
pub(super) fn names_of_senders(prefix: &str, gate: &Gate) -> String {
    format!("{prefix}_{}_senders", gate.snake_name)
}

/// `ROVER_MOTOR_INSTANCE_LEFT_MOTOR`.
pub(super) fn constant(enumeration: &str, value: &str) -> String {
    format!("{enumeration}_{value}").to_ascii_uppercase()
}

/// The names of all enums, their constants and their arrays.
pub(super) fn declarations(system: &System, component: &Component, scope: &str) -> Vec<Declaration> {
    let mut found = Vec::new();
    let mut declare = |name: String, origin: Origin| found.push(Declaration::new(scope, name, origin));
    let own = prefix(system, component);
    if let Some(enumeration) = of_kind(system, component) {
        for instance in &component.instances {
            declare(constant(&enumeration, &instance.snake_name), Origin::instance(instance));
        }
        declare(names_of_kind(&enumeration), Origin::component(component));
        declare(enumeration, Origin::component(component));
    }
    for (gate, senders) in component.own_senders() {
        let enumeration = own_of(&own, gate);
        for value in &senders.values {
            // Two values of one name clash, although both belong to this gate.
            declare(constant(&enumeration, &value.snake_name), Origin::sender(component, gate, value));
        }
        declare(enumeration, Origin::gate(component, gate));
    }
    for gate in component.gates.iter().filter(|gate| gate.senders.is_some()) {
        declare(names_of_senders(&own, gate), Origin::gate(component, gate));
    }
    found
}

/// Writes the enum of a kind into the header.
pub(super) fn declare_kind(system: &System, component: &Component, out: &mut Writer) {
    let Some(enumeration) = of_kind(system, component) else { return };
    let comment = format!("The components of the kind `{}`.", component.name);
    write_enum(&comment, &enumeration, component.instances.iter().map(|it| it.snake_name.as_str()), out);
}

/// Writes the enums of the senders of a component's gates into the header.
pub(super) fn declare_senders(prefix: &str, component: &Component, out: &mut Writer) {
    for (gate, senders) in component.own_senders() {
        let comment = format!("The gates that send to `{}.{}`.", component.name, gate.name);
        write_enum(&comment, &own_of(prefix, gate), senders.values.iter().map(|it| it.snake_name.as_str()), out);
    }
}

/// Writes an enum into the header.
pub(super) fn write_enum<'a>(
    comment: &str,
    enumeration: &str,
    values: impl Iterator<Item = &'a str>,
    out: &mut Writer,
) {
    let constants: Vec<String> = values.map(|value| constant(enumeration, value)).collect();
    out.line(format!("\n/* {comment} */"));
    let end = format!("}} {enumeration};");
    out.block(format!("typedef enum {enumeration} {{"), &end, |out| out.line(constants.join(",\n")));
}

/// Writes the arrays of names into the source.
pub(super) fn define(system: &System, component: &Component, out: &mut Writer) {
    if let Some(enumeration) = of_kind(system, component) {
        write_names(&names_of_kind(&enumeration), component.instances.iter().map(|it| it.name.as_str()), out);
    }
    let own = prefix(system, component);
    for gate in &component.gates {
        if let Some(senders) = &gate.senders {
            // No sender has the name of a component alone.
            let paths = senders.values.iter().map(|it| it.path.as_deref().unwrap_or(&it.snake_name));
            write_names(&names_of_senders(&own, gate), paths, out);
        }
    }
}

/// Writes an array of names into the source.
pub(super) fn write_names<'a>(array: &str, names: impl Iterator<Item = &'a str>, out: &mut Writer) {
    out.blank();
    out.block(format!("static const char *const {array}[] = {{"), "};", |out| {
        names.for_each(|name| out.line(format!("{},", literal(name))));
    });
}
