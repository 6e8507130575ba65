//! What is said about types that no schema declares.

use super::draft::Draft;
use super::rust_path::{is_bytes, is_scalar};
use super::schema_names::{Known, Unknown};
use super::schema_package::{by_mistake, retyped, with_places, wrong_package};
use crate::diagnostic::{Diagnostic, Rule};
use crate::source::Span;
use crate::topology::Payload;
use scl_text::list::listed;
use scl_text::suggest::bare;
use std::collections::{HashMap, HashSet};

/// What the reports of a file need.
pub(super) struct Report<'r> {
    rule: &'static Rule,
    draft: &'r Draft<'r>,
    known: &'r Known<'r>,
    /// For gates whose own types are not known, a gate at the other end of a connection.
    partners: HashMap<usize, usize>,
    /// The messages that gates carry.
    used: HashSet<&'r str>,
}

impl<'r> Report<'r> {
    pub(super) fn new(rule: &'static Rule, draft: &'r Draft<'r>, known: &'r Known<'r>) -> Self {
        let mut partners = HashMap::new();
        for link in &draft.model.connections {
            let [Some(one), Some(two)] = link.ends.each_ref().map(|end| draft.find(&end.value)) else { continue };
            for (gate, other) in [(one, two), (two, one)] {
                if draft.gates[gate].payload.is_none() && draft.gates[other].payload.is_some() {
                    partners.entry(gate).or_insert(other);
                }
            }
        }
        Self { rule, draft, known, partners, used: draft.messages_used() }
    }

    pub(super) fn of(&self, unknown: Vec<Unknown<'_>>) -> Vec<Diagnostic> {
        let told = by_mistake(unknown).into_iter().filter_map(|group| {
            let found = wrong_package(self.rule, self.draft, &group, true);
            let found = found.or_else(|| self.of_name(&group))?;
            Some(match self.known.all.is_empty() {
                true => found.note("the `schemas` declare no message types"),
                false => found.note(format!("message types in `schemas`: {}", listed(self.known.all.keys()))),
            })
        });
        told.collect()
    }

    /// All places of one type.
    fn of_name(&self, group: &[Unknown<'_>]) -> Option<Diagnostic> {
        let first = group.first()?;
        let dotted = first.name.dotted();
        let is_enum = self.known.users_of_enum(dotted).is_some();
        let is_built_in = dotted.starts_with("google.protobuf.");
        let (headline, label) = if is_enum {
            (format!("`{dotted}` is an enum, not a message"), "an enum of the `schemas`")
        } else if is_built_in {
            (format!("`{dotted}` is not a message of the `schemas`"), "protobuf's own, for fields of messages")
        } else {
            (format!("unknown message type `{dotted}`"), "not in the schemas")
        };
        let found = with_places(self.rule.at(headline, first.name.span(), label), group);
        let partner = group.iter().find_map(|one| self.partner(one));
        let meant = match partner {
            Some((message, _)) if first.meant.contains(&message) => vec![message],
            _ => first.meant.clone(),
        };
        let all = |to: &str| retyped(self.draft, group, to);
        let mut found = found
            .labels(self.declaration(&meant))
            .choose_all(("did you mean ", "?"), meant.iter().map(|&name| (name, all(name))));
        if is_enum {
            found.doubt();
        }
        let is_value = is_enum || is_built_in || is_scalar(dotted);
        let found = match is_bytes(dotted) && group.iter().all(|one| self.is_only_type(one)) {
            true => found.suggest("write nothing after the colon: a gate without a type carries bytes", all("")),
            false => found,
        };
        let found = match partner.filter(|(message, _)| !meant.contains(message)) {
            Some((message, peer)) => found.suggest(format!("write `{message}`, as at `{peer}`"), all(message)),
            None if !is_value || !meant.is_empty() => found,
            None => match (self.namesake(first), self.only_unused()) {
                (Some(name), _) => found.suggest(format!("write `{name}`, which has the name of the gate"), all(name)),
                (None, Some(unused)) => {
                    found.suggest(format!("write `{unused}`, which no gate carries yet"), all(unused))
                }
                (None, None) => found,
            },
        };
        let is_path = !self.known.has_root(dotted) && !is_scalar(dotted) && !is_enum;
        let found = found.helps(is_path.then(|| format!("a Rust type of your own has a path: `crate.{dotted}`")));
        Some(match is_value {
            true => found.otherwise("a gate carries a message, which may have a field of this type"),
            false => found,
        })
    }

    /// The message at the other end of a connection, and the gate there.
    fn partner(&self, unknown: &Unknown<'_>) -> Option<(&str, String)> {
        let peer = *self.partners.get(&unknown.gate)?;
        let types = self.draft.gates[peer].payload.as_ref().map(Payload::types)?;
        let message = types.get(unknown.part).filter(|message| message.in_schemas())?;
        Some((message.dotted(), self.draft.path(peer)))
    }

    /// The entry of `schemas` that declares the only message that may be meant.
    fn declaration(&self, meant: &[&str]) -> Option<(Span, String)> {
        let [only] = meant else { return None };
        let entry = self.draft.model.schemas.get(*self.known.all.get(only)?)?;
        Some((entry.span, format!("declares `{only}`")))
    }

    /// Whether a type is the only one of its gate.
    fn is_only_type(&self, unknown: &Unknown<'_>) -> bool {
        let written = self.draft.gates[unknown.gate].model.payload.as_ref();
        written.is_some_and(|written| written.value.trim() == unknown.name.dotted())
    }

    /// The message with the name of the gate.
    fn namesake(&self, unknown: &Unknown<'_>) -> Option<&str> {
        let gate = bare(&self.draft.gates[unknown.gate].model.name.value);
        let last = |name: &str| bare(name.rsplit('.').next().unwrap_or(name));
        self.known.all.keys().find(|name| last(name) == gate).copied()
    }

    /// The message that no gate carries, if there is only one.
    fn only_unused(&self) -> Option<&str> {
        let mut unused = self.known.all.keys().filter(|name| !self.used.contains(*name));
        unused.next().filter(|_| unused.next().is_none()).copied()
    }
}

#[cfg(test)]
mod tests {
    use crate::check::schema_type::RULE;
    use crate::check::testing::advice_with;
    use expect_test::expect;

