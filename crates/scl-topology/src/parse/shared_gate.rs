//! The section `everyone`: gates with two more keys, `to` and `except`.

use super::component::unread_component;
use super::field::Field;
use super::words::{is_kind, is_like_option};
use super::{Reader, pitfall, scalar, shape};
use crate::grammar::SHARED_GATE_KEYS;
use crate::model::SharedGateModel;
use crate::source::{Span, Spanned};
use crate::suggest::similar;
use crate::yaml::{Node, NodeKind};
use std::collections::HashMap;

/// The keys `to` and `except` with their values, by the place of the gate's name.
type Keys = HashMap<Span, [Option<(Node, Node)>; 2]>;

impl Reader<'_> {
    /// Reads the gates like those of a component, after their keys `to` and `except` were taken out.
    pub(super) fn read_everyone(&mut self, section: Field<'_>) {
        let mut value = section.value.clone();
        let mut keys = Keys::new();
        self.take_keys(&mut value, &mut keys);
        let name = Spanned { value: section.key.to_owned(), span: section.key_span };
        let mut everyone = unread_component(name);
        self.read_gates(Field { value: &value, ..section }, &mut everyone);
        for gate in everyone.gates {
            let [to, except] = keys.remove(&gate.name.span).unwrap_or_default();
            let unread = gate.options_unread || to.is_some();
            let to = to.and_then(|(key, value)| self.name_in(field("to", &key, &value), "gate in `to`"));
            let except = except.map_or_else(Vec::new, |(key, value)| self.read_except(field("except", &key, &value)));
            self.model.everyone.push(SharedGateModel { gate, to, except, group: 0, unread });
        }
    }

    fn read_except(&mut self, except: Field<'_>) -> Vec<Spanned<String>> {
        match &except.value.kind {
            NodeKind::Unread => Vec::new(),
            NodeKind::Sequence { items } => {
                items.iter().filter_map(|item| self.name(item, "component name", "a component name")).collect()
            }
            // One name, without brackets.
            _ => self.name_in(except, "list of components in `except`").into_iter().collect(),
        }
    }
}

fn field<'n>(key: &'n str, key_node: &'n Node, value: &'n Node) -> Field<'n> {
    Field { key, key_span: key_node.span, key_node, value }
}

impl Reader<'_> {
    /// Takes the keys out of each gate of a list, or of a mapping in its place.
    fn take_keys(&mut self, section: &mut Node, keys: &mut Keys) {
        let mut take = |entries: &mut Vec<(Node, Node)>| {
            for (name, gate) in entries {
                if let NodeKind::Mapping { entries } = &mut gate.kind {
                    self.take_keys_of_gate(name, entries, keys.entry(name.span).or_default());
                }
            }
        };
        match &mut section.kind {
            NodeKind::Mapping { entries } => take(entries),
            NodeKind::Sequence { items } => items.iter_mut().for_each(|item| {
                if let NodeKind::Mapping { entries } = &mut item.kind {
                    take(entries);
                }
            }),
            _ => {}
        }
    }

    fn take_keys_of_gate(
        &mut self,
        name: &Node,
        entries: &mut Vec<(Node, Node)>,
        found: &mut [Option<(Node, Node)>; 2],
    ) {
        let position = |word: &str| SHARED_GATE_KEYS.iter().position(|known| *known == word);
        entries.retain(|(key, value)| {
            let Some(index) = key.text().and_then(position) else { return true };
            match &found[index] {
                Some((first, its_value)) => {
                    let first = (first.span, first.span.to(its_value.span));
                    let second = field(SHARED_GATE_KEYS[index], key, value);
                    self.report(pitfall::key::duplicate(&second, first, "this gate", self.source));
                }
                None => found[index] = Some((key.clone(), value.clone())),
            }
            false
        });
        // A misspelt one is told, and read.
        entries.retain(|(key, value)| {
            let word = scalar(key).filter(|key| !is_kind(&key.value) && !is_like_option(&key.value));
            let meant = word.as_ref().and_then(|word| similar(&word.value, SHARED_GATE_KEYS).first().copied());
            let index = meant.and_then(position).filter(|index| found[*index].is_none());
            let (Some(word), Some(meant), Some(index)) = (word, meant, index) else { return true };
            found[index] = Some((key.clone(), value.clone()));
            let gate = name.text().unwrap_or_default();
            self.report(shape::unknown_key::of_shared_gate(&word, meant, gate));
            false
        });
    }
}
