//! A cache of message comparisons, because an end whose peer is incompatible tries again every few milliseconds.

use crate::sync::lock;
use scl_shape::Difference;
use std::collections::HashMap;
use std::sync::Mutex;

/// Maximum number of comparisons to remember.
const LIMIT: usize = 64;

#[derive(Debug, Default)]
pub(super) struct Compared(Mutex<HashMap<Key, Result<(), Difference>>>);

/// The payload, the codec, and the hashes of this program's messages and of the peer's.
pub(super) type Key = (&'static str, &'static str, &'static str, String);

impl Compared {
    pub(super) fn get(&self, key: &Key) -> Option<Result<(), Difference>> {
        lock(&self.0).get(key).cloned()
    }

    pub(super) fn insert(&self, key: Key, result: Result<(), Difference>) {
        let mut known = lock(&self.0);
        if known.len() >= LIMIT {
            known.clear();
        }
        known.insert(key, result);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limited_number_of_comparisons_is_remembered() {
        let compared = Compared::default();
        for number in 0..10 * LIMIT {
            let key = ("nav.Position", "protobuf", "1111", number.to_string());
            compared.insert(key.clone(), Ok(()));
            assert_eq!(compared.get(&key), Some(Ok(())));
            assert!(lock(&compared.0).len() <= LIMIT);
        }
    }
}
