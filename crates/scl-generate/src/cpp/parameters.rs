//! The parameters of components: a struct with their values, and enums of those that are one of several words.

use super::enumeration::{write_enum, write_names_of};
use super::write_comment;
use crate::clash::{Declaration, Origin};
use crate::identifier;
use crate::system::{Component, Parameter, System};
use crate::writer::Writer;
use scl_plan::{ParameterType, Scalar};

/// The names of the structs and their members, and of the enums and their values.
pub(super) fn declarations(system: &System, namespace: &str, inside: &str) -> Vec<Declaration> {
    let mut found = Vec::new();
    for component in &system.components {
        let Some(name) = component.parameters_class() else { continue };
        let scope = format!("the C++ struct `{namespace}::{name}`");
        found.extend(
            component
                .parameters
                .iter()
                .map(|it| Declaration::new(&scope, member(it), Origin::parameter(component, it))),
        );
        found.push(Declaration::new(inside, name, Origin::component(component)));
    }
    for (component, parameter, choice) in system.choices() {
        let scope = format!("the C++ enum `{namespace}::{}`", choice.class_name);
        let origin = |it| Origin::choice(component, parameter, it);
        let values = choice.values.iter();
        found.extend(values.map(|it| Declaration::new(&scope, identifier::c_family(&it.class_name), origin(it))));
        found.push(Declaration::new(inside, &choice.class_name, Origin::parameter(component, parameter)));
    }
    found
}

/// Writes the enums and the structs, which components need before they are declared.
pub(super) fn write_all(system: &System, out: &mut Writer) {
    for component in &system.components {
        for (parameter, choice) in component.choices() {
            let comment = format!("The values of the parameter `{}.{}`.", component.name, parameter.name);
            let values = choice.values.iter().map(|it| (it.class_name.as_str(), None));
            write_enum(out, &comment, &choice.class_name, values);
        }
        let Some(name) = component.parameters_class() else { continue };
        out.blank();
        write_comment(out, &format!("The parameters of `{}`.", component.name));
        out.block(format!("struct {name} {{"), "};", |out| {
            for parameter in &component.parameters {
                parameter.plan.doc.iter().for_each(|doc| write_comment(out, doc));
                write_comment(out, &format!("Parameter: {}.", parameter.plan.described()));
                out.line(format!("{} {}{{}};", member_type(parameter), member(parameter)));
            }
        });
    }
}

/// Writes the words of the enums, and the functions that read all parameters of a component.
pub(super) fn write_readers(system: &System, out: &mut Writer) {
    for (_, _, choice) in system.choices() {
        write_names_of(&words(&choice.class_name), choice.values.iter().map(|it| it.word.as_str()), out);
    }
    for component in &system.components {
        let Some(name) = component.parameters_class() else { continue };
        out.blank();
        out.block(format!("inline {name} read(::scl_component* component, {name} values) {{"), "}", |out| {
            component.parameters.iter().for_each(|parameter| out.line(read(parameter)));
            out.line("return values;");
        });
    }
}

/// Writes the member of a component.
pub(super) fn write_member(component: &Component, out: &mut Writer) {
    let Some(name) = component.parameters_class() else { return };
    let (doc, update) = match component.has_live_parameters() {
        false => ("The values that its parameters had when the component was opened.", ""),
        true => (
            "The values that its parameters had when the component was opened, or at the last update.",
            "\n\
             /// Takes over the live parameters that have changed, and waits for one until `limit`. Returns whether\n\
             /// any has. Without a limit it does not wait, and costs next to nothing.\n\
             bool update_parameters(::scl::TimeLimit limit = ::std::chrono::nanoseconds(0)) {\n    \
                 const bool changed = ::scl::detail::update_parameters(*this, limit);\n    \
                 if (changed) {\n        \
                     parameters = scl_generated::read(handle(), ::std::move(parameters));\n    \
                 }\n    \
                 return changed;\n\
             }",
        ),
    };
    out.line(format!("\n/// {doc}"));
    out.line(format!("{name} parameters = scl_generated::read(handle(), {name}{{}});"));
    if !update.is_empty() {
        out.line(update);
    }
}

fn read(parameter: &Parameter) -> String {
    let (name, member) = (&parameter.name, member(parameter));
    match &parameter.choice {
        Some(choice) => {
            let words = words(&choice.class_name);
            format!("::scl::detail::read_choice(component, \"{name}\", values.{member}, {words});")
        }
        None => format!("::scl::detail::read_parameter(component, \"{name}\", values.{member});"),
    }
}

/// The constant with the words of an enum.
fn words(enumeration: &str) -> String {
    format!("{enumeration}Names")
}

fn member(parameter: &Parameter) -> String {
    identifier::c_family(&parameter.snake_name)
}

fn member_type(parameter: &Parameter) -> String {
    match (&parameter.plan.kind, &parameter.choice) {
        (ParameterType::One(scalar), _) => of_scalar(*scalar).to_owned(),
        (ParameterType::List(scalar, Some(length)), _) => format!("::std::array<{}, {length}>", of_scalar(*scalar)),
        (ParameterType::List(scalar, None), _) => format!("::std::vector<{}>", of_scalar(*scalar)),
        (ParameterType::OneOf(_), Some(choice)) => choice.class_name.clone(),
        (ParameterType::OneOf(_), None) => of_scalar(Scalar::Text).to_owned(),
    }
}

fn of_scalar(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Bool => "bool",
        Scalar::I8 => "::std::int8_t",
        Scalar::I16 => "::std::int16_t",
        Scalar::I32 => "::std::int32_t",
        Scalar::I64 => "::std::int64_t",
        Scalar::U8 => "::std::uint8_t",
        Scalar::U16 => "::std::uint16_t",
        Scalar::U32 => "::std::uint32_t",
        Scalar::U64 => "::std::uint64_t",
        Scalar::F32 => "float",
        Scalar::F64 => "double",
        Scalar::Text => "::std::string",
        Scalar::Duration => "::std::chrono::nanoseconds",
    }
}
