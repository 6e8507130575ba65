//! Profiles, and entries of components, that stand in each other's place.

use crate::launch_file::keys;
use crate::launch_file::reader::Reader;
use crate::launch_file::rules::WRONG_SHAPE;
use crate::launch_file::value::texts;
use scl_terminal::quoted_list;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;

/// The name of a profile in a proposal.
const EXAMPLE: &str = "simulation";

/// Maximum number of entries that a key is moved to.
const MOST_MOVED: usize = 4;

impl Reader<'_> {
    /// The problem of entries of components that stand where profiles are expected.
    pub(super) fn without_profile(&self, profiles: &[Field<'_>], started: &[String]) -> Option<Diagnostic> {
        let is_entry = |field: &Field<'_>| {
            let is_started = started.iter().any(|known| known == field.key);
            is_started && field.value.entries().is_some_and(|entries| are_keys(entries, started))
        };
        let first = profiles.first().filter(|_| profiles.iter().all(is_entry))?;
        let message = format!("`profiles` has the entry of component `{}` in place of a profile", first.key);
        let others = profiles.iter().skip(1).map(|other| (other.key_span, "this one too"));
        let problem = WRONG_SHAPE.at(message, first.key_span, "").labels(others);
        let column = self.source.column(first.key_span.start);
        let indented = profiles.iter().map(|field| self.indented_to(column + 2, field.key_node, field.value));
        let moved: Option<Vec<Vec<Edit>>> = indented.collect();
        let problem = match moved.map(|edits| edits.concat()).filter(|edits| !edits.is_empty()) {
            Some(mut edits) => {
                edits[0].replacement = format!("{}{EXAMPLE}:\n{}", " ".repeat(column), edits[0].replacement);
                let all = if profiles.len() == 1 { "its entry" } else { "the entries" };
                problem
                    .suggest(format!("write the name of the profile above, like `{EXAMPLE}:`, and indent {all}"), edits)
            }
            None => problem.help(format!("write the name of the profile before it: `{{{EXAMPLE}: {{...}}}}`")),
        };
        Some(problem.note("`profiles` is a mapping from names of profiles to their entries of components"))
    }

    /// The problem of a profile that has the keys of an entry in place of components.
    pub(super) fn without_component(
        &self,
        field: Field<'_>,
        entries: &[(Node, Node)],
        started: &[String],
    ) -> Option<Diagnostic> {
        if !are_keys(entries, started) || entries.iter().any(|(_, value)| value.entries().is_some()) {
            return None;
        }
        let (first, last) = (entries.first()?, entries.last()?);
        let name = field.key;
        let message = format!("profile `{name}` has the key `{}` in place of components", first.0.text()?);
        let problem =
            WRONG_SHAPE.at(message, first.0.span, "").note("a profile is a mapping from components to entries");
        let all = first.0.span.to(last.1.span);
        let entry = self.written(all);
        // The component whose program it is: the one that the entry names, or the only one.
        let named: Vec<&String> = started.iter().filter(|name| entry.contains(name.as_str())).collect();
        let likely = if named.is_empty() && started.len() < 4 { started.iter().collect() } else { named };
        let column = self.source.column(all.start);
        Some(likely.into_iter().take(3).fold(problem, |problem, component| {
            let (help, text) = match entry.contains('\n') {
                false => (format!("write `{component}: {{{entry}}}`"), format!("{component}: {{{entry}}}")),
                true => {
                    let inner = format!("\n{}  {}", " ".repeat(column), entry.replace('\n', "\n  "));
                    (format!("write `{component}:` above it, and indent it"), format!("{component}:{inner}"))
                }
            };
            problem.suggest(help, [Edit::new(all, text)])
        }))
    }

    /// The entries of components in a profile, and the problems of keys that stand beside them.
    pub(super) fn without_keys<'n>(
        &self,
        profile: Field<'_>,
        entries: Vec<Field<'n>>,
        started: &[String],
    ) -> (Vec<Field<'n>>, Vec<Diagnostic>) {
        let is_name = |field: &Field<'_>| {
            let is_key = keys::COMPONENT.iter().chain(keys::TOP).any(|key| key.name == field.key);
            !is_key || self.is_component(field.key) || started.iter().any(|name| name == field.key)
        };
        let (entries, keys): (Vec<_>, Vec<_>) = entries.into_iter().partition(is_name);
        let problems = keys.into_iter().map(|key| {
            let message = format!("profile `{}` has the key `{}` in place of a component", profile.key, key.key);
            let problem = WRONG_SHAPE.at(message, key.key_span, "").note("a profile holds entries of components only");
            if keys::COMPONENT.iter().all(|known| known.name != key.key) {
                return problem.help(format!("`{}` belongs at the top of the file", key.key));
            }
            let moved = || {
                let entry = format!("{}: {}", key.key, self.in_brackets(key.value)?);
                let mut edits = vec![self.remove_entry(key)?];
                for component in entries.iter().take(MOST_MOVED) {
                    edits.push(self.add_entry(component.value, &entry)?);
                }
                (entries.len() <= MOST_MOVED && !entries.is_empty()).then_some(edits)
            };
            let names = quoted_list(entries.iter().take(MOST_MOVED).map(|component| component.key));
            let text = format!("`{}` belongs into the entries of components", key.key);
            match moved() {
                Some(edits) => problem.suggest(format!("{text}: move it to {names}"), edits).otherwise(text),
                None => {
                    let example = started.first().filter(|_| entries.is_empty()).map_or("component", String::as_str);
                    problem.help(format!("{text}: `{example}: {{{}: ...}}`", key.key))
                }
            }
        });
        let problems = problems.collect();
        (entries, problems)
    }

    /// Proposes to move an entry of `components`, which names its profile as in Docker Compose, into that profile.
    pub(in crate::launch_file) fn moved_to_profile(
        &self,
        problem: Diagnostic,
        field: Field<'_>,
        component: &str,
    ) -> Diagnostic {
        let profile = match texts(field.value).unwrap_or_default().as_slice() {
            [one] => one.clone(),
            _ => field.value.text().unwrap_or("debug").to_owned(),
        };
        let text = format!(
            "move the entry from `components` into a profile, at the top of the file: `profiles: {{{profile}: \
             {{{component}: {{command: ...}}}}}}`"
        );
        let moved = || {
            let root = self.root.filter(|root| !self.is_flow(root) && self.top_value("profiles").is_none())?;
            let entries = self.top_value("components")?.entries()?;
            let (key, value) = entries.iter().find(|(key, _)| key.text() == Some(component))?;
            let whole = Field { key: component, key_span: key.span, key_node: key, value };
            let removed = self.remove_entry(whole).filter(|_| !self.written(value.span).contains('#'))?;
            let others = value.entries()?.iter().filter(|(key, _)| key.span != field.key_span);
            let others = others.map(|(key, value)| self.written(key.span.to(value.span)));
            let entry = match self.is_flow(value) {
                true => format!(" {{{}}}", others.collect::<Vec<_>>().join(", ")),
                false => {
                    let old = format!("\n{}", " ".repeat(self.source.column(value.span.start)));
                    others.map(|entry| format!("\n      {}", entry.replace(&old, "\n      "))).collect()
                }
            };
            let text = format!("profiles:\n  {profile}:\n    {component}:{entry}");
            let added = self.add_last(root, &text)?;
            // The last entry of the file: write the profile in its place.
            let is_last = (removed.span.start..removed.span.end).contains(&added.span.start);
            let in_place = Edit::new(removed.span, format!("{text}\n"));
            (texts(field.value).is_none_or(|names| names.len() == 1))
                .then(|| if is_last { vec![in_place] } else { vec![removed, added] })
        };
        match moved() {
            Some(edits) => problem.suggest(text.clone(), edits).otherwise(text),
            None => problem.help(text),
        }
    }

    /// The problem of a profile whose entries stand in one more `components`.
    pub(super) fn with_components(&self, field: Field<'_>, entries: &[(Node, Node)]) -> Option<Diagnostic> {
        let [(key, inner)] = entries else { return None };
        let first = inner.entries()?.first().filter(|_| key.text() == Some("components"))?.0.span;
        if self.is_component("components") {
            return None;
        }
        let message = format!("profile `{}` has `components` in place of their entries", field.key);
        let problem = WRONG_SHAPE.at(message, key.span, "").note("a profile is a mapping from components to entries");
        let written = self.written(inner.span);
        let column = |span: Span| self.source.column(span.start);
        let deeper = "\n".to_owned() + &" ".repeat(column(first).saturating_sub(column(key.span)));
        let text = match (self.is_flow(inner), self.is_flow(field.value)) {
            (true, true) => written.trim_matches(['{', '}']).to_owned(),
            (true, false) => return Some(problem),
            _ => written.replace(&deeper, "\n"),
        };
        Some(problem.propose("remove `components:`", [Edit::new(key.span.to(inner.span), text)]))
    }
}

/// Whether there are entries, and all of them are keys of a component's entry and not components.
fn are_keys(entries: &[(Node, Node)], started: &[String]) -> bool {
    let is_key = |(key, _): &(Node, Node)| {
        let key = key.text().unwrap_or_default();
        keys::COMPONENT.iter().any(|known| known.name == key) && !started.iter().any(|name| name == key)
    };
    !entries.is_empty() && entries.iter().all(is_key)
}