    /// What is said if two connected gates carry the first two types, and another gate the third.
    fn told([one, other, third]: [&str; 3]) -> String {
        let gate =
            |kind: &str, name: &str| if name.is_empty() { kind.to_owned() } else { format!("{{{kind}: {name}}}") };
        let yaml = format!(
            "schemas: [uav.proto]\ncomponents:\n  - name: a\n    gates:\n      - x: {}\n      - y: {{pub: {third}}}\n  \
             - name: b\n    gates:\n      - x: {}\nconnections:\n  - [a.x, b.x]\n",
            gate("pub", one),
            gate("sub", other)
        );
        advice_with(&RULE, &yaml, &["uav.Command", "uav.Status"])
    }

    #[test]
    fn what_an_unknown_type_may_mean() {
        let cases = [
            ["uint16_t", "uav.Status", "A"],
            ["uav.Weight", "uav.Status", "A"],
            ["uav.Statuss", "uav.Status", "A"],
            ["uav.Mode", "uav.Status", "A"],
            ["uav.Mode", "", "A"],
            ["Mode", "", "A"],
            ["google.protobuf.DoubleValue", "", "A"],
            ["google.protobuf.DoubleValue", "", "uav.Command"],
            ["double", "", "uav.Command"],
            ["uva.Status", "uva.Status", "uva.Command"],
            ["Status", "Status", "Command"],
            ["bytes", "bytes", "uav.Command"],
        ];
        let told = |types: [&str; 3]| format!("{}: {}\n", types.join(", "), told(types));
        expect![[r#"
            uint16_t, uav.Status, A: unknown message type `uint16_t` [write `uav.Status`, as at `b.x`]
            uav.Weight, uav.Status, A: unknown message type `uav.Weight` [write `uav.Status`, as at `b.x`]
            uav.Statuss, uav.Status, A: unknown message type `uav.Statuss` [did you mean `uav.Status`?]
            uav.Mode, uav.Status, A: `uav.Mode` is an enum, not a message [did you mean `uav.Status`?]
            uav.Mode, , A: `uav.Mode` is an enum, not a message [did you mean `uav.Status`?]
            Mode, , A: `Mode` is an enum, not a message [did you mean `uav.Status`?]
            google.protobuf.DoubleValue, , A: `google.protobuf.DoubleValue` is not a message of the `schemas` [a gate carries a message, which may have a field of this type]
            google.protobuf.DoubleValue, , uav.Command: `google.protobuf.DoubleValue` is not a message of the `schemas` [write `uav.Status`, which no gate carries yet]
            double, , uav.Command: unknown message type `double` [write `uav.Status`, which no gate carries yet]
            uva.Status, uva.Status, uva.Command: the `schemas` declare these types in the package `uav`, not `uva` [write the other package: `uav.Command`, `uav.Status`]
            Status, Status, Command: the `schemas` declare these types in the package `uav` [write their package: `uav.Command`, `uav.Status`]
            bytes, bytes, uav.Command: unknown message type `bytes` [write nothing after the colon: a gate without a type carries bytes | write `uav.Status`, which no gate carries yet]
        "#]].assert_eq(&cases.map(told).concat());
    }
}
