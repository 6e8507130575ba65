//! `parameters`: values for the parameters of components, checked against their declarations in the topology.

use super::reader::{Keys, Reader, value_span, wrong};
use super::rules::{UNKNOWN_NAME, WRONG_VALUE};
use super::value::{shown, text, texts};
use super::words::flow_word;
use scl_plan::{ParameterPlan, ParameterType, Scalar, list_text};
use scl_terminal::quoted_list;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::{Field, meant_values};
use scl_topology::suggest::similar;
use scl_topology::yaml::{Node, NodeKind};

impl Reader<'_> {
    /// Reads the values in the entry of a component or a kind, in file order.
    pub(super) fn read_parameters(&mut self, keys: &Keys<'_, '_>, owner: &str) -> Vec<(String, String)> {
        let values = self.named_entries(keys, "parameters", |reader, problem, field| {
            let problem = reader.as_variables(problem, field);
            problem.otherwise("each value is an entry: the name of a parameter, a colon, a space and the value")
        });
        // A kind without components shows no parameters.
        let is_checked = !self.is_unknown(owner) && !self.components_of(owner).is_some_and(<[String]>::is_empty);
        let declared = self.known.filter(|_| is_checked).map(|known| known.parameters_of(owner));
        match (declared, keys.section("parameters")) {
            (Some([]), Some(field)) if !values.is_empty() => {
                self.report_needless(field, owner);
                Vec::new()
            }
            _ => values.iter().filter_map(|field| self.read_parameter(*field, owner, declared)).collect(),
        }
    }

    /// Reports `parameters` of a component that has none.
    fn report_needless(&mut self, field: Field<'_>, owner: &str) {
        let problem = UNKNOWN_NAME.at(format!("{} has no parameters", self.owner(owner)), field.key_span, "");
        let problem = match self.remove_entry(field) {
            Some(edit) => problem.suggest("remove `parameters`", [edit]),
            None => problem,
        };
        self.report(problem.note("the topology declares the parameters of its components"));
    }

    /// Reads one value; `declared` are the parameters of its component where there is a topology.
    fn read_parameter(
        &mut self,
        field: Field<'_>,
        owner: &str,
        declared: Option<&[ParameterPlan]>,
    ) -> Option<(String, String)> {
        let name = field.key;
        let plan = declared.map(|declared| declared.iter().find(|plan| plan.name == name));
        if let (Some(None), Some(declared)) = (plan, declared) {
            let names: Vec<&str> = declared.iter().map(|plan| &*plan.name).collect();
            let message = format!("{} has no parameter `{name}`", self.owner(owner));
            let problem = UNKNOWN_NAME.at(message, field.key_span, "");
            let problem = problem.did_you_mean(name, &similar(name, names.iter().copied()));
            self.report(problem.note(format!("it has the parameters {}", quoted_list(names))));
            return None;
        }
        if matches!(field.value.kind, NodeKind::Unread) {
            return None;
        }
        let items = || texts(field.value).map(list_text);
        let Some(value) = text(field.value).map(str::to_owned).or_else(items) else {
            let problem = self.wrong_shape(field, owner, plan.flatten());
            self.report(problem);
            return None;
        };
        if let Some(plan) = plan.flatten()
            && let Err(reason) = check(plan, field.value, &value)
        {
            let problem = self.wrong_parameter(field, owner, plan, &reason);
            self.report(problem);
            return None;
        }
        Some((name.to_owned(), value))
    }

    /// The problem of a value that is neither a scalar nor a list of scalars.
    fn wrong_shape(&self, field: Field<'_>, owner: &str, plan: Option<&ParameterPlan>) -> Diagnostic {
        let name = field.key;
        if let Some(item) = field.value.items().and_then(|items| items.iter().find(|item| text(item).is_none())) {
            let message = format!("an item of parameter `{owner}.{name}` is a text or a number, not {}", shown(item));
            return WRONG_VALUE.at(message, if item.is_null() { field.value.span } else { item.span }, "");
        }
        let found = shown(field.value);
        let message = format!("parameter `{owner}.{name}` is a text, a number or a list of them, not {found}");
        let problem = self.with_template(wrong(&WRONG_VALUE, message, field), field.value);
        match field.value.is_null() && plan.is_some_and(|plan| plan.kind == ParameterType::One(Scalar::Text)) {
            true => self.other_entry(problem, field, format!("{name}: \"\"")),
            false => problem,
        }
    }

    /// The problem of a value that the parameter cannot have.
    fn wrong_parameter(&self, field: Field<'_>, owner: &str, plan: &ParameterPlan, reason: &str) -> Diagnostic {
        let name = field.key;
        let message = format!("parameter `{owner}.{name}` cannot have this value");
        let problem = WRONG_VALUE.at(message, value_span(field), reason);
        let problem = self.with_template(problem, field.value);
        let text = field.value.text();
        text.map(|text| meant_values(plan, text)).unwrap_or_default().into_iter().fold(problem, |problem, value| {
            let value = if value.starts_with('[') { value } else { flow_word(&value) };
            problem.suggest(format!("did you mean `{name}: {value}`?"), [Edit::new(field.value.span, value)])
        })
    }
}

/// Checks a value.
fn check(plan: &ParameterPlan, node: &Node, value: &str) -> Result<(), String> {
    let is_list = node.items().is_some();
    match &plan.kind {
        ParameterType::One(_) | ParameterType::OneOf(_) if is_list => {
            Err("expected one value, found a list".to_owned())
        }
        ParameterType::List(..) if !is_list => Err("a list is written in brackets: `[1, 2]`".to_owned()),
        _ => plan.read(value).map(drop),
    }
}

#[cfg(test)]
mod tests;
