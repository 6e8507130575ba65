//! What all parts of a launch file are read with: the collected problems, the check of keys, texts of values.

use super::super::launch_text::LaunchText;
use super::super::system_names::SystemNames;
use super::keys::{Key, MERGE, is_own};
use scl_terminal::{Problem, closest_name, quoted_list};
use serde_yaml::{Mapping, Value};

/// Walks the values and collects the problems; every `read_*` continues after a mistake.
pub(super) struct Reader<'a> {
    pub(super) text: LaunchText<'a>,
    /// The names of the topology.
    pub(super) known: Option<&'a SystemNames>,
    pub(super) problems: Vec<Problem>,
}

/// The keys from the top of the file to a value.
pub(super) type KeyPath<'p> = &'p [&'p str];

impl Reader<'_> {
    /// Reports keys that are not among those allowed; `whose` is the end of the message.
    pub(super) fn check_keys<'k>(
        &mut self,
        keys: &Mapping,
        at: KeyPath<'_>,
        allowed: impl IntoIterator<Item = &'k Key>,
        whose: &str,
    ) {
        let allowed: Vec<&Key> = allowed.into_iter().collect();
        let names = || allowed.iter().map(|key| key.name);
        for key in keys.keys() {
            let word = key.as_str();
            let is_own = word.is_some_and(is_own);
            if word == Some(MERGE)
                || is_own && at.is_empty()
                || word.is_some_and(|word| names().any(|name| name == word))
            {
                continue;
            }
            let path: Vec<&str> = at.iter().copied().chain(word).collect();
            let problem = Problem::new(format!("unknown key {} {whose}", shown(key))).at(self.text.place(&path));
            let close = word.and_then(|word| likely_key(word, allowed.iter().copied()));
            self.problems.push(match close {
                _ if is_own => problem.help("keys of your own, which start with `x-`, belong at the top of the file"),
                Some(close) => problem.help(format!("did you mean `{close}`?")),
                None => problem.note(format!("the keys are {}", quoted_list(names()))),
            });
        }
    }

    /// Reads a path; the last key of `at` is how the message names it.
    pub(super) fn read_path(&mut self, value: Option<&Value>, at: KeyPath<'_>) -> Option<String> {
        let value = value?;
        let path = value.as_str().filter(|path| !path.is_empty() && !path.contains('\0'));
        if path.is_none() {
            self.wrong_value(at, value);
        }
        path.map(str::to_owned)
    }

    /// Reports a wrong value.
    pub(super) fn wrong(&mut self, at: KeyPath<'_>, message: &str) {
        self.problems.push(Problem::new(message).at(self.text.place(at)));
    }
}

/// The path of keys with one more.
pub(super) fn joined<'k>(path: &[&'k str], key: &'k str) -> Vec<&'k str> {
    path.iter().copied().chain([key]).collect()
}

/// The key that an unknown one probably means: another tool's word for it, or a similar name.
pub(super) fn likely_key<'k>(word: &str, allowed: impl IntoIterator<Item = &'k Key>) -> Option<&'k str> {
    let allowed: Vec<&Key> = allowed.into_iter().collect();
    let lower = word.to_lowercase().replace(['-', ' '], "_");
    let named = allowed.iter().find(|key| key.also.contains(&lower.as_str()));
    named.map(|key| key.name).or_else(|| closest_name(&lower, allowed.iter().map(|key| key.name)))
}

/// The text of a string, number or boolean that can be passed to a program, else `None`.
pub(super) fn scalar_text(value: &Value) -> Option<String> {
    match value {
        Value::String(text) if !text.contains('\0') => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        Value::Bool(truth) => Some(truth.to_string()),
        _ => None,
    }
}

/// Describes an unexpected value in messages.
pub(super) fn shown(value: &Value) -> String {
    match value {
        Value::Sequence(_) => "a list".to_owned(),
        Value::Mapping(_) => "a mapping".to_owned(),
        Value::Tagged(_) => "a tagged value".to_owned(),
        Value::Null => "nothing".to_owned(),
        scalar => format!("`{}`", scalar_text(scalar).unwrap_or_default()),
    }
}
