//! Names of the topology that would become the same name in another language: SCL1101 and SCL1102.

use crate::system::{ChoiceValue, Component, Gate, Instance, MessageUse, Parameter, SenderValue};
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::{MESSAGE_CLASH, NAME_CLASH};
use scl_topology::source::Span;
use std::collections::{HashMap, HashSet};

/// A name that a generated file declares.
#[derive(Debug, Clone)]
pub(crate) struct Declaration {
    /// Where the name is looked up, as messages say it: ``namespace `rover` ``. Equal names of different scopes are
    /// different.
    pub(crate) scope: String,
    /// The identifier.
    pub(crate) name: String,
    /// What it stands for.
    pub(crate) origin: Origin,
}

impl Declaration {
    pub(crate) fn new(scope: impl Into<String>, name: impl Into<String>, origin: Origin) -> Self {
        Self { scope: scope.into(), name: name.into(), origin }
    }
}

/// What a name stands for.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Origin {
    /// For messages: ``component `sensor` ``.
    what: String,
    /// Where it is written; `None` for what the topology file does not name.
    span: Option<Span>,
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Kind {
    Component,
    Gate,
    Parameter,
    Message,
    Generated,
}

impl Origin {
    pub(crate) fn component(component: &Component) -> Self {
        let (what, kind) = match &component.counterpart_of {
            None => {
                let word = if component.is_kind() { "kind" } else { "component" };
                (format!("{word} `{}`", component.name), Kind::Component)
            }
            Some(tested) => (format!("the counterpart of `{tested}`"), Kind::Generated),
        };
        Self { what, span: Some(component.span), kind }
    }

    /// A component of a kind.
    pub(crate) fn instance(instance: &Instance) -> Self {
        Self { what: format!("component `{}`", instance.name), span: Some(instance.span), kind: Kind::Component }
    }

    pub(crate) fn gate(component: &Component, gate: &Gate) -> Self {
        let owner = component.counterpart_of.as_ref().unwrap_or(&component.name);
        Self { what: format!("gate `{owner}.{}`", gate.name), span: Some(gate.span), kind: Kind::Gate }
    }

    /// A gate that sends to a gate with several peers.
    pub(crate) fn sender(component: &Component, gate: &Gate, sender: &SenderValue) -> Self {
        let of = sender.path.as_deref().unwrap_or(&sender.class_name);
        let what = format!("the sender `{of}` of gate `{}.{}`", component.name, gate.name);
        Self { what, span: Some(gate.span), kind: Kind::Generated }
    }

    pub(crate) fn parameter(component: &Component, parameter: &Parameter) -> Self {
        let what = format!("parameter `{}.{}`", component.name, parameter.name);
        Self { what, span: Some(parameter.span), kind: Kind::Parameter }
    }

    /// A word that a parameter can be.
    pub(crate) fn choice(component: &Component, parameter: &Parameter, value: &ChoiceValue) -> Self {
        let what = format!("value `{}` of parameter `{}.{}`", value.word, component.name, parameter.name);
        Self { what, span: Some(parameter.span), kind: Kind::Parameter }
    }

    /// A message that a gate carries.
    pub(crate) fn message(used: &MessageUse) -> Self {
        Self { what: format!("message `{}`", used.dotted), span: Some(used.span), kind: Kind::Message }
    }

    /// A message that is in the schemas, but at no gate.
    pub(crate) fn other_message(dotted: &str) -> Self {
        Self { what: format!("message `{dotted}`"), span: None, kind: Kind::Message }
    }

    /// A name of SCL's own, for example ``method `close` ``.
    pub(crate) fn generated(what: impl Into<String>) -> Self {
        Self { what: what.into(), span: None, kind: Kind::Generated }
    }
}

/// Reports declarations of the same name in the same scope that stand for different things.
pub(crate) fn find(declarations: &[Declaration]) -> Vec<Diagnostic> {
    let mut first: HashMap<(&str, &str), &Declaration> = HashMap::new();
    let mut told: HashSet<(&Origin, &Origin)> = HashSet::new();
    let mut found = Vec::new();
    for declaration in declarations {
        let other = *first.entry((&declaration.scope, &declaration.name)).or_insert(declaration);
        // The same two origins may clash in many generated names; report only the first.
        let pair = (&other.origin, &declaration.origin);
        if other.origin != declaration.origin && told.insert(pair) {
            found.push(report(declaration, &other.origin, &declaration.origin));
        }
    }
    found
}

fn report(declaration: &Declaration, first: &Origin, second: &Origin) -> Diagnostic {
    let Declaration { scope, name, .. } = declaration;
    let rule = match (first.kind, second.kind) {
        (Kind::Component, Kind::Message) | (Kind::Message, Kind::Component) => &MESSAGE_CLASH,
        _ => &NAME_CLASH,
    };
    let headline = format!("{} and {} would both become `{name}` in {scope}", first.what, second.what);
    // Suggest the easier rename: components and gates rather than messages, which other programs may use.
    let [other, renamed] = match (first.kind, second.kind) {
        (_, Kind::Component | Kind::Gate | Kind::Parameter) | (Kind::Generated, _) => [first, second],
        _ => [second, first],
    };
    let mut problem = match renamed.span.or(other.span) {
        Some(span) => rule.at(headline, span, format!("becomes `{name}`")),
        None => rule.without_place(headline),
    };
    if let (Some(_), Some(span)) = (renamed.span, other.span) {
        problem = problem.label(span, format!("{} becomes `{name}`", other.what));
    }
    problem.help(format!("rename the {}", renamed.what))
}
