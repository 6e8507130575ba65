//! SCL0210: a gate as a mapping of its attributes, `{name: measurements, kind: pub}`, as other tools write it.

use super::gate::{RULE, kinds, known_kind};
use crate::diagnostic::{Diagnostic, Edit};
use crate::habits;
use crate::parse::field::{Field, Fields};
use crate::parse::scalar;
use crate::parse::words::is_kind;
use crate::source::{SourceFile, Spanned};
use crate::yaml::Node;

/// Keys of other tools for the name of a gate, and for its kind or type.
const NAMES: [&str; 6] = ["name", "topic", "id", "port", "channel", "gate"];
const KINDS: [&str; 4] = ["kind", "direction", "role", "type"];

/// The entries of `{name: measurements, kind: pub}` with its name and its kind; none if the item is written otherwise.
fn entries<'n>(fields: &Fields<'n>) -> Option<[Field<'n>; 2]> {
    let find = |keys: &[&str]| keys.iter().find_map(|key| fields.get(key));
    let (name, kind) = (find(&NAMES)?, find(&KINDS)?);
    // `topic: pub` is a gate with this name.
    let is_name = name.key == "name" || name.value.text().is_some_and(|text| !is_kind(text));
    is_name.then_some([name, kind])
}

/// Name and kind of `{name: measurements, kind: pub}`; none if the item is written otherwise. With a type in the place
/// of the kind, the kind is empty: it is not known.
pub(in crate::parse) fn parts(fields: &Fields<'_>) -> Option<[Option<Spanned<String>>; 2]> {
    let [name, kind] = entries(fields)?;
    let mut word = scalar(kind.value);
    if let Some(word) = word.as_mut().filter(|word| is_type_alone(&kind, &word.value)) {
        word.value.clear();
    }
    Some([scalar(name.value), word])
}

/// Whether `type: rover.Fix` stands without a kind.
fn is_type_alone(kind: &Field<'_>, value: &str) -> bool {
    kind.key == "type" && known_kind(value).is_none() && value.contains('.')
}

/// `- name: measurements` with `kind: pub` beside it.
pub(in crate::parse) fn diagnose(item: &Node, fields: &Fields<'_>, source: &SourceFile) -> Diagnostic {
    const FORM: &str = "a gate is written `name: kind`, or `name: {kind: type, option: value}`";
    let found = entries(fields);
    let value = |at: usize| found.as_ref().and_then(|found| found[at].value.text());
    let at = fields.list.first().map_or(item.span, |field| field.key_span);
    let problem = RULE.at("a gate is written as `name: kind`", at, "the name itself is the key").note(kinds());
    let (Some(name), Some(kind), Some([name_entry, kind_entry])) = (value(0), value(1), &found) else {
        return problem.help(FORM);
    };
    let is_type = |field: &&Field<'_>| habits::GATE.find(field.key).is_some_and(|habit| habit.is_type());
    let of_type = fields.list.iter().filter(|_| kind_entry.key != "type").find(is_type);
    let is_own = |field: &&Field<'_>| [name_entry, kind_entry].iter().any(|entry| entry.key_span == field.key_span);
    let is_other = |field: &&Field<'_>| !is_own(field) && !is_type(field);
    let options: String = fields
        .list
        .iter()
        .filter(is_other)
        .map(|field| format!(", {}: {}", field.key, source.snippet(field.value.span)))
        .collect();
    let payload = of_type.and_then(|field| field.value.text()).unwrap_or("");
    if source.snippet(item.span).contains('#') || options.contains('\n') {
        return problem.help(FORM);
    }
    let is_flow = source.snippet(item.span).starts_with('{');
    let written = |gate: &str| Edit::new(item.span, if is_flow { format!("{{{gate}}}") } else { gate.to_owned() });
    if is_type_alone(kind_entry, kind) {
        let ways = ["pub", "sub"].map(|word| format!("{name}: {{{word}: {kind}{options}}}"));
        let problem =
            ways.iter().fold(problem, |problem, gate| problem.suggest(format!("write `- {gate}`"), [written(gate)]));
        return problem.otherwise(FORM);
    }
    let kind = known_kind(kind).unwrap_or(kind);
    let gate = match (payload, options.as_str()) {
        ("", "") => format!("{name}: {kind}"),
        _ => format!("{name}: {{{kind}: {payload}{options}}}"),
    };
    problem.propose(format!("write `- {gate}`"), [written(&gate)]).otherwise(FORM)
}
