//! The differences as text and as JSON.

use super::change::{Change, How};
use super::facts::Fact;
use super::rebuild::Rebuild;
use super::together::Group;
use serde_json::{Map, Value, json};

/// Returns one line per difference (`+` new, `-` gone, `~` differs), then the components to rebuild, those that must be
/// rebuilt together first; empty if nothing differs.
pub(super) fn report_text(changes: &[Change], groups: &[Group]) -> String {
    let mut text: String = changes.iter().map(change_line).collect();
    if groups.is_empty() && !changes.is_empty() {
        text.push_str("\nnothing to rebuild\n");
    }
    let (together, alone): (Vec<&Group>, Vec<&Group>) = groups.iter().partition(|group| group.len() > 1);
    for group in together {
        text.push_str("\nto rebuild together:\n");
        text.extend(group.iter().map(rebuild_line));
    }
    if !alone.is_empty() {
        text.push_str("\nto rebuild:\n");
        text.extend(alone.into_iter().flatten().map(rebuild_line));
    }
    text
}

fn rebuild_line(it: &Rebuild) -> String {
    format!("  {}: {}\n", it.component, it.reasons.join(", "))
}

fn change_line(change: &Change) -> String {
    let name = if change.name.is_empty() { String::new() } else { format!(" `{}`", change.name) };
    let (sign, rest) = match &change.how {
        How::Added(facts) => ('+', summary(facts)),
        How::Removed(facts) => ('-', summary(facts)),
        How::Changed(facts) => {
            // Not `old -> new`, because types may contain `->`.
            let facts = facts.iter().map(|(key, old, new)| format!("{key} from {} to {}", shown(old), shown(new)));
            ('~', format!(": {}", facts.collect::<Vec<_>>().join(", ")))
        }
    };
    format!("{sign} {}{name}{rest}\n", change.part)
}

/// Returns the kind and type of a gate; empty for other parts, whose names say enough.
fn summary(facts: &[Fact]) -> String {
    let value = |key| facts.iter().find(|fact| fact.0 == key).map(|fact| fact.1.as_str());
    value("kind").zip(value("type")).map_or_else(String::new, |(kind, payload)| format!(": {kind} {payload}"))
}

fn shown(value: &str) -> String {
    if value.is_empty() { "nothing".to_owned() } else { format!("`{value}`") }
}

/// One object without line breaks but the last:
/// `{"changes":[{"part","name","change","facts"}],"rebuild":[{"component","reasons"}],"together":[["component"]]}`.
///
/// `change` is `added`, `removed` or `changed`; `facts` is an object of values, or of `{"old","new"}` if changed, each
/// `null` where there is no such fact. `together` has every component to rebuild, with those that must be rebuilt with
/// it.
pub(super) fn report_json(changes: &[Change], groups: &[Group]) -> String {
    let changes: Vec<Value> = changes.iter().map(change_json).collect();
    let rebuild = |it: &Rebuild| json!({ "component": it.component, "reasons": it.reasons });
    let rebuilds: Vec<Value> = groups.iter().flatten().map(rebuild).collect();
    let names = |group: &Group| group.iter().map(|it| it.component.clone()).collect::<Vec<_>>();
    let together: Vec<Vec<String>> = groups.iter().map(names).collect();
    format!("{}\n", json!({ "changes": changes, "rebuild": rebuilds, "together": together }))
}

fn change_json(change: &Change) -> Value {
    let all = |facts: &[Fact]| facts.iter().map(|(key, value)| ((*key).to_owned(), json!(value))).collect();
    let or_null = |value: &String| Some(value.clone()).filter(|value| !value.is_empty());
    let (word, facts): (&str, Map<String, Value>) = match &change.how {
        How::Added(facts) => ("added", all(facts)),
        How::Removed(facts) => ("removed", all(facts)),
        How::Changed(facts) => {
            let pair = |old, new| json!({ "old": or_null(old), "new": or_null(new) });
            ("changed", facts.iter().map(|(key, old, new)| ((*key).to_owned(), pair(old, new))).collect())
        }
    };
    json!({ "part": change.part, "name": change.name, "change": word, "facts": facts })
}
