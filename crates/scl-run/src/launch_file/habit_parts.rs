//! What to write for a key of another tool, whose value may have parts that have keys here.

use super::habits::Habit;
use super::likely::{fits, likely, limit_of_restarts};
use super::reader::{Keys, Reader};
use super::words::bare;
use scl_terminal::quoted_list;
use scl_topology::diagnostic::Diagnostic;
use scl_topology::parse::Field;
use scl_topology::yaml::Node;

impl Reader<'_> {
    /// Says why there is no such key, and what to write instead.
    pub(super) fn habit(
        &self,
        problem: Diagnostic,
        field: Field<'_>,
        habit: &Habit,
        keys: &Keys<'_, '_>,
    ) -> Diagnostic {
        let (parts, lost) = parts(field.value, habit, keys);
        let problem = problem.note(habit.instead);
        if parts.is_empty() && !habit.can_go {
            return problem;
        }
        if parts.is_empty() {
            return self.without(problem, field, format!("remove `{}`", field.key));
        }
        let lost = match lost.is_empty() {
            true => String::new(),
            false => format!("; nothing stands for {}", quoted_list(&lost)),
        };
        match self.replace_entry(field, parts.join(&self.separator_of_entries(field))) {
            Some(edit) => problem.suggest(format!("write `{}`{lost}", parts.join("`, `")), [edit]),
            None => problem,
        }
    }
}

/// The entries that stand for the keys of a mapping of another tool, and the keys that nothing stands for.
fn parts<'n>(value: &'n Node, habit: &Habit, keys: &Keys<'_, '_>) -> (Vec<String>, Vec<&'n str>) {
    let mut found: Vec<(usize, &str, &Node)> = Vec::new();
    let mut lost = Vec::new();
    let is_inner = |(name, value): &&(Node, Node)| {
        let is_same = |inner: &Habit| inner.words == habit.words && value.entries().is_some();
        name.text().and_then(Habit::of).is_some_and(is_same)
    };
    let (inner, outer): (Vec<_>, Vec<_>) = value.entries().into_iter().flatten().partition(is_inner);
    for (name, value) in outer.into_iter().chain(inner.iter().filter_map(|(_, value)| value.entries()).flatten()) {
        let Some(name) = name.text() else { continue };
        let bare_name = bare(name);
        match habit.parts.iter().position(|(part, key)| *part == bare_name && keys.get(key).is_none()) {
            Some(at) => found.push((at, name, value)),
            None => lost.push(name),
        }
    }
    found.sort_by_key(|(at, ..)| *at);
    let key = |at: usize| habit.parts.get(at).map_or("", |(_, key)| *key);
    let mut entries = Vec::new();
    for same in found.chunk_by(|(one, ..), (other, ..)| key(*one) == key(*other)) {
        let Some((at, _, value)) = same.first() else { continue };
        let texts: Option<Vec<&str>> = same.iter().map(|(.., value)| value.text()).collect();
        let meant = match (texts.as_deref(), key(*at)) {
            (Some([count, within]), "restart_limit") => {
                limit_of_restarts(&format!("{count} in {within}")).values.into_iter().next()
            }
            (Some([text]), key) if fits(key, value) => Some((*text).to_owned()),
            (_, key) => likely(key, value).values.into_iter().next(),
        };
        match meant {
            Some(value) => entries.push(format!("{}: {value}", key(*at))),
            None => lost.extend(same.iter().map(|(_, name, _)| *name)),
        }
    }
    (entries, lost)
}
