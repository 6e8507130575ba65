//! `inputs: {image: camera.image}` of a component: gates and connections in one, as other tools write them.

use super::ends::with_dot;
use super::reference::is_type;
use crate::diagnostic::{Diagnostic, Edit, separator};
use crate::habits::Habit;
use crate::parse::field::Field;
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};
use scl_text::list::quoted_list;

/// Maximum number of ports that are written as gates.
const MOST: usize = 16;

/// Adds the gates that are meant, and their connections, which belong below the `last` one.
pub(super) fn with_gates(
    problem: Diagnostic,
    habit: &Habit,
    field: Field<'_>,
    component: &str,
    last: Option<Span>,
    source: &SourceFile,
) -> Diagnostic {
    let Some(kind) = habit.port() else { return problem };
    let whole = field.key_span.to(field.value.span);
    let ports = ports(field.value).filter(|ports| !ports.is_empty() && ports.len() <= MOST);
    let Some(ports) = ports.filter(|_| !source.snippet(whole).contains('#')) else { return problem };
    let gates: Vec<String> = ports.iter().map(|port| port.gate(kind)).collect();
    let gates = format!("gates: [{}]", gates.join(", "));
    let pairs: Vec<String> = ports.iter().filter_map(|port| port.pair(component)).collect();
    let gates_edit = Edit::new(whole, gates.clone());
    match last.and_then(|last| Some((last, separator(source, last)?))) {
        _ if pairs.is_empty() => problem.suggest(format!("write `{gates}`"), [gates_edit]),
        None => problem.help(format!("write `{gates}`, and in `connections` {}", quoted_list(&pairs))),
        Some((last, separator)) => {
            let end = match separator.starts_with('\n') {
                true => source.line_range(last.end as usize).end,
                false => last.end as usize,
            };
            let added: String = pairs.iter().map(|pair| format!("{separator}{pair}")).collect();
            let text = format!("write `{gates}`, and in `connections` {}", quoted_list(&pairs));
            problem.suggest(text, [gates_edit, Edit::new(source.span(end..end), added)])
        }
    }
}

/// A gate, and what it carries or is connected to.
struct Port {
    name: String,
    of: Option<String>,
}

impl Port {
    fn is_typed(&self) -> bool {
        let last = self.of.as_deref().and_then(|of| of.rsplit('.').next());
        last.is_some_and(|last| last.starts_with(|letter: char| letter.is_ascii_uppercase()))
    }

    fn gate(&self, kind: &str) -> String {
        match &self.of {
            Some(of) if self.is_typed() => format!("{}: {{{kind}: {of}}}", self.name),
            _ => format!("{}: {kind}", self.name),
        }
    }

    fn pair(&self, component: &str) -> Option<String> {
        let of = self.of.as_ref().filter(|_| !self.is_typed())?;
        Some(format!("[{of}, {component}.{}]", self.name))
    }
}

/// `{image: camera.image}`, `{image: hive.Image}`, `[camera.image]` or `[image]`.
fn ports(value: &Node) -> Option<Vec<Port>> {
    let end = |node: &Node| node.text().map(with_dot).filter(|end| is_type(end) && end.split('.').count() == 2);
    match &value.kind {
        NodeKind::Mapping { entries } => {
            let port = |(name, of): &(Node, Node)| {
                let name = name.text()?.to_owned();
                Some(Port { name, of: if of.is_null() { None } else { Some(end(of)?) } })
            };
            entries.iter().map(port).collect()
        }
        NodeKind::Sequence { items } => {
            let port = |item: &Node| match end(item) {
                Some(of) => Some(Port { name: of.split_once('.')?.1.to_owned(), of: Some(of) }),
                None => item.text().filter(|name| is_type(name)).map(|name| Port { name: name.to_owned(), of: None }),
            };
            items.iter().map(port).collect()
        }
        _ => None,
    }
}
