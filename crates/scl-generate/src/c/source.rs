//! `<system>_scl.c`.

use super::literal::literal;
use super::{enumeration, functions, helpers, messages, parameters};
use crate::comment;
use crate::system::System;
use crate::writer::Writer;

/// The source.
pub(super) fn text(system: &System) -> String {
    let mut out = Writer::default();
    first_line(system, &mut out);
    out.line(format!("#define {}", own_macro(system)));
    out.line(format!("#include \"{}_scl.h\"\n", system.snake_name()));
    let has_structs = !messages(system).is_empty();
    out.line(if has_structs {
        "#include <stdio.h>\n#include <stdlib.h>\n#include <string.h>\n"
    } else {
        "#include <string.h>\n"
    });
    write_plan(system, &mut out);
    helpers::needed(system).into_iter().for_each(|helper| out.line(format!("\n{helper}")));
    system.components.iter().for_each(|component| enumeration::define(system, component, &mut out));
    system.components.iter().for_each(|component| parameters::define(system, component, &mut out));
    let functions = system.components_and_counterparts().flat_map(|component| functions(system, component));
    functions.for_each(|function| function.define(&mut out));
    out.finish()
}

/// The macro that the source defines to switch off the checking macros, which would hide the functions' own
/// definitions.
pub(super) fn own_macro(system: &System) -> String {
    format!("{}_SCL_SOURCE", system.snake_name().to_ascii_uppercase())
}

/// Writes the comment that every generated file begins with.
pub(super) fn first_line(system: &System, out: &mut Writer) {
    out.line(format!("/* {} */", comment::c_lines(&system.header()).concat()));
}

/// Writes the plan as one string literal. A compiler need not accept one of more than 4095 characters, but those that
/// warn about it do.
fn write_plan(system: &System, out: &mut Writer) {
    out.line("/* The plan of the system, as `scl plan` prints it. */");
    out.line("#if defined(__GNUC__)\n#pragma GCC diagnostic push");
    out.line("#pragma GCC diagnostic ignored \"-Woverlength-strings\"\n#endif");
    out.line("static const char plan[] =");
    let json = system.plan_json();
    let lines: Vec<&str> = json.lines().collect();
    for (index, line) in lines.iter().enumerate() {
        let end = if index + 1 == lines.len() { ";" } else { "" };
        out.line(format!("    {}{end}", literal(line)));
    }
    out.line("#if defined(__GNUC__)\n#pragma GCC diagnostic pop\n#endif");
}
