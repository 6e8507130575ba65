//! The terminal, which only one component may have.

use super::reader::{Keys, Reader};
use super::rules::CONTRADICTION;
use scl_topology::parse::Field;
use scl_topology::yaml::Node;

impl Reader<'_> {
    /// Reports two components with `input: terminal`, unless a profile decides which of them has it.
    pub(super) fn check_terminal(&mut self, components: &[Field<'_>], top: &Keys<'_, '_>) {
        let with_terminal: Vec<_> = components.iter().filter_map(|field| terminal(*field)).collect();
        with_terminal.iter().for_each(|(name, input)| self.check_terminal_of_kind(name, *input, components));
        let with_terminal: Vec<_> = with_terminal.into_iter().take(2).collect();
        let [(first, one), (second, other)] = with_terminal.as_slice() else { return };
        let profiles = top.get("profiles").and_then(|field| field.value.entries()).unwrap_or_default();
        let entries = profiles.iter().filter_map(|(_, profile)| profile.entries()).flatten();
        let is_one = |name: &Node| name.text().is_some_and(|name| name == *first || name == *second);
        if entries.into_iter().any(|(name, entry)| is_one(name) && decides_input(entry)) {
            return;
        }
        let message = format!("the components `{first}` and `{second}` both have `input: terminal`");
        let whole = |field: &Field<'_>| field.key_span.to(field.value.span);
        let problem = CONTRADICTION.at(message, whole(other), "").label(whole(one), "first here");
        let ways = [(first, one), (second, other)];
        let problem = ways.into_iter().fold(problem, |problem, (name, field)| match self.remove_entry(*field) {
            Some(edit) => problem.suggest(format!("remove `input` from `{name}`"), [edit]),
            None => problem,
        });
        self.report(problem.note("only one component can read from the terminal"));
    }
}

/// Whether an entry that changes another one sets its `input`, or resets it.
pub(super) fn decides_input(entry: &Node) -> bool {
    let mut keys = entry.entries().into_iter().flatten().filter_map(|(key, _)| key.text());
    keys.any(|key| matches!(key, "input" | "command" | "replay"))
}

/// The name of a component and its `input`, if that is the terminal.
fn terminal<'n>(component: Field<'n>) -> Option<(&'n str, Field<'n>)> {
    let (key, value) = component.value.entries()?.iter().find(|(key, _)| key.text() == Some("input"))?;
    let field = Field { key: "input", key_span: key.span, key_node: key, value };
    (value.text() == Some("terminal")).then_some((component.key, field))
}
