//! What the rules about YAML need to know about launch files.

use super::keys::{self, Form, Key};
use super::reader::Reader;
use scl_topology::parse::Dialect;

/// The dialect of launch files.
pub(super) static LAUNCH: Dialect = Dialect {
    noun: "launch file",
    minimal: "components:\n  sensor:\n    command: ./sensor",
    levels: 4,
    has_aliases: true,
    instead_of_merge: "put what all components share into `defaults`, and what all programs share into `environment` at the top \
                       of the file; write out the rest, or use an alias for a whole value, as in `build: *cmake`",
    is_key: |word| all_keys().any(|key| key.name == word),
    word: |word| all_words().find(|known| *known == word),
    mistakes: |document, source| Reader::new(source, None, &LAUNCH).read(document).1.into_sorted().len(),
};

fn all_keys() -> impl Iterator<Item = &'static Key> {
    [keys::TOP, keys::COMPONENT, keys::HOST, keys::GATEWAY].into_iter().flatten()
}

/// The keys, and the words that they can have as values.
fn all_words() -> impl Iterator<Item = &'static str> {
    let words = |key: &'static Key| match key.form {
        Form::Word(words) => words,
        _ => &[],
    };
    all_keys().flat_map(move |key| [key.name].into_iter().chain(words(key).iter().copied()))
}
