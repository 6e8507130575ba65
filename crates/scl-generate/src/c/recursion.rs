//! Finds messages that can contain themselves, so that a received frame determines how deep they are nested.

use prost_types::FileDescriptorSet;
use scl_loader::walk::{full_name, messages};
use std::collections::{HashMap, HashSet};

/// Returns true if one of the messages, or one that it contains at any depth, can contain itself.
pub(super) fn is_any_recursive<'a>(files: &FileDescriptorSet, names: impl Iterator<Item = &'a str>) -> bool {
    // Maps each message to the types of its fields, by full name with a leading dot.
    let mut contained: HashMap<String, Vec<&str>> = HashMap::new();
    for file in &files.file {
        // These types include enums, which contain nothing.
        contained.extend(messages(file).into_iter().map(|(path, message)| {
            let fields: Vec<&str> = message.field.iter().filter_map(|field| field.type_name.as_deref()).collect();
            (format!(".{}", full_name(file, &path)), fields)
        }));
    }
    let mut done = HashSet::new();
    let mut names = names.map(|dotted| format!(".{dotted}"));
    names.any(|name| reaches_itself(&name, &contained, &mut done))
}

/// Returns true if a message, or one that it contains at any depth, can contain itself. Works without recursion,
/// because schemas may come from outside.
fn reaches_itself<'a>(start: &str, contained: &'a HashMap<String, Vec<&'a str>>, done: &mut HashSet<&'a str>) -> bool {
    let fields = |name: &str| contained.get(name).map(Vec::as_slice).unwrap_or_default().iter();
    let mut path: Vec<(&str, std::slice::Iter<'_, &str>)> = match contained.get_key_value(start) {
        Some((name, _)) if !done.contains(name.as_str()) => vec![(name, fields(name))],
        _ => return false,
    };
    while let Some((name, rest)) = path.last_mut() {
        match rest.next() {
            None => {
                done.insert(name);
                path.pop();
            }
            Some(&next) if path.iter().any(|(open, _)| *open == next) => return true,
            Some(&next) if done.contains(next) => {}
            Some(&next) => path.push((next, fields(next))),
        }
    }
    false
}
