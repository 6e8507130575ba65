//! The parameters of components: SCL1901 for entries that are none (most of it is found by the parser), SCL1902 for
//! values, SCL1903 for keys without effect, SCL1904 for names, SCL1905 for components of a kind, SCL1906 for words.

mod live;
mod name;
mod value;
mod words;

use crate::diagnostic::{Diagnostics, Rule, Severity, removal};
use crate::grammar::parameter::ONE_OF;
use crate::model::{ComponentModel, Model, ParameterModel, WrittenValue};
use crate::parse::LIST_FORM;
use crate::source::Sources;
use crate::topology::Parameter;
use scl_plan::{ConstText, ParameterPlan, ParameterType, Scalar};
use scl_text::list::quoted_list;
use std::sync::Arc;

pub(crate) use crate::parse::NO_PARAMETER;
pub(crate) use name::TAKEN;
pub(crate) use value::WRONG_VALUE;
pub(crate) use words::WORDS;

/// SCL1903.
pub(crate) const NO_EFFECT: Rule = Rule {
    code: "SCL1903",
    severity: Severity::Error,
    title: "key that the type of a parameter does not have",
    explanation: "Numbers and durations can have a `range`, numbers a `unit`, and lists a `length`. The default of a \
                  single value stands behind its type, and that of a list or of one of several words behind \
                  `default`. A parameter that can have one value only cannot be changed by `live: true`. Anything else \
                  would have no effect. Remove the key, or choose another type.",
    example: " components:
   - name: controller
     parameters:
-      - label: {text: left, range: [0, 10]}
+      - label: {text: left}
     gates: []
",
};

/// SCL1905.
pub(crate) const OF_KIND: Rule = Rule {
    code: "SCL1905",
    severity: Severity::Error,
    title: "component of a kind with parameters of its own",
    explanation: "All components of a kind have the same parameters, so that one program can run any of them. Declare \
                  them at the kind. Their values may differ: the launch file gives them for each component.",
    example: " kinds:
   - name: motor
     gates:
       - state: {pub: MotorState, unconnected: ok}
+    parameters:
+      - pin: u8
 components:
   - name: left_motor
     kind: motor
-    parameters:
-      - pin: u8
 connections: []
",
};

/// The parameters of all kinds and components, in the order of the model.
pub(super) struct Parameters {
    kinds: Vec<Arc<[Parameter]>>,
    components: Vec<Arc<[Parameter]>>,
}

impl Parameters {
    /// Those of a component, or of its kind.
    pub(super) fn of(&self, component: usize, kind: Option<usize>) -> Arc<[Parameter]> {
        kind.map_or_else(|| Arc::clone(&self.components[component]), |kind| Arc::clone(&self.kinds[kind]))
    }
}

pub(super) fn check(model: &Model, sources: &Sources, problems: &mut Diagnostics) -> Parameters {
    for component in model.components.iter().filter(|component| component.of.is_some()) {
        report_own(component, sources, problems);
    }
    name::check(model, problems);
    words::check(model, problems);
    let mut read =
        |owner: &ComponentModel| owner.parameters.iter().filter_map(|it| plan(it, sources, problems)).collect();
    Parameters {
        kinds: model.kinds.iter().map(&mut read).collect(),
        components: model.components.iter().map(&mut read).collect(),
    }
}

fn report_own(component: &ComponentModel, sources: &Sources, problems: &mut Diagnostics) {
    let (Some(first), Some(entry), Some(kind)) =
        (component.parameters.first(), component.parameters_entry, &component.kind)
    else {
        return;
    };
    let headline = format!("component `{}` is of a kind, and has parameters of its own", component.name.value);
    let found = OF_KIND.at(headline, first.name.span, "").label(kind.span, "all of this kind have the same parameters");
    let found = found.help(format!("declare them at the kind `{}`", kind.value));
    problems.push(match removal(sources.file(entry.file), entry) {
        Some(removed) => found.suggest("or remove them", [removed]),
        None => found,
    });
}

/// The declaration of a parameter; `None` if something is wrong with its type.
fn plan(parameter: &ParameterModel, sources: &Sources, problems: &mut Diagnostics) -> Option<Parameter> {
    let Some(kind) = parameter.declared_type() else {
        report_type(parameter, problems);
        return None;
    };
    let behind = parameter.value.as_ref().filter(|_| matches!(kind, ParameterType::One(_)));
    let default = behind.or(parameter.key("default"));
    value::check_length(parameter, problems);
    value::check_texts(parameter, sources, problems);
    report_without_effect(parameter, &kind, sources, problems);
    let mut declared = ParameterPlan {
        name: parameter.name.value.clone().into(),
        kind,
        default: None,
        range: None,
        unit: text(parameter, "unit"),
        doc: text(parameter, "doc"),
        live: live::is_live(parameter, problems),
        declared_at: ConstText::default(),
    };
    declared.range = value::range(parameter, &declared, problems);
    live::report_constant(parameter, &declared, sources, problems);
    declared.default = default.and_then(|written| value::default(parameter, &declared, written, problems));
    Some(Parameter { declared, span: parameter.name.span })
}

/// Reports a type that cannot be read.
fn report_type(parameter: &ParameterModel, problems: &mut Diagnostics) {
    if parameter.kind.value == ONE_OF {
        let found = NO_PARAMETER.at("`one_of` is a list of words", parameter.kind.span, "");
        problems.push(found.help("write the words in brackets: `{one_of: [manual, auto], default: manual}`"));
        return;
    }
    let at = parameter.value.as_ref().map_or(parameter.kind.span, WrittenValue::span);
    let found = NO_PARAMETER.at("`list` names the type of its items", at, "");
    let found = found.note(format!("types of items: {}", quoted_list(Scalar::WORDS)));
    problems.push(found.help(LIST_FORM));
}

/// Reports keys that the type does not have.
fn report_without_effect(
    parameter: &ParameterModel,
    kind: &ParameterType,
    sources: &Sources,
    problems: &mut Diagnostics,
) {
    for (key, written) in &parameter.keys {
        let scalar = kind.scalar();
        let reason = match key.value.as_str() {
            "range" if !scalar.is_some_and(Scalar::has_range) => "numbers and durations have one",
            "unit" if !scalar.is_some_and(Scalar::is_number) => "numbers have one",
            "length" if !matches!(kind, ParameterType::List(..)) => "lists have one",
            "default" if matches!(kind, ParameterType::One(_)) && parameter.value.is_some() => {
                "its default stands behind its type"
            }
            _ => continue,
        };
        let entry = key.span.to(written.span());
        let headline = format!("`{}` has no effect on a parameter of type `{}`", key.value, parameter.kind.value);
        let found = NO_EFFECT.at(headline, key.span, reason);
        problems.push(found.suggest_removal("remove it", sources.file(entry.file), entry));
    }
}

fn text(parameter: &ParameterModel, key: &str) -> Option<ConstText> {
    parameter.key(key)?.text().map(|text| text.to_owned().into())
}

#[cfg(test)]
mod tests;
