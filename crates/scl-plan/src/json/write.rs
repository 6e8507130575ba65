//! From plans to JSON.

use crate::base64;
use crate::kind::{GateKind, Undecodable, WhenFull};
use crate::options::{GateOptions, OptionAccess};
use crate::plan::{Plan, Schema};
use crate::system::{KindPlan, SystemPlan};
use crate::version::VERSION;
use scl_text::duration::nanoseconds;
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::collections::BTreeMap;

impl SystemPlan {
    /// The plans as JSON, indented, with a line break at the end.
    pub fn to_json(&self) -> String {
        document(&self.system, &self.kinds, &self.components)
    }
}

impl Plan {
    /// The plan as JSON: a document with one component.
    pub fn to_json(&self) -> String {
        document(&self.system, &[], std::slice::from_ref(self))
    }
}

/// The whole document, with its fields in the order in which they are easiest to read.
#[derive(serde::Serialize)]
struct Document<'p> {
    version: u64,
    system: &'p str,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    kinds: &'p [KindPlan],
    components: &'p [Plan],
    schemas: BTreeMap<&'p str, String>,
}

fn document(system: &str, kinds: &[KindPlan], components: &[Plan]) -> String {
    let schemas = components.iter().filter_map(|plan| plan.schema.as_ref());
    let schemas = schemas.map(|schema| (schema.hash.as_str(), base64::encode(&schema.descriptors))).collect();
    let document = Document { version: VERSION, system, kinds, components, schemas };
    // Cannot fail: all map keys are strings, and serializing does no I/O.
    serde_json::to_string_pretty(&document).unwrap_or_default() + "\n"
}

/// A component refers to its schema by the hash.
impl Serialize for Schema {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.hash.serialize(serializer)
    }
}

impl Serialize for GateOptions {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut options = self.clone();
        let mut map = serializer.serialize_map(None)?;
        for field in Self::ALL {
            match field.access {
                OptionAccess::Number(number) => map.serialize_entry(field.json, number(&mut options)),
                OptionAccess::Size(size) => map.serialize_entry(field.json, size(&mut options)),
                OptionAccess::Duration(duration) => {
                    map.serialize_entry(field.json, &nanoseconds(*duration(&mut options)))
                }
                OptionAccess::Interval(interval) => match *interval(&mut options) {
                    Some(interval) => map.serialize_entry(field.json, &nanoseconds(interval)),
                    None => Ok(()),
                },
                OptionAccess::Flag(flag) => map.serialize_entry(field.json, flag(&mut options)),
                OptionAccess::Policy(policy) => map.serialize_entry(field.json, policy(&mut options)),
                OptionAccess::Undecodable(choice) => map.serialize_entry(field.json, choice(&mut options)),
            }?;
        }
        map.end()
    }
}

/// Serializes values as their words in the topology file.
macro_rules! serialize_as_word {
    ($($kind:ty),+) => {$(
        impl Serialize for $kind {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                self.word().serialize(serializer)
            }
        }
    )+};
}

serialize_as_word!(GateKind, Undecodable, WhenFull);
