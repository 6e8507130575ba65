//! What differs inside of the schemas: messages that a program built from the old files and one built from the new
//! files could not exchange. The runtime compares them in the same way before it connects.

use super::Side;
use super::change::{Change, How};
use super::connections::{Connection, connections_of};
use super::rebuild::Rebuild;
use scl_plan::{Schema, SystemPlan};
use scl_shape::{Difference, Encoding, FileDescriptorSet, What};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The messages that differ, and the components that exchange them.
#[derive(Default)]
pub(super) struct MessageChanges {
    /// One entry per message or enum.
    pub(super) changes: Vec<Change>,
    /// The components whose messages differ, each with its differing messages and enums.
    components: BTreeMap<String, BTreeSet<String>>,
    /// The components at both ends of each connection with such messages.
    pub(super) pairs: Vec<(String, String)>,
}

/// Compares the messages of every connection of the new topology with the old ones of the same names.
pub(super) fn find_message_changes(old: &Side, new: &Side) -> MessageChanges {
    let mut found = MessageChanges::default();
    let mut decoded = Decoded::default();
    let mut compared: HashMap<(String, &str, &str, &str), Vec<Difference>> = HashMap::new();
    let (old_schemas, new_schemas) = (schemas(&old.plan), schemas(&new.plan));
    for connection in connections_of(&new.plan) {
        let Some(encoding) = Encoding::of_codec(&connection.gate.codec) else { continue };
        // The sending component's schema describes what both ends exchange.
        let [before, after] = [&old_schemas, &new_schemas].map(|schemas| schemas.get(connection.component));
        let (Some(before), Some(after)) = (before, after) else { continue };
        if before.hash == after.hash {
            continue;
        }
        let payload = connection.gate.payload.to_string();
        let key = (payload.clone(), connection.gate.codec.as_str(), before.hash.as_str(), after.hash.as_str());
        let differences = compared
            .entry(key)
            .or_insert_with(|| scl_shape::differences(&payload, encoding, &decoded.of(before), &decoded.of(after)));
        found.add(&connection, differences);
    }
    found
}

/// The schemas of a system, by component.
fn schemas(plan: &SystemPlan) -> HashMap<&str, &Schema> {
    plan.components.iter().filter_map(|one| Some((one.component.as_str(), one.schema.as_ref()?))).collect()
}

impl MessageChanges {
    fn add(&mut self, connection: &Connection<'_>, differences: &[Difference]) {
        if differences.is_empty() {
            return;
        }
        let (one, other) = connection.components();
        for difference in differences {
            for component in [&one, &other] {
                let differing = format!("{} `{}`", part(&difference.what), difference.name);
                self.components.entry(component.clone()).or_default().insert(differing);
            }
            self.add_change(difference);
        }
        self.pairs.push((one, other));
    }

    fn add_change(&mut self, difference: &Difference) {
        let Difference { name, what, here, there } = difference;
        let part = part(what);
        let (key, prefix) = match what {
            What::Field(number) => ("field", format!("{number} ")),
            What::NumberOfField(field) => ("number", format!("{field} = ")),
            What::Value(number) => ("value", format!("{number} ")),
            What::NumberOfValue(value) => ("number", format!("{value} = ")),
        };
        let plain = |text: &str| format!("{prefix}{}", text.replace('`', ""));
        let fact = (key, plain(here), plain(there));
        let known = self.changes.iter_mut().find(|change| change.part == part && change.name == *name);
        match known.map(|change| &mut change.how) {
            Some(How::Changed(facts)) if facts.contains(&fact) => {}
            Some(How::Changed(facts)) => facts.push(fact),
            _ => self.changes.push(Change { part, name: name.clone(), how: How::Changed(vec![fact]) }),
        }
    }

    /// Adds the components whose messages differ to `rebuilds`, and returns all of them in the order of the new file.
    pub(super) fn add_rebuilds(&self, rebuilds: Vec<Rebuild>, new: &Side) -> Vec<Rebuild> {
        let mut by_name: HashMap<String, Rebuild> = rebuilds.into_iter().map(|it| (it.component.clone(), it)).collect();
        for (component, messages) in &self.components {
            let rebuild = by_name
                .entry(component.clone())
                .or_insert_with(|| Rebuild { component: component.clone(), reasons: Vec::new() });
            rebuild.reasons.extend(messages.iter().map(|name| format!("{name} differs")));
        }
        new.plan.components.iter().filter_map(|plan| by_name.remove(&plan.component)).collect()
    }
}

fn part(what: &What) -> &'static str {
    match what {
        What::Field(_) | What::NumberOfField(_) => "message",
        What::Value(_) | What::NumberOfValue(_) => "enum",
    }
}

/// Schemas by their hashes; many components have the same.
#[derive(Default)]
struct Decoded(HashMap<String, FileDescriptorSet>);

impl Decoded {
    fn of(&mut self, schema: &Schema) -> FileDescriptorSet {
        // The loader made the bytes, so they can be decoded.
        let decode = || scl_shape::decode(&schema.descriptors).unwrap_or_default();
        self.0.entry(schema.hash.clone()).or_insert_with(decode).clone()
    }
}
