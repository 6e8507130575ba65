//! `<system>_scl.h`.

use super::comment::write_comment;
use super::component_functions::component_functions;
use super::{content, enumeration, functions, gate, messages, parameters, prefix, protobuf_c, source, wait};
use crate::system::{Component, Gate, System};
use crate::writer::Writer;
use std::collections::BTreeSet;

/// What a C programmer has to know before the first call.
const CONVENTIONS: &str = "\
/*
 * Open a component with <component>_open, then use the functions of its gates. They return SCL_OK or a negative
 * status; scl_error() has the text. Timeouts are in nanoseconds: 0 does not wait, a negative one waits without limit (of
 * a call: as long as the gate's own timeout).
 *
 * A message that is sent stays the caller's. A message that is received belongs to the caller, who frees it with the
 * gate's _free (bytes: scl_message_free). Whatever the result, the pointer is set, to NULL if there is no message.
 *
 * Use each gate from one thread at a time.
 */";

/// Without these pragmas, C compilers accept a program with a misspelt gate or a wrong message type.
const STRICTNESS: &str = "\
#if defined(__GNUC__) && !defined(__cplusplus)
/* A misspelt gate and a wrong message type are errors, whatever the options of the compiler. */
#pragma GCC diagnostic error \"-Wimplicit-function-declaration\"
#pragma GCC diagnostic error \"-Wincompatible-pointer-types\"
#pragma GCC diagnostic error \"-Wint-conversion\"
#endif";

/// The header.
pub(super) fn text(system: &System) -> String {
    let mut out = Writer::default();
    let guard = format!("{}_SCL_H", system.snake_name().to_ascii_uppercase());
    source::first_line(system, &mut out);
    out.line(format!("#ifndef {guard}\n#define {guard}\n"));
    out.line("#include <scl.h>");
    includes(system).into_iter().for_each(|header| out.line(format!("#include \"{header}\"")));
    out.line(format!("\n{CONVENTIONS}\n\n{STRICTNESS}\n"));
    out.line("#ifdef __cplusplus\nextern \"C\" {\n#endif");
    system.kinds().for_each(|kind| enumeration::declare_kind(system, kind, &mut out));
    system.components_and_counterparts().for_each(|component| write_component(system, component, &mut out));
    out.line("\n#ifdef __cplusplus\n}\n#endif\n");
    write_checks(system, &mut out);
    out.line(format!("#endif /* {guard} */"));
    out.finish()
}

/// The headers of the messages.
fn includes(system: &System) -> BTreeSet<String> {
    let messages = messages(system);
    let files = system.descriptors.as_ref();
    messages.iter().filter_map(|message| protobuf_c::header_of(files?, &message.dotted)).collect()
}

fn write_component(system: &System, component: &Component, out: &mut Writer) {
    let prefix = prefix(system, component);
    enumeration::declare_senders(&prefix, component, out);
    parameters::declare(&prefix, component, out);
    out.blank();
    let noun = if component.is_kind() { "Kind" } else { "Component" };
    let headline = format!("{noun} `{}` ({})", component.name, component.declared_at);
    match (&component.counterpart_of, &component.doc) {
        (Some(_), Some(doc)) => write_comment(doc, None, out),
        (_, doc) => write_comment(&headline, doc.as_deref(), out),
    }
    out.block(format!("typedef struct {prefix} {{"), &format!("}} {prefix};"), |out| {
        out.line("scl_component *component;");
        if let Some(enumeration) = enumeration::of_kind(system, component) {
            out.line(format!("{enumeration} instance;"));
        }
        if let Some(parameters) = parameters::struct_name(&prefix, component) {
            out.line(format!("{parameters} parameters;"));
        }
        if component.gates.is_empty() {
            return;
        }
        out.block("struct {", "} gates;", |out| {
            component.gates.iter().for_each(|gate| out.line(format!("scl_gate *{};", gate::member(gate))));
        });
    });
    out.blank();
    component_functions(system, component).iter().for_each(|function| function.declare(out));
    component.gates.iter().for_each(|gate| write_gate(system, &prefix, component, gate, out));
    write_wait(&prefix, component, out);
}

fn write_gate(system: &System, prefix: &str, component: &Component, of: &Gate, out: &mut Writer) {
    out.blank();
    let (kind, carries) = (of.plan.kind.word(), content::described(of));
    let headline = format!("Gate `{}.{}` ({}): {kind}, {carries}", component.name, of.name, of.plan.declared_at);
    match &component.counterpart_of {
        None => write_comment(&headline, of.doc.as_deref(), out),
        Some(tested) => {
            write_comment(&format!("The other end of `{tested}.{}`: {kind}, {carries}", of.name), None, out);
        }
    }
    if let Some(name) = gate::request_struct(prefix, of) {
        let end = format!("}} {name};");
        out.block(format!("typedef struct {name} {{"), &end, |out| out.line(gate::request_members(of)));
    }
    gate::functions(system, prefix, of).iter().for_each(|function| function.declare(out));
}

fn write_wait(prefix: &str, component: &Component, out: &mut Writer) {
    let Some(function) = wait::function(prefix, component) else { return };
    out.blank();
    for (bit, gate) in wait::gates(component).into_iter().enumerate() {
        out.line(format!("#define {} (UINT64_C(1) << {bit})", wait::constant(prefix, gate)));
    }
    function.declare(out);
}

fn write_checks(system: &System, out: &mut Writer) {
    out.line("/* Compilers without such an option, or with -w, silently accept pointers of another type; these macros do not. */");
    out.line(format!("#if defined(SCL_POINTER) && !defined({})", source::own_macro(system)));
    for component in system.components_and_counterparts() {
        functions(system, component).iter().for_each(|function| function.check(out));
    }
    out.line("#endif\n");
}
