//! Which messages can contain themselves, so that a frame decides how deep they are nested.

use prost_types::{DescriptorProto, FileDescriptorSet};
use std::collections::{HashMap, HashSet};

/// Returns true if one of the messages, or one that it contains at any depth, can contain itself.
pub(super) fn is_any_recursive<'a>(files: &FileDescriptorSet, messages: impl Iterator<Item = &'a str>) -> bool {
    let mut contained = HashMap::new();
    for file in &files.file {
        let package = if file.package().is_empty() { String::new() } else { format!(".{}", file.package()) };
        file.message_type.iter().for_each(|message| collect(message, &package, &mut contained));
    }
    let mut done = HashSet::new();
    let mut names = messages.map(|dotted| format!(".{dotted}"));
    names.any(|name| reaches_itself(&name, &contained, &mut done))
}

/// The messages that each message has fields of, by full names with a dot at the start.
fn collect<'a>(message: &'a DescriptorProto, outer: &str, contained: &mut HashMap<String, Vec<&'a str>>) {
    let name = format!("{outer}.{}", message.name());
    message.nested_type.iter().for_each(|nested| collect(nested, &name, contained));
    // Names of enums are among them, which contain nothing.
    contained.insert(name, message.field.iter().filter_map(|field| field.type_name.as_deref()).collect());
}

/// Walks without recursion, because schemas come from outside, too.
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
