//! The methods of messages whose arguments are names of fields, and what all enums have.

use super::field::Field;
use super::{Messages, Scope, separate};
use crate::python::layout::{Doc, Layout};
use crate::python::names;
use crate::writer::Writer;
use prost_types::DescriptorProto;

/// Writes the constructor, `HasField`, `ClearField` and `WhichOneof`.
pub(super) fn write(
    messages: &Messages<'_>,
    message: &DescriptorProto,
    fields: &[Field<'_>],
    scope: &Scope<'_>,
    is_first: &mut bool,
    out: &mut Writer,
) {
    let layout = Layout::at(scope.depth + 1);
    let mut method = |name: &str, parameters: Vec<Doc>, result: Doc, decorator: Option<String>| {
        separate(is_first, out);
        decorator.iter().for_each(|decorator| out.line(format!("@{decorator}")));
        let parts = [
            Doc::text(format!("def {name}")),
            Doc::group("(", parameters, ")"),
            Doc::text(" -> "),
            result,
            Doc::text(": ..."),
        ];
        out.line(layout.print(&Doc::concat(parts)));
    };

    let this = || Doc::text("self");
    let mut parameters = vec![this()];
    let given = fields.iter().filter(|field| names::is_attribute(field.name) && field.name != "self");
    let given: Vec<Doc> =
        given.map(|field| Doc::text(format!("{}: {} | None = None", field.name, field.given))).collect();
    if !given.is_empty() {
        parameters.push(Doc::text("*"));
        parameters.extend(given);
    }
    method("__init__", parameters, Doc::text("None"), None);

    let oneofs: Vec<(usize, &str)> = message.oneof_decl.iter().map(|oneof| oneof.name()).enumerate().collect();
    let members = |index: usize| fields.iter().filter(move |field| field.oneof == Some(index)).map(|field| field.name);
    // Skip the synthetic oneofs of `optional` fields: nobody uses their names.
    let oneofs: Vec<_> = oneofs.into_iter().filter(|(index, _)| members(*index).next().is_some()).collect();
    let groups = || oneofs.iter().map(|(_, name)| *name);

    let has = fields.iter().filter(|field| field.has_presence).map(|field| field.name).chain(groups());
    let has = literal(messages, has);
    let boolean = Doc::text(messages.names.builtin("bool", messages.imports));
    method("HasField", vec![this(), Doc::concat([Doc::text("field_name: "), has])], boolean, None);

    let clear = literal(messages, fields.iter().map(|field| field.name).chain(groups()));
    method("ClearField", vec![this(), Doc::concat([Doc::text("field_name: "), clear])], Doc::text("None"), None);

    let overload = (oneofs.len() > 1).then(|| messages.imports.of("typing", "overload"));
    for (index, name) in &oneofs {
        let group = Doc::concat([Doc::text("oneof_group: "), literal(messages, [*name].into_iter())]);
        let result = Doc::concat([literal(messages, members(*index)), Doc::text(" | None")]);
        method("WhichOneof", vec![this(), group], result, overload.clone());
    }
    if oneofs.len() > 1 {
        let any = messages.imports.of("typing", "Any");
        let group = Doc::text(format!("oneof_group: {any}"));
        method("WhichOneof", vec![this(), group], Doc::text(any), None);
    }
    if oneofs.is_empty() {
        let never = Doc::concat([Doc::text("oneof_group: "), literal(messages, [].into_iter())]);
        method("WhichOneof", vec![this(), never], Doc::text("None"), None);
    }
}

/// `Literal["a", "b"]`; without any name, `Never`.
fn literal<'n>(messages: &Messages<'_>, names: impl Iterator<Item = &'n str>) -> Doc {
    let names: Vec<Doc> = names.map(|name| Doc::text(format!("\"{name}\""))).collect();
    if names.is_empty() {
        return Doc::text(messages.imports.of("typing", "Never"));
    }
    Doc::concat([Doc::text(messages.imports.of("typing", "Literal")), Doc::group("[", names, "]")])
}

/// Writes the class from which enums are derived: for type checkers, values are instances of their enum. At run time,
/// values are of type `int`, and an enum has the methods of `google.protobuf.internal.enum_type_wrapper`.
pub(super) fn write_enum_base(messages: &Messages<'_>, out: &mut Writer) {
    let builtin = |name| messages.names.builtin(name, messages.imports);
    let [int, str, list, tuple, classmethod] = ["int", "str", "list", "tuple", "classmethod"].map(builtin);
    let import = |module, name| messages.imports.of(module, name);
    let self_type = import("typing", "Self");
    out.line(format!("class _Enum({int}):"));
    out.indented(|out| {
        let descriptor = import("google.protobuf.descriptor", "EnumDescriptor");
        out.line(format!("DESCRIPTOR: {}[{descriptor}]", import("typing", "ClassVar")));
        let never = import("typing", "Never");
        out.line(format!("\ndef __new__(cls, value: {never}) -> {self_type}: ..."));
        for (name, parameter, result) in [
            ("Name", format!(", number: {int}"), str.clone()),
            ("Value", format!(", name: {str}"), self_type.clone()),
            ("keys", String::new(), format!("{list}[{str}]")),
            ("values", String::new(), format!("{list}[{self_type}]")),
            ("items", String::new(), format!("{list}[{tuple}[{str}, {self_type}]]")),
        ] {
            out.line(format!("\n@{classmethod}\ndef {name}(cls{parameter}) -> {result}: ..."));
        }
    });
}
