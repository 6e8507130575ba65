//! The components of a kind: an enum, and their names.

use super::literal::literal;
use super::prefix;
use crate::system::{Component, Instance, System};
use crate::writer::Writer;

/// `rover_motor_instance`; `None` for a component of no kind.
pub(super) fn enumeration(system: &System, component: &Component) -> Option<String> {
    component.is_kind().then(|| format!("{}_instance", prefix(system, component)))
}

/// `ROVER_MOTOR_INSTANCE_LEFT_MOTOR`.
pub(super) fn constant(enumeration: &str, instance: &Instance) -> String {
    format!("{enumeration}_{}", instance.snake_name).to_ascii_uppercase()
}

/// The array of the names in the source.
pub(super) fn names(enumeration: &str) -> String {
    format!("{enumeration}_names")
}

/// Writes the enum into the header.
pub(super) fn declare(system: &System, component: &Component, out: &mut Writer) {
    let Some(enumeration) = enumeration(system, component) else { return };
    out.line(format!("\n/* The components of the kind `{}`. */", component.name));
    let constants = component.instances.iter().map(|instance| constant(&enumeration, instance));
    let constants: Vec<String> = constants.collect();
    let end = format!("}} {enumeration};");
    out.block(format!("typedef enum {enumeration} {{"), &end, |out| out.line(constants.join(",\n")));
}

/// Writes the array of names into the source.
pub(super) fn define(system: &System, component: &Component, out: &mut Writer) {
    let Some(enumeration) = enumeration(system, component) else { return };
    out.blank();
    out.block(format!("static const char *const {}[] = {{", names(&enumeration)), "};", |out| {
        component.instances.iter().for_each(|instance| out.line(format!("{},", literal(&instance.name))));
    });
}
