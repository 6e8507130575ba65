//! The parameters of components: a class with a field for each, and enums of those that are one of several words.

use super::layout::{Doc, Layout};
use super::names::{self, Names};
use super::{Imports, docs, enumeration};
use crate::clash::{Declaration, Origin};
use crate::system::{Component, Parameter, System};
use crate::writer::Writer;
use scl_plan::{ParameterType, Scalar};

/// The names of the classes, of their fields, and of the enums.
pub(super) fn declarations(system: &System, module: &str) -> Vec<Declaration> {
    let mut found = Vec::new();
    for component in &system.components {
        let Some(class) = component.parameters_class() else { continue };
        let inside = format!("class `{class}`");
        let fields = component.parameters.iter();
        found
            .extend(fields.map(|it| Declaration::new(&inside, names::parameter(it), Origin::parameter(component, it))));
        found.push(Declaration::new(module, class, Origin::component(component)));
    }
    for (component, parameter, choice) in system.choices() {
        let inside = format!("class `{}`", choice.class_name);
        let origin = |it| Origin::choice(component, parameter, it);
        let members = choice.values.iter();
        found.extend(members.map(|it| Declaration::new(&inside, names::choice(it), origin(it))));
        found.push(Declaration::new(module, &choice.class_name, Origin::parameter(component, parameter)));
    }
    found
}

/// The names of all classes and enums.
pub(super) fn classes(system: &System) -> impl Iterator<Item = String> {
    let enums = system.choices().map(|(_, _, choice)| choice.class_name.clone());
    system.components.iter().filter_map(Component::parameters_class).chain(enums)
}

/// Writes the enums and the class of a component's parameters, before the component.
pub(super) fn write(component: &Component, names: &Names, imports: &Imports, out: &mut Writer) {
    let Some(class) = component.parameters_class() else { return };
    for (parameter, choice) in component.choices() {
        let members = choice.values.iter().map(|it| (names::choice(it), it.word.as_str(), None));
        let doc = format!("The values of the parameter `{}.{}`.", component.name, parameter.name);
        enumeration::write("Choice", &choice.class_name, &doc, members, out);
    }
    let choices = component
        .choices()
        .map(|(parameter, choice)| Doc::text(format!("\"{}\": {}", names::parameter(parameter), choice.class_name)));
    let choices: Vec<Doc> = choices.collect();
    let mut arguments = vec![Doc::text("_scl.Parameters")];
    if !choices.is_empty() {
        arguments.push(Doc::concat([Doc::text("choices="), Doc::group("{", choices, "}")]));
    }
    let head = [Doc::text(format!("class {class}")), Doc::group("(", arguments, ")"), Doc::text(":")];
    out.line(format!("\n\n{}", Layout::at(0).print(&Doc::concat(head))));
    out.indented(|out| {
        docs::write(&format!("The parameters of `{}`.", component.name), out);
        for parameter in &component.parameters {
            out.line(format!("\n{}: {}", names::parameter(parameter), annotation(parameter, names, imports)));
            docs::write(&docs::of_parameter(parameter), out);
        }
    });
}

fn annotation(parameter: &Parameter, names: &Names, imports: &Imports) -> String {
    match (&parameter.plan.kind, &parameter.choice) {
        (ParameterType::One(scalar), _) => of_scalar(*scalar, names, imports),
        (ParameterType::List(scalar, _), _) => {
            format!("{}[{}]", names.builtin("list", imports), of_scalar(*scalar, names, imports))
        }
        (ParameterType::OneOf(_), Some(choice)) => choice.class_name.clone(),
        (ParameterType::OneOf(_), None) => names.builtin("str", imports),
    }
}

fn of_scalar(scalar: Scalar, names: &Names, imports: &Imports) -> String {
    match scalar {
        Scalar::Bool => names.builtin("bool", imports),
        Scalar::F32 | Scalar::F64 => names.builtin("float", imports),
        Scalar::Text => names.builtin("str", imports),
        Scalar::Duration => imports.of("datetime", "timedelta"),
        Scalar::I8 | Scalar::I16 | Scalar::I32 | Scalar::I64 | Scalar::U8 | Scalar::U16 | Scalar::U32 | Scalar::U64 => {
            names.builtin("int", imports)
        }
    }
}
