//! What all parts of a launch file are read with: the collected problems, the check of keys, texts of values.

use super::super::launch_text::LaunchText;
use super::keys::Key;
use scl_terminal::{Problem, closest_name, quoted_list};
use serde_yaml::{Mapping, Value};

/// Walks the values and collects the problems; every `read_*` continues after a mistake.
pub(super) struct Reader<'a> {
    pub(super) text: LaunchText<'a>,
    /// The components of the topology.
    pub(super) known: Option<&'a [String]>,
    pub(super) problems: Vec<Problem>,
}

/// The keys from the top of the file to a value.
pub(super) type KeyPath<'p> = &'p [&'p str];

impl Reader<'_> {
    /// Reports keys that are not among those allowed; `whose` is the end of the message.
    pub(super) fn check_keys(&mut self, keys: &Mapping, at: KeyPath<'_>, allowed: &[Key], whose: &str) {
        let names = || allowed.iter().map(|key| key.name);
        for key in keys.keys() {
            let word = key.as_str();
            if word.is_some_and(|word| names().any(|name| name == word)) {
                continue;
            }
            let path: Vec<&str> = at.iter().copied().chain(word).collect();
            let problem = Problem::new(format!("unknown key {} {whose}", shown(key))).at(self.text.place(&path));
            let close = word.and_then(|word| closest_name(word, names()));
            let problem = match close {
                Some(close) => problem.help(format!("did you mean `{close}`?")),
                None => problem,
            };
            self.problems.push(problem.note(format!("the keys are {}", quoted_list(names()))));
        }
    }

    /// Reads a path; the last key of `at` is how the message names it.
    pub(super) fn read_path(&mut self, value: Option<&Value>, at: KeyPath<'_>) -> Option<String> {
        let value = value?;
        if value.as_str().is_none_or(str::is_empty) {
            let key = at.last().copied().unwrap_or_default();
            self.wrong(at, &format!("`{key}` is a path, not {}", shown(value)));
        }
        value.as_str().map(str::to_owned)
    }

    /// Reports a wrong value.
    pub(super) fn wrong(&mut self, at: KeyPath<'_>, message: &str) {
        self.problems.push(Problem::new(message).at(self.text.place(at)));
    }
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
