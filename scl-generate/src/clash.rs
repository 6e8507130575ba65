//! Names of the topology that would be one name in another language: SCL1101 and SCL1102.

use crate::system::{Component, Gate, MessageUse};
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::{MESSAGE_CLASH, NAME_CLASH};
use scl_topology::source::Span;
use std::collections::HashMap;

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

/// What a name stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Origin {
    /// For messages: ``component `sensor` ``.
    what: String,
    /// Where it is written; `None` for what the topology file does not name.
    span: Option<Span>,
    is_message: bool,
}

impl Origin {
    pub(crate) fn component(component: &Component) -> Self {
        Self { what: format!("component `{}`", component.name), span: Some(component.span), is_message: false }
    }

    pub(crate) fn gate(component: &Component, gate: &Gate) -> Self {
        Self { what: format!("gate `{}.{}`", component.name, gate.name), span: Some(gate.span), is_message: false }
    }

    /// A message that a gate carries.
    pub(crate) fn message(used: &MessageUse) -> Self {
        Self { what: format!("message `{}`", used.dotted), span: Some(used.span), is_message: true }
    }

    /// A message that is in the schemas, but at no gate.
    pub(crate) fn other_message(dotted: &str) -> Self {
        Self { what: format!("message `{dotted}`"), span: None, is_message: true }
    }

    /// A name of SCL's own, for example ``method `close` ``.
    pub(crate) fn generated(what: impl Into<String>) -> Self {
        Self { what: what.into(), span: None, is_message: false }
    }

    fn is_generated(&self) -> bool {
        self.span.is_none() && !self.is_message
    }
}

/// Every two declarations of one name in one scope that stand for different things.
pub(crate) fn find(declarations: &[Declaration]) -> Vec<Diagnostic> {
    let mut first: HashMap<(&str, &str), &Declaration> = HashMap::new();
    let mut told: Vec<(&Origin, &Origin)> = Vec::new();
    let mut found = Vec::new();
    for declaration in declarations {
        let other = *first.entry((&declaration.scope, &declaration.name)).or_insert(declaration);
        // Many names may come from one component; one of them tells enough.
        let pair = (&other.origin, &declaration.origin);
        if other.origin != declaration.origin && !told.contains(&pair) {
            told.push(pair);
            found.push(report(declaration, &other.origin, &declaration.origin));
        }
    }
    found
}

fn report(declaration: &Declaration, first: &Origin, second: &Origin) -> Diagnostic {
    let Declaration { scope, name, .. } = declaration;
    let rule = if first.is_message != second.is_message { &MESSAGE_CLASH } else { &NAME_CLASH };
    let headline = format!("{} and {} would both become `{name}` in {scope}", first.what, second.what);
    // What can be renamed most easily comes last: a component or a gate rather than a message.
    let [other, renamed] = if first.is_message || first.is_generated() || second.span.is_some() && !second.is_message {
        [first, second]
    } else {
        [second, first]
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
