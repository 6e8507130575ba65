//! The differences as text and as JSON.

use super::change::{Change, How};
use super::facts::Fact;
use super::rebuild::Rebuild;
use serde_json::{Map, Value, json};

/// A line a difference (`+` new, `-` gone, `~` differs), then the components to rebuild; nothing if nothing differs.
pub(super) fn report_text(changes: &[Change], rebuilds: &[Rebuild]) -> String {
    let mut text: String = changes.iter().map(change_line).collect();
    if !rebuilds.is_empty() {
        text.push_str("\nto rebuild:\n");
    } else if !changes.is_empty() {
        text.push_str("\nnothing to rebuild\n");
    }
    text.extend(rebuilds.iter().map(|it| format!("  {}: {}\n", it.component, it.reasons.join(", "))));
    text
}

fn change_line(change: &Change) -> String {
    let name = if change.name.is_empty() { String::new() } else { format!(" `{}`", change.name) };
    let (sign, rest) = match &change.how {
        How::Added(facts) => ('+', summary(facts)),
        How::Removed(facts) => ('-', summary(facts)),
        How::Changed(facts) => {
            let facts = facts.iter().map(|(key, old, new)| format!("{key} {} -> {}", shown(old), shown(new)));
            ('~', format!(": {}", facts.collect::<Vec<_>>().join(", ")))
        }
    };
    format!("{sign} {}{name}{rest}\n", change.part)
}

/// Of a gate its kind and type; other parts say enough by their names.
fn summary(facts: &[Fact]) -> String {
    let value = |key| facts.iter().find(|fact| fact.0 == key).map(|fact| fact.1.as_str());
    value("kind").zip(value("type")).map_or_else(String::new, |(kind, payload)| format!(": {kind} {payload}"))
}

fn shown(value: &str) -> &str {
    if value.is_empty() { "nothing" } else { value }
}

/// One object without line breaks but the last:
/// `{"changes":[{"part","name","change","facts"}],"rebuild":[{"component","reasons"}]}`.
///
/// `change` is `added`, `removed` or `changed`; `facts` is an object of values, or of `{"old","new"}` if changed, each
/// `null` where there is no such fact.
pub(super) fn report_json(changes: &[Change], rebuilds: &[Rebuild]) -> String {
    let changes: Vec<Value> = changes.iter().map(change_json).collect();
    let rebuilds: Vec<Value> =
        rebuilds.iter().map(|it| json!({ "component": it.component, "reasons": it.reasons })).collect();
    format!("{}\n", json!({ "changes": changes, "rebuild": rebuilds }))
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
