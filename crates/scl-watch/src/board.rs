//! What the page shows, as JSON values by name, each with the version in which it last changed: a stream that is behind
//! sends what it has missed, once, whatever happened in between.

use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use tokio::sync::watch;

/// The values, and who waits for changes.
pub(crate) struct Board {
    entries: Mutex<BTreeMap<String, Entry>>,
    version: watch::Sender<u64>,
}

struct Entry {
    version: u64,
    value: Value,
}

impl Board {
    pub(crate) fn new() -> Self {
        Self { entries: Mutex::default(), version: watch::Sender::new(0) }
    }

    /// Replaces all values. Those that are gone become `null`.
    pub(crate) fn show(&self, values: BTreeMap<String, Value>) {
        let version = *self.version.borrow() + 1;
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        for (name, entry) in entries.iter_mut() {
            if !values.contains_key(name) && !entry.value.is_null() {
                *entry = Entry { version, value: Value::Null };
            }
        }
        let mut changed = entries.values().any(|entry| entry.version == version);
        for (name, value) in values {
            if entries.get(&name).is_none_or(|entry| entry.value != value) {
                entries.insert(name, Entry { version, value });
                changed = true;
            }
        }
        drop(entries);
        if changed {
            self.version.send_replace(version);
        }
    }

    /// Returns what has changed since a version, and the version that this is.
    pub(crate) fn since(&self, version: u64) -> (BTreeMap<String, Value>, u64) {
        let entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        let changed = entries.iter().filter(|(_, entry)| entry.version > version);
        let newest = entries.values().map(|entry| entry.version).max().unwrap_or(0);
        (changed.map(|(name, entry)| (name.clone(), entry.value.clone())).collect(), newest.max(version))
    }

    /// Watches for changes. While nobody does, nothing need be shown.
    pub(crate) fn watch(&self) -> watch::Receiver<u64> {
        self.version.subscribe()
    }

    /// The number of those that watch.
    pub(crate) fn watchers(&self) -> usize {
        self.version.receiver_count()
    }
}

#[cfg(test)]
mod tests {
    use super::Board;
    use serde_json::{Value, json};
    use std::collections::BTreeMap;

    fn values<const N: usize>(values: [(&str, Value); N]) -> BTreeMap<String, Value> {
        values.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }

    #[test]
    fn a_reader_gets_each_value_that_changed_since_its_version() {
        let board = Board::new();
        board.show(values([("a", json!(1)), ("b", json!(1))]));
        let (all, first) = board.since(0);
        assert_eq!(all, values([("a", json!(1)), ("b", json!(1))]));

        board.show(values([("a", json!(2)), ("b", json!(1))]));
        board.show(values([("a", json!(3)), ("b", json!(1))]));
        let (changed, second) = board.since(first);
        assert_eq!(changed, values([("a", json!(3))]));
        assert_eq!(board.since(second), (BTreeMap::new(), second));
    }

    #[test]
    fn a_value_that_is_gone_becomes_null_once() {
        let board = Board::new();
        board.show(values([("a", json!(1))]));
        let (_, first) = board.since(0);
        board.show(values([]));
        let (gone, second) = board.since(first);
        assert_eq!(gone, values([("a", Value::Null)]));
        board.show(values([]));
        assert_eq!(board.since(second), (BTreeMap::new(), second));
    }

    #[test]
    fn watchers_learn_of_changes_only() {
        let board = Board::new();
        let mut watcher = board.watch();
        assert_eq!(board.watchers(), 1);
        board.show(values([("a", json!(1))]));
        assert!(watcher.has_changed().is_ok_and(|changed| changed));
        watcher.mark_unchanged();
        board.show(values([("a", json!(1))]));
        assert!(watcher.has_changed().is_ok_and(|changed| !changed));
    }
}
